#!/usr/bin/env python3
"""Cracks within cells beside discrete ones, for doc/damage.md: interfaces with a softening
bond between all rows, and in the arch dam between all blocks, of elastic concrete. Prints
a table and draws doc/discrete_cracks.png.

usage: doc/discrete_cracks.py PROGRAM FOLDER

Runs those cases that have no results in FOLDER yet, an hour on one core. Needs the Debian
packages python3-numpy and python3-matplotlib.
"""

import json
import os
import subprocess
import sys

import numpy as np
from koyna_meshes import COLUMNS, LAWS as LAWS_OF_CELLS
from mesh_bias import ROOT, largest_error, plt, read_crest, read_energy

KOYNA, ARCH_DAM = "koyna.prm", "arch_dam_damage.prm"
REAL_JOINTS = (4, 8, 12, 16)  # of 19 between the blocks of the arch dam
OTHER_JOINTS = [joint for joint in range(1, 20) if joint not in REAL_JOINTS]
# strength [Pa], fracture energy [N/m] and elastic concrete
CONCRETE = {
    KOYNA: (2.9e6, 406., ("Density=2643", "Young's modulus=31.027e9", "Poisson's ratio=0.2")),
    ARCH_DAM: (2e6, 350., ("Density=2400", "Young's modulus=27e9", "Poisson's ratio=0.17",
                           "Static factor=0.67")),
}
# meshes of each case: rows over the height, or length of the cells along the crest
MESHES = {
    KOYNA: {f"{rows} rows": (f"Mesh/gravity section/Cells=1, {COLUMNS[rows]}, {rows}",)
            for rows in (36, 72, 104)},
    ARCH_DAM: {"6.5 m": (),
               "3.25 m": ("Mesh/arch dam/Cell size=3.25",
                          "Mesh/arch dam/Cells through thickness=6")},
}
LIFTS = {KOYNA: ("Mesh/gravity section/Lift height=1",),
         # 11 m: the rows of the larger cells
         ARCH_DAM: ("Mesh/arch dam/Joints=19", "Mesh/arch dam/Lift height=11")}
FACES = {KOYNA: "lift *",
         ARCH_DAM: ", ".join(["lift *", "dam-rock interface"] +
                             [f"joint {joint}" for joint in OTHER_JOINTS])}
# cohesion of the interfaces over their tensile strength: with 2 the shear strength is that of
# concrete, with 1 an oblique crack along rows and joints begins at the tensile strength
COHESION = {"interfaces": 2., "weak interfaces": 1.}
# fracture energy with which no cell lowers its tensile strength [N/m]
KEPT = {"6.5 m": 1520., "3.25 m": 800.}
KEEPS = ", strength kept"
LAWS = (*COHESION, *LAWS_OF_CELLS, *(law + KEEPS for law in LAWS_OF_CELLS))
# case, times its motion, mesh
RUNS = ((KOYNA, 1., "36 rows"), (KOYNA, 1., "72 rows"), (KOYNA, 1., "104 rows"),
        (ARCH_DAM, 1., "6.5 m"), (ARCH_DAM, 2., "6.5 m"), (ARCH_DAM, 2., "3.25 m"))
DRAWN = ((KOYNA, 1., "104 rows"), (ARCH_DAM, 1., "6.5 m"), (ARCH_DAM, 2., "3.25 m"))


def interfaces_of(case, cohesion):
    """Entries of the model whose cracks are interfaces with this cohesion over their tensile
    strength. Slip takes ten times the fracture energy."""
    strength, energy, concrete = CONCRETE[case]
    names = ["cracks"] if case == KOYNA else ["joints", "cracks"]
    observers = ["histories", "fields"] + ([] if case == KOYNA else ["interfaces"])
    entries = ["Interfaces/Names=" + ", ".join(names), f"Interfaces/cracks/Face sets={FACES[case]}",
               "Interfaces/cracks/Law=softening bond",
               f"Interfaces/cracks/Tensile strength={strength:g}",
               f"Interfaces/cracks/Fracture energy={energy:g}",
               f"Interfaces/cracks/Cohesion={cohesion * strength:g}",
               "Interfaces/cracks/Friction coefficient=1",
               "Interfaces/cracks/Residual friction coefficient=1",
               f"Interfaces/cracks/Shear fracture energy={10. * energy:g}",
               "Materials/Names=solid" + ("" if case == KOYNA else ", rock"),
               "Materials/solid/Cell sets=dam", "Output/Observers=" + ", ".join(observers)]
    if case == ARCH_DAM:
        entries.append("Interfaces/joints/Face sets=" +
                       ", ".join(f"joint {joint}" for joint in REAL_JOINTS))
    return entries + [f"Materials/solid/{entry}" for entry in concrete] + list(LIFTS[case])


