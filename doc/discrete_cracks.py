#!/usr/bin/env python3
"""Cracks within cells beside discrete ones, for doc/damage.md: interfaces with a softening
bond between all rows, and in the arch dams between all blocks, of elastic concrete. Prints
a table and draws doc/discrete_cracks.png and doc/discrete_cracks_overload.png.

usage: doc/discrete_cracks.py PROGRAM FOLDER

Runs those cases that have no results in FOLDER yet, two and a half hours on one core.
Needs the Debian packages python3-numpy and python3-matplotlib.
"""

import json
import os
import subprocess
import sys

import numpy as np
from koyna_meshes import COLUMNS, LAWS as LAWS_OF_CELLS
from mesh_bias import ROOT, largest_error, plt, read_crest, read_energy

KOYNA, ARCH_DAM, OVERLOAD = "koyna.prm", "arch_dam_damage.prm", "damage_overload.prm"
# numbers of the contraction joints, and of joints that only cracks of the concrete follow
REAL_JOINTS = {ARCH_DAM: (4, 8, 12, 16), OVERLOAD: range(2, 48, 2)}
OTHER_JOINTS = {ARCH_DAM: [joint for joint in range(1, 20) if joint % 4],
                OVERLOAD: range(1, 48, 2)}
# strength [Pa], fracture energy [N/m], their increase in the earthquake and elastic concrete
CONCRETE = {
    KOYNA: (2.9e6, 406., 1.,
            ("Density=2643", "Young's modulus=31.027e9", "Poisson's ratio=0.2")),
    ARCH_DAM: (2e6, 350., 1., ("Density=2400", "Young's modulus=27e9", "Poisson's ratio=0.17",
                               "Static factor=0.67")),
    OVERLOAD: (2.5e6, 350., 1.2, ("Density=2400", "Young's modulus=36e9",
                                  "Poisson's ratio=0.17", "Static factor=0.67")),
}


def lifts_of_arch_dam(case, height):
    """Entries of a mesh with joints between narrow blocks, some of them contraction joints, and
    with lift joints of this height [m]."""
    real = REAL_JOINTS[case]
    return (f"Mesh/arch dam/Joints={len(real) + len(OTHER_JOINTS[case])}",
            f"Mesh/arch dam/Lift height={height}",
            "Interfaces/joints/Face sets=" + ", ".join(f"joint {joint}" for joint in real))


# those of arch dams have the height of the rows of the larger cells
LIFTS = {KOYNA: ("Mesh/gravity section/Lift height=1",),
         ARCH_DAM: lifts_of_arch_dam(ARCH_DAM, 11)}
LIFTS_OF_OVERLOAD = lifts_of_arch_dam(OVERLOAD, 9)
# meshes of each case: rows over the height, or length of the cells along the crest; all laws
# have that of the overloaded dam
MESHES = {
    KOYNA: {f"{rows} rows": (f"Mesh/gravity section/Cells=1, {COLUMNS[rows]}, {rows}",)
            for rows in (36, 72, 104)},
    ARCH_DAM: {"6.5 m": (),
               "3.25 m": ("Mesh/arch dam/Cell size=3.25",
                          "Mesh/arch dam/Cells through thickness=6")},
    OVERLOAD: {"6.2 m": ("Mesh/Local refinement=", "Mesh/arch dam/Cells through thickness=4",
                         *LIFTS_OF_OVERLOAD),
               "3.1 m": LIFTS_OF_OVERLOAD},
}
# cohesion of the interfaces over their tensile strength: with 2 the shear strength is that of
# concrete, with 1 an oblique crack along rows and joints begins at the tensile strength
COHESION = {"interfaces": 2., "interfaces, local": 2., "weak interfaces, local": 1.}
# fracture energy with which no cell lowers its tensile strength [N/m]
KEPT = {"6.5 m": 1520., "3.25 m": 800., "6.2 m": 2600., "3.1 m": 2600.}
FACE_TO_FACE = "largest opening from face to face at one moment [mm]"
KEEPS = ", strength kept"
LAWS = (*COHESION, *LAWS_OF_CELLS, *(law + KEEPS for law in LAWS_OF_CELLS))
# the laws of each case, its motion over that of the file, and mesh
RUNS = {(KOYNA, 1., "36 rows"): LAWS[:5],
        (KOYNA, 1., "72 rows"): LAWS[:5],
        (KOYNA, 1., "104 rows"): LAWS[:5],
        (ARCH_DAM, 1., "6.5 m"): LAWS,
        (ARCH_DAM, 2., "6.5 m"): LAWS,
        (ARCH_DAM, 2., "3.25 m"): LAWS,
        (OVERLOAD, 1., "6.2 m"): LAWS[:2],
        (OVERLOAD, 1.2, "6.2 m"): LAWS[:2] + LAWS[3:],
        (OVERLOAD, 1.2, "3.1 m"): LAWS[:2] + LAWS[4:5],
        (OVERLOAD, 1.4, "6.2 m"): LAWS[:2],
        (OVERLOAD, 1.6, "6.2 m"): LAWS[:2],
        (OVERLOAD, 1.8, "6.2 m"): LAWS[:2]}
DRAWN = {"discrete_cracks": ((KOYNA, 1., "104 rows"), (ARCH_DAM, 1., "6.5 m"),
                             (ARCH_DAM, 2., "3.25 m")),
         "discrete_cracks_overload": ((OVERLOAD, 1.2, "6.2 m"), (OVERLOAD, 1.2, "3.1 m"),
                                      (OVERLOAD, 1.8, "6.2 m"))}


