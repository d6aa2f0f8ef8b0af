#!/usr/bin/env python3
"""Draws the table of `voussoir --material-test`: the stress over the strain of every stressed component, and the energies over time.

Usage: material_test.py TABLE.csv PICTURE.png
"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main(table, picture):
    with open(table) as file:
        rows = list(csv.reader(file))
    columns = {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.5))
    for component in ("xx", "yy", "zz", "xy", "xz", "yz"):
        stress = columns[f"stress {component} [MPa]"]
        if max(map(abs, stress)) > 1e-6:
            left.plot([1e3 * strain for strain in columns[f"strain {component}"]], stress, label=component)
    left.set(xlabel="strain [mm/m]", ylabel="stress [MPa]")
    left.legend()
    for name in ("work [kJ/m3]", "stored [kJ/m3]", "lost [kJ/m3]"):
        right.plot(columns["time [s]"], columns[name], label=name)
    right.set(xlabel="time [s]", ylabel="energy density [kJ/m3]")
    right.legend()
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(picture, dpi=120)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