def entries_of(case, mesh, law):
    if law in COHESION:
        return interfaces_of(case, COHESION[law])
    strength, energy, _ = CONCRETE[case]
    if law.endswith(KEEPS):
        energy = KEPT[mesh]
    return ["Materials/concrete/Tension law=linear",
            f"Materials/concrete/Tensile strength={strength:g}",
            f"Materials/concrete/Fracture energy={energy:g}",
            *LAWS_OF_CELLS[law.removesuffix(KEEPS)]]


def run(program, folder, case, factor, mesh, law):
    """Runs one case unless it has results, and returns its output folder."""
    name = f"{case[:-4]} {factor:g} {mesh} {law}".replace(", ", "_").replace(" ", "_")
    output = os.path.join(folder, name)
    if not os.path.exists(os.path.join(output, "summary.json")):
        print(name, file=sys.stderr)
        subprocess.run([program, os.path.join(ROOT, "prm", case), "--overwrite", "--set",
                        f"Output/Folder={output}", f"Ground motion/Overload factor={factor:g}",
                        *MESHES[case][mesh], *entries_of(case, mesh, law)],
                       check=True, stdout=subprocess.DEVNULL)
    return output


def result(output):
    """Times [s], displacement of the crest along the river [mm], energy in cracks [MJ],
    largest opening of a contraction joint [mm], energy-balance error over the input."""
    times, crest = read_crest(output)
    with open(os.path.join(output, "summary.json")) as file:
        summary = json.load(file)
    energy = read_energy(output)
    surfaces = summary.get("interfaces", {}).get("surfaces", {})
    in_cracks = energy["material [J]"][-1] + sum(s["energies [J]"]["bond"] for s in surfaces.values())
    joints = ([f"joint {n}" for n in REAL_JOINTS] if "joint 19" in surfaces
              else [name for name in surfaces if name.startswith("joint")])
    opening = max((surfaces[name]["largest opening [mm]"] for name in joints), default=0.)
    return {"times": times, "crest": crest, "cracks": 1e-6 * in_cracks, "opening": opening,
            "error": largest_error(energy)}


def difference(values, reference):
    """Root mean square of the difference over that of the motion of the reference."""
    crest = np.interp(reference["times"], values["times"], values["crest"])
    return np.sqrt(np.mean((crest - reference["crest"])**2)) / reference["crest"].std()


def draw(results, picture):
    figure, axes = plt.subplots(len(DRAWN), 1, figsize=(8., 8.), constrained_layout=True)
    for panel, (case, factor, mesh) in zip(axes, DRAWN):
        for law, style in zip(LAWS, ("k-", "k:", "C3-", "C0-", "C3--", "C0--")):
            if (case, factor, mesh, law) not in results:
                continue
            values = results[case, factor, mesh, law]
            panel.plot(values["times"], values["crest"], style, label=law, linewidth=1.2)
        panel.set_title(f"prm/{case}, {factor:g} times its motion, {mesh}" +
                        (" along the crest" if case == ARCH_DAM else " over the height"),
                        fontsize=10)
        panel.set(ylabel="crest along the river [mm]", xlabel="time [s]")
        panel.grid(alpha=0.3)
    axes[-1].legend(loc="upper left", ncol=2, fontsize=8)
    figure.savefig(picture, dpi=110)


def main(program, folder):
    os.makedirs(folder, exist_ok=True)
    program, folder = os.path.abspath(program), os.path.abspath(folder)
    results = {(*case, law): result(run(program, folder, *case, law))
               for case in RUNS for law in LAWS
               if case[0] == ARCH_DAM or not law.endswith(KEEPS)}
    print("| case | motion | cells | cracks | crest | difference | energy in cracks "
          "| joints open by |\n|---|---|---|---|---|---|---|---|")
    for (case, factor, mesh, law), values in results.items():
        apart = difference(values, results[case, factor, mesh, "interfaces"])
        print(f"| `{case[:-4]}` | {factor:g} | {mesh} | {law} | {values['crest'].min():.1f} to "
              f"{values['crest'].max():+.1f} mm | {100. * apart:.0f} % | {values['cracks']:.3g} MJ | "
              f"{values['opening']:.1f} mm |")
    print("energy-balance error over the input, at most "
          f"{max(values['error'] for values in results.values()):.5f}")
    draw(results, os.path.join(ROOT, "doc", "discrete_cracks.png"))


if __name__ == "__main__":
    main(*sys.argv[1:])