def interfaces_of(case, law):
    """Entries of the model whose cracks are interfaces. Slip takes ten times the fracture
    energy."""
    strength, energy, increase, concrete = CONCRETE[case]
    strength, energy = increase * strength, increase * energy
    names = ["cracks"] if case == KOYNA else ["joints", "cracks"]
    observers = ["histories", "fields"] + ([] if case == KOYNA else ["interfaces"])
    faces = ["lift *"] if case == KOYNA else ["lift *", "dam-rock interface"]
    faces += [f"joint {joint}" for joint in OTHER_JOINTS.get(case, ())]
    entries = ["Interfaces/Names=" + ", ".join(names),
               "Interfaces/cracks/Face sets=" + ", ".join(faces),
               "Interfaces/cracks/Law=softening bond",
               f"Interfaces/cracks/Tensile strength={strength:g}",
               f"Interfaces/cracks/Fracture energy={energy:g}",
               f"Interfaces/cracks/Cohesion={COHESION[law] * strength:g}",
               "Interfaces/cracks/Friction coefficient=1",
               "Interfaces/cracks/Residual friction coefficient=1",
               f"Interfaces/cracks/Shear fracture energy={10. * energy:g}",
               f"Interfaces/cracks/Crack growth={'local' if law.endswith('local') else 'from tips'}",
               "Materials/Names=solid" + ("" if case == KOYNA else ", rock"),
               "Materials/solid/Cell sets=dam", "Output/Observers=" + ", ".join(observers)]
    return entries + [f"Materials/solid/{entry}" for entry in concrete] + list(LIFTS.get(case, ()))


def entries_of(case, mesh, law):
    if law in COHESION:
        return interfaces_of(case, law)
    strength, energy, *_ = CONCRETE[case]
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


def result(output, case, law):
    """Times [s], displacement of the crest along the river [mm], energy in cracks [MJ], largest
    opening of a contraction joint [mm], what is open at one moment, energy-balance error over
    the input."""
    times, crest = read_crest(output)
    with open(os.path.join(output, "summary.json")) as file:
        summary = json.load(file)
    energy = read_energy(output)
    surfaces = summary.get("interfaces", {}).get("surfaces", {})
    in_cracks = energy["material [J]"][-1] + sum(s["energies [J]"]["bond"] for s in surfaces.values())
    in_concrete = ([f"joint {n}" for n in OTHER_JOINTS.get(case, ())] if law in COHESION else [])
    opening = max((values["largest opening [mm]"] for name, values in surfaces.items()
                   if name.startswith("joint") and name not in in_concrete), default=0.)
    lifts = [values for name, values in surfaces.items() if name.startswith("lift")]
    through = summary.get("through cracks", {})
    cut = (f"{max(s['largest opening [mm]'] for s in lifts):.1f} mm, "
           f"{max(s['largest open share [%]'] for s in lifts):.0f} % of a lift" if lifts else
           f"{through[FACE_TO_FACE]:.1f} mm" if through else "")
    return {"times": times, "crest": crest, "cracks": 1e-6 * in_cracks, "opening": opening,
            "cut": cut, "error": largest_error(energy)}


def difference(values, reference):
    """Root mean square of the difference over that of the motion of the reference."""
    crest = np.interp(reference["times"], values["times"], values["crest"])
    return np.sqrt(np.mean((crest - reference["crest"])**2)) / reference["crest"].std()


def draw(results, cases, picture):
    figure, axes = plt.subplots(len(cases), 1, figsize=(8., 8.), constrained_layout=True)
    for panel, (case, factor, mesh) in zip(axes, cases):
        for law, style in zip(LAWS, ("k-", "k--", "k:", "C3-", "C0-", "C3--", "C0--")):
            if (case, factor, mesh, law) not in results:
                continue
            values = results[case, factor, mesh, law]
            panel.plot(values["times"], values["crest"], style, label=law, linewidth=1.2)
        panel.set_title(f"prm/{case}, {factor:g} times its motion, {mesh}" +
                        (" over the height" if case == KOYNA else " along the crest"),
                        fontsize=10)
        panel.set(ylabel="crest along the river [mm]", xlabel="time [s]")
        panel.grid(alpha=0.3)
    fullest = max(axes, key=lambda panel: len(panel.lines))
    fullest.legend(loc="upper left", ncol=2, fontsize=8)
    figure.savefig(picture, dpi=110)


def main(program, folder):
    os.makedirs(folder, exist_ok=True)
    program, folder = os.path.abspath(program), os.path.abspath(folder)
    results = {(*case, law): result(run(program, folder, *case, law), case[0], law)
               for case, laws in RUNS.items() for law in laws}
    print("| case | motion | cells | cracks | crest | difference | energy in cracks "
          "| joints open by | cracks open |\n|---|---|---|---|---|---|---|---|---|")
    for (case, factor, mesh, law), values in results.items():
        apart = difference(values, results[case, factor, mesh, "interfaces"])
        print(f"| `{case[:-4]}` | {factor:g} | {mesh} | {law} | {values['crest'].min():.1f} to "
              f"{values['crest'].max():+.1f} mm | {100. * apart:.0f} % | {values['cracks']:.3g} MJ | "
              f"{values['opening']:.1f} mm | {values['cut']} |")
    print("energy-balance error over the input, at most "
          f"{max(values['error'] for values in results.values()):.5f}")
    for name, cases in DRAWN.items():
        draw(results, cases, os.path.join(ROOT, "doc", name + ".png"))


if __name__ == "__main__":
    main(*sys.argv[1:])
