#!/usr/bin/env python3
"""The Taft record of Pine Flat Dam for Voussoir, and the crest beside N. Abtahi's.

    python3 pine_flat_taft.py record FOLDER          writes taft_s69e.txt
    python3 pine_flat_taft.py picture FOLDER OUTPUT  draws pine_flat_taft.png

FOLDER is a copy of the program named in gravity_dam_mesh.py, which is not included in
this project; OUTPUT is the output folder of pine_flat_taft_s69e.prm.
"""
import argparse
import csv
import pathlib
import re

import numpy

# [s]; the record starts as a wave at the bottom and reaches the surface so much later
SHIFT = 0.28


def write_record(folder):
    """Writes the component along the river [g], with the sign of Voussoir (y upstream)."""
    text = (folder / "input" / "INPUT-PF4-DAMRes.TXT").read_text()
    text = text.split("[IFUNC.EQ.5: EQ IN X-DIR]")[1].split("[T    F5")[1].split("\n", 1)[1].split("!")[0]
    numbers = [float(n) for n in re.findall(r"-?\d+\.\d+", text)]
    points = dict(zip(numbers[::2], numbers[1::2]))  # the last line repeats its time
    with open("taft_s69e.txt", "w") as out:
        for time, value in points.items():
            print(f"{time:g} {-value:g}", file=out)
    print(len(points), "accelerations, the largest", max(map(abs, points.values())), "g")


def histories(folder, output):
    """Times and displacements of the crest relative to the heel since the static state,
    downstream [s, mm]; of the other program and of Voussoir."""
    table = numpy.loadtxt(folder / "output" / "FEM.HIS", skiprows=1)
    there = table[:, 1] - table[:, 3]
    rows = list(csv.reader(open(output / "histories.csv")))
    numbers = numpy.array(rows[1:], float)
    here = numbers[:, [h.startswith("crest displacement y") for h in rows[0]].index(True)]
    return table[:, 0], 1e3 * (there - there[0]), numbers[:, 0] - SHIFT, -1e3 * (here - here[0])


def draw(folder, output):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    there_at, there, here_at, here = histories(folder, output)
    figure, axes = pyplot.subplots(figsize=(9, 3.2), layout="constrained")
    axes.plot(there_at, there, color="black", linewidth=1, label="Abtahi, FEM.HIS")
    axes.plot(here_at, here, color="tab:red", linewidth=1, linestyle="--", label="Voussoir")
    axes.set(xlim=(0, here_at[-1]), xlabel="time [s]", ylabel="crest against heel, downstream [mm]")
    axes.grid(alpha=0.3)
    axes.legend(loc="upper left")
    figure.savefig("pine_flat_taft.png", dpi=90)
    difference = numpy.interp(there_at, here_at, here) - there
    strong = there_at < here_at[-1]
    print(f"largest {abs(there[strong]).max():.1f} there, {abs(here).max():.1f} here; root mean square "
          f"{numpy.sqrt(numpy.mean(there[strong]**2)):.2f} mm there, of the difference "
          f"{numpy.sqrt(numpy.mean(difference[strong]**2)):.2f} mm")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("action", choices=["record", "picture"])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path, nargs="?", default=pathlib.Path("output/pine_flat_taft_s69e"))
    options = parser.parse_args()
    if options.action == "record":
        write_record(options.folder)
    else:
        draw(options.folder, options.output)


if __name__ == "__main__":
    main()
