#!/usr/bin/env python3
"""Picture of the cracks in a slice of a dam: damage in tension at the times of
the pictures, of one or more finished runs, and the motion of the crest in all.

usage: doc/damage_figure.py FILE.png TIMES NAME=OUTPUT_FOLDER ...

TIMES are numbers of the pictures to draw, as in 1,2,3. The runs need the
observers "fields" and "histories", the latter with a point "crest"; a run
without damage (of the elastic dam) is drawn in the history only. Needs the
Debian packages python3-matplotlib and python3-vtk9.
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

from figures import column_of, read_histories
from joints_figure import read


def draw_damage(axes, name):
    points, cells, values = read(name)
    cells = cells.reshape(-1, 8)
    moved = points + 20. * values["displacement"]
    faces, damage = [], []
    for cell in cells:
        # the four corners on one side of the slice, in order around it
        side = cell[points[cell, 0] < points[cell, 0].mean()]
        flat = moved[side, 1:]
        out = flat - flat.mean(axis=0)
        faces.append(flat[np.argsort(np.arctan2(out[:, 1], out[:, 0]))] * (-1, 1))
        damage.append(values["tension_damage"][cell[0]])
    drawn = PolyCollection(faces, array=np.array(damage), cmap="inferno_r", edgecolors="none")
    drawn.set_clim(0., 1.)
    axes.add_collection(drawn)
    axes.autoscale()
    axes.set_aspect("equal")
    axes.set_axis_off()
    return drawn


def crest_motion(folder):
    titles, data = read_histories(folder)
    return data[:, 0], -100. * data[:, column_of(titles, "crest", "displacement y")]


def pictures_of(folder):
    """Time and file of each picture."""
    with open(folder + "/fields.txt") as file:
        return [(float(time), f"{folder}/{name}") for time, name in (line.split() for line in file)]


def main(picture, numbers, runs):
    numbers = [int(number) for number in numbers.split(",")]
    pictures = {name: pictures_of(folder) for name, folder in runs.items()}
    damaged = [name for name in runs if "tension_damage" in read(pictures[name][0][1])[2]]
    figure = plt.figure(figsize=(3. * len(numbers) + 4., 3. * len(damaged) + .5))
    grid = figure.add_gridspec(len(damaged), len(numbers) + 1, width_ratios=[1] * len(numbers) + [1.6])
    for row, name in enumerate(damaged):
        for column, number in enumerate(numbers):
            axes = figure.add_subplot(grid[row, column])
            time, file = pictures[name][number]
            drawn = draw_damage(axes, file)
            axes.set_title(f"{name}, {time:.1f} s", fontsize=9)
    figure.colorbar(drawn, ax=figure.axes, label="damage in tension", shrink=.7)
    axes = figure.add_subplot(grid[:, -1])
    for name, folder in runs.items():
        axes.plot(*crest_motion(folder), label=name, linewidth=1.)
    axes.set(xlabel="time [s]", ylabel="crest, downstream [cm]")
    axes.legend(fontsize=8)
    axes.grid(alpha=.3)
    figure.savefig(picture, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], dict(run.split("=", 1) for run in sys.argv[3:]))
