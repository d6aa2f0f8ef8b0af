#!/usr/bin/env python3
"""Draws the picture of the abutments in doc/studies.md from the folder of the study:
slip of the planes and factor of safety of the blocks over time under the design motion,
residual slip under 1.0 and 1.5 times this motion, and over the factor.

    python3 doc/abutment_stability.py output/study_abutment
"""
import csv
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PLANES = [f"{bank} wedge {plane}" for bank in ("left", "right")
          for plane in ("base", "lateral plane", "rear plane")]
COLOURS = {"left": "#1b6ca8", "right": "#c0392b"}
DASHES = {"base": "-", "lateral plane": "--", "rear plane": ":"}
study = pathlib.Path(sys.argv[1])
design, stronger = (study / f"Overload-factor-{factor}" for factor in ("1", "1.5"))


def table(folder):
    """Columns of interfaces.csv by their titles; an empty cell is infinite."""
    with open(folder / "interfaces.csv", newline="") as lines:
        titles, *rows = csv.reader(lines)
    return {title: [float(row[i] or "inf") for row in rows] for i, title in enumerate(titles)}


def style(plane):
    bank, _, name = plane.split(" ", 2)
    return {"color": COLOURS[bank], "linestyle": DASHES[name], "label": f"{bank} {name}"}


def surfaces(folder):
    return json.loads((folder / "summary.json").read_text())["interfaces"]["surfaces"]


figure, ((slip, safety), (residual, factor)) = plt.subplots(2, 2, figsize=(10, 7), layout="constrained")

values = table(design)
time = next(iter(values.values()))
for plane in PLANES:
    slip.plot(time, values[f"{plane} mean slip [mm]"], linewidth=1.2, **style(plane))
slip.set(xlabel="time [s]", ylabel="mean slip [mm]", title="slip of the planes, design motion (MDE)")
slip.legend(fontsize=8, ncols=2)

for bank in ("left", "right"):
    safety.plot(time, values[f"{bank} wedge block safety [-]"], color=COLOURS[bank], linewidth=0.8,
                label=f"{bank} block")
safety.axhline(1.0, color="black", linewidth=0.8)
safety.set(xlabel="time [s]", ylabel="factor of safety of the blocks [-]", yscale="log", ylim=(0.9, 8),
           title="resistance over driving forces, MDE")
safety.set_yticks([1, 2, 4, 8], ["1", "2", "4", "8"])
safety.minorticks_off()
safety.legend(fontsize=8)

for shift, name, folder in ((-0.2, "MDE, 406 gal", design), (0.2, "1.5 times MDE", stronger)):
    stays = surfaces(folder)
    residual.bar([i + shift for i in range(len(PLANES))],
                 [stays[plane]["residual slip [mm]"] for plane in PLANES], 0.4, label=name)
residual.set_xticks(range(len(PLANES)), [plane.replace(" wedge", "").replace(" ", "\n") for plane in PLANES])
residual.set(ylabel="largest residual slip [mm]", title="residual slip")
residual.legend(fontsize=8)

runs = sorted((float(run["values"]["Ground motion/Overload factor"]), run["quantities"])
              for run in json.loads((study / "study.json").read_text())["runs"])
for plane in PLANES:
    if plane.endswith("base"):
        factor.plot([value for value, _ in runs],
                    [numbers[f"interfaces/surfaces/{plane}/residual slip [mm]"] for _, numbers in runs],
                    marker="o", **style(plane))
factor.set(xlabel="factor on the design motion", ylabel="largest residual slip [mm]", yscale="log",
           title="slip of the base planes over the factor")
factor.axhline(100.0, color="black", linewidth=0.8)
factor.legend(fontsize=8)

figure.savefig(pathlib.Path(__file__).with_suffix(".png"), dpi=90)
