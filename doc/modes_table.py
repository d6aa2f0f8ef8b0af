#!/usr/bin/env python3
"""Natural frequencies of the two built-in dams, in doc/modes.md.

usage: doc/modes_table.py PROGRAM [RANKS]

Runs prm/baihetan_static.prm and prm/shapai_static.prm with empty and full
reservoir, on rigid and on flexible (massless) rock.
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


def frequencies(program, ranks, case, held, massless, water):
    with tempfile.TemporaryDirectory() as scratch:
        folder = os.path.join(scratch, "run")
        subprocess.run(
            ["mpirun", "-np", ranks, program, f"{ROOT}/prm/{case}.prm",
             "--set", f"Modes/Held materials={held}",
             "--set", f"Modes/Massless materials={massless}",
             "--set", f"Modes/Water={water}",
             "--set", f"Output/Folder={folder}"],
            check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(folder, "summary.json")) as file:
            summary = json.load(file)
    return [mode["frequency [Hz]"] for mode in summary["modes"]["modes"]]


def main(program, ranks="2"):
    lines = ["# Natural frequencies of the built-in dams",
             "",
             "Hz, of `prm/baihetan_static.prm` and `prm/shapai_static.prm`; water to 280 m and",
             "130.5 m as Westergaard's added mass, flexible rock without mass. Made by",
             "`doc/modes_table.py`."]
    for dam, case in DAMS.items():
        columns = [frequencies(program, ranks, case, *variant)
                   for variant in VARIANTS.values()]
        lines += ["", f"## {dam}", "",
                  "| mode | " + " | ".join(VARIANTS) + " |",
                  "|---|" + "---|" * len(columns)]
        for number, row in enumerate(zip(*columns), 1):
            lines.append(f"| {number} | " + " | ".join(f"{f:.3f}" for f in row) + " |")
    with open(os.path.join(ROOT, "doc", "modes.md"), "w") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
