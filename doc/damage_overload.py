#!/usr/bin/env python3
"""Draws the pictures of the overload study in doc/studies.md: damage at the end of
each run of a study, in the section of the crown and on both faces.

usage: doc/damage_overload.py STUDY NAME

Writes NAME_crown.png and NAME_faces.png. STUDY is the output folder of
prm/study_damage_overload.prm, or one with a single run. Needs the same packages as
voussoir-report.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "source" / "report"))

from voussoir_report import charts  # noqa: E402
from voussoir_report.damage import of_cells  # noqa: E402
from voussoir_report.faces import SIDES, panel_of  # noqa: E402
from voussoir_report.grid import Dam, dam_materials, grid_of  # noqa: E402
from voussoir_report.run import Run  # noqa: E402

FIELD = "tension_damage"
SCALE = charts.Scale([], "damage in tension [-]", cut=0., colours="inferno_r", low=0., high=1.)


def factor_of(run):
    return float(run.entry("Ground motion/Overload factor", "1"))


def dam_at(run, picture):
    grid = grid_of(run, run.pictures("fields")[picture][1])
    return Dam(grid, dam_materials(run, grid.names("material")))


def crown(states):
    panels = [(title, dam.crown[0], of_cells(dam, FIELD)[dam.crown[1]]) for title, dam in states]
    return charts.sections_map(panels, SCALE, "", "")


def faces(states):
    """A row for each state, a column for each face."""
    width, gap, head = 2.05, 0.2, 0.2
    height = width * 0.42
    size = len(states) * (height + head) + 1.0
    figure = charts.Figure(figsize=(charts.WIDTH, size))
    for row, (title, dam) in enumerate(states):
        for column, side in enumerate(SIDES):
            quads = dam.side(side)
            axes = charts.place(figure, 0.55 + column * (width + gap),
                                size - 0.25 - (row + 1) * (height + head), width, height)
            values = dam.grid.values[FIELD][quads].mean(axis=1)
            charts.draw_panel(axes, panel_of(dam, side, dam.grid.points[quads], values), SCALE)
            axes.set_title("", loc="left")
            axes.set_axis_off()
            if row == 0:
                axes.set_title(f"{side} face", pad=12)
            if column == 0:
                axes.text(-0.02, 0.5, title, ha="right", va="center", transform=axes.transAxes,
                          fontsize=8)
    SCALE.bar(figure)
    return charts.picture(figure, "", vector=False)


def main():
    study, name = pathlib.Path(sys.argv[1]), sys.argv[2]
    runs = sorted((Run(file.parent) for file in study.glob("*/summary.json")), key=factor_of)
    if not runs:
        sys.exit(f'"{study}" has no finished run.')
    states = [("static", dam_at(runs[0], 0))]
    states += [(f"{factor_of(run):g}" if len(runs) > 1 else f"{run.summary['end time [s]']:g} s",
                dam_at(run, -1)) for run in runs]
    for kind, draw in (("crown", crown), ("faces", faces)):
        pathlib.Path(f"{name}_{kind}.png").write_bytes(draw(states).data)


main()
