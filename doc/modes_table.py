#!/usr/bin/env python3
"""Natural frequencies of the built-in dams and of a table of arches, in doc/modes.md.

usage: doc/modes_table.py PROGRAM [RANKS]

Runs prm/baihetan_static.prm and prm/shapai_static.prm with empty and full
reservoir, on rigid and on flexible (massless) rock, and prm/morrow_point.prm
empty, with two sizes of cells.
"""
import json
import os
import subprocess
import sys
import tempfile

DAMS = {"Baihetan-like, 289 m": "baihetan_static", "Shapai-like, 132 m": "shapai_static"}
VARIANTS = {
    "rigid rock, empty": ("rock", "", "none"),
    "rigid rock, full": ("rock", "", "by reservoir"),
    "flexible rock, empty": ("", "rock", "none"),
    "flexible rock, full": ("", "rock", "by reservoir"),
}
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def frequencies(program, ranks, case, fixed, massless, water, *changes):
    with tempfile.TemporaryDirectory() as scratch:
        folder = os.path.join(scratch, "run")
        subprocess.run(
            ["mpirun", "-np", ranks, program, f"{ROOT}/prm/{case}.prm",
             "--set", f"Modes/Fixed materials={fixed}",
             "--set", f"Modes/Massless materials={massless}",
             "--set", f"Modes/Water={water}",
             "--set", f"Output/Folder={folder}"]
            + [word for change in changes for word in ("--set", change)],
            check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(folder, "summary.json")) as file:
            summary = json.load(file)
    return [mode["frequency [Hz]"] for mode in summary["modes"]["modes"]]


def morrow_point(program, ranks):
    columns = {}
    for rock, variant in (("rigid", "rigid rock, empty"),
                          ("flexible", "flexible rock, empty")):
        for size in 6, 4:
            columns[f"{rock}, cells of {size} m"] = frequencies(
                program, ranks, "morrow_point", *VARIANTS[variant],
                f"Mesh/arch dam/Cell size={size}")[:2]
    change = [100. * (1. - fine[i] / coarse[i])
              for coarse, fine in (list(columns.values())[:2], list(columns.values())[2:])
              for i in range(2)]
    lines = ["", "## Morrow Point-like, 142 m, empty", "",
             "| mode | " + " | ".join(columns) + " |",
             "|---|" + "---|" * len(columns)]
    for i, name in enumerate(("1, antisymmetric", "2, symmetric")):
        lines.append(f"| {name} | " + " | ".join(
            f"{column[i]:.3f}" for column in columns.values()) + " |")
    lines.append("| 2 over 1 | " + " | ".join(
        f"{column[1] / column[0]:.2f}" for column in columns.values()) + " |")
    return lines + [
        "",
        f"The smaller cells have frequencies lower by {min(change):.0f} to {max(change):.0f} %: the frequencies are not converged.",
        "There is nothing to compare them with: no source of measured or computed frequencies of Morrow",
        "Point Dam [could be read](published.md#sources-not-found). Height, crest length and two",
        "thicknesses are those of the dam; the canyon between crest and base, the radii and the",
        "thickness in between are assumed."]


def main(program, ranks="2"):
    lines = ["# Natural frequencies of the built-in dams",
             "",
             "Frequencies in Hz of `prm/baihetan_static.prm` and `prm/shapai_static.prm`, with water",
             "to 280 m and 130.5 m as Westergaard's added mass and flexible rock without mass. Made",
             "by `doc/modes_table.py`."]
    for dam, case in DAMS.items():
        columns = [frequencies(program, ranks, case, *variant)
                   for variant in VARIANTS.values()]
        lines += ["", f"## {dam}", "",
                  "| mode | " + " | ".join(VARIANTS) + " |",
                  "|---|" + "---|" * len(columns)]
        for number, row in enumerate(zip(*columns), 1):
            lines.append(f"| {number} | " + " | ".join(f"{f:.3f}" for f in row) + " |")
    lines += morrow_point(program, ranks)
    with open(os.path.join(ROOT, "doc", "modes.md"), "w") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
