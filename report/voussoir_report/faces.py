"""Stresses and damage on the faces of the dam and in its sections."""

import numpy as np

from . import charts
from .grid import dam_of, grid_of
from .page import Pictures, Section, Table, number

SIDES = {"upstream": ("upstream face, seen from upstream (left bank on the left)", -1.),
         "downstream": ("downstream face, seen from downstream (left bank on the right)", 1.)}


def developed(dam, corners, side):
    """Places (n, 4, 2) of corners (n, 4, 3) on a face unrolled along the crest."""
    sign = SIDES[side][1]
    return np.stack([sign * dam.developed(corners[..., 0]), corners[..., 2]], axis=-1)


def face_panels(run, name):
    """Panels of a field of face_stress_envelopes.vtu on both faces."""
    grid, dam = grid_of(run, "face_stress_envelopes.vtu"), dam_of(run)
    panels = []
    for side, (title, _) in SIDES.items():
        if f"{side} face" in grid.names("face_set"):
            quads = grid.cells[grid.of("face_set", f"{side} face")]
            panels.append((title, developed(dam, grid.points[quads], side), grid.values[name][quads]))
    return panels


def stress_maps(runs, fields, label, caption, name, largest=None):
    """A picture for each run of the fields that are compared in colour."""
    every = [face_panels(run, field) for run in runs for field in fields]
    scale = charts.Scale([values for panels in every for _, _, values in panels], label)
    return [charts.face_map(panels, scale, run.prefix + caption, f"{name}_{run.label}",
                            "MPa", largest)
            for run, panels in zip(runs, every)]


def face_stress_section(runs):
    runs = [run for run in runs if run.has("face_stress_envelopes.vtu") and dam_of(run)
            and face_panels(run, "largest_arch_stress_MPa")]
    if not runs:
        return None
    columns = len(runs) if len(runs) < 4 else 3
    columns = max(columns, 2)
    parts = ["Arch stress is along the horizontal of the face, cantilever stress along its steepest "
             "line. Tension is positive and red, pressure negative and blue, each with its own range; "
             "the colours leave out the outermost half per cent, the figures do not. Faces are unrolled "
             "along the crest; distances are from its middle.",
             extremes_table(runs)]
    at_rest = [run for run in runs if run.list("Static state/Stages", ";")
               and "arch_stress_at_start_MPa" in grid_of(run, "face_stress_envelopes.vtu").values]
    if at_rest:
        at_rest = different(at_rest, "arch_stress_at_start_MPa")
        pictures = []
        for title, field in (("arch stress", "arch_stress"), ("cantilever stress", "cantilever_stress"),
                             ("largest principal stress", "largest_principal_stress"),
                             ("smallest principal stress", "smallest_principal_stress")):
            pictures += stress_maps(at_rest, [f"{field}_at_start_MPa"], f"static {title} [MPa]",
                                    f"Static {title}", f"static_{field}", title[0] != "s")
        title = "Static state" + (", the same in all runs" if len(at_rest) == 1 < len(runs) else "")
        parts.append(Pictures(pictures, columns, title))
    for title, field in (("arch stress", "arch_stress"), ("cantilever stress", "cantilever_stress"),
                         ("principal stress", "principal_stress")):
        pictures = []
        for which in ("largest", "smallest"):
            pictures += stress_maps(runs, [f"{which}_{field}_MPa"], f"{which} {title} [MPa]",
                                    f"{which.capitalize()} {title} during the run", f"{which}_{field}",
                                    which == "largest")
        parts.append(Pictures(pictures, columns, f"Envelopes of the {title}"))
    timed = [run for run in runs
             if "time_of_largest_principal_stress_s" in grid_of(run, "face_stress_envelopes.vtu").values]
    if timed:
        parts.append(Pictures(time_maps(timed), columns, "When tension was largest"))
    return Section("Stresses on the faces", parts)


def different(runs, field):
    """The first run of those with the same values."""
    seen = []
    for run in runs:
        values = grid_of(run, "face_stress_envelopes.vtu").values[field]
        if not any(np.array_equal(values, grid_of(other, "face_stress_envelopes.vtu").values[field])
                   for other in seen):
            seen.append(run)
    return seen


def time_maps(runs):
    every = [face_panels(run, "time_of_largest_principal_stress_s") for run in runs]
    scale = charts.Scale([values for panels in every for _, _, values in panels], "time [s]",
                         colours="viridis")
    return [charts.face_map([(title, places, values.mean(axis=1)) for title, places, values in panels],
                            scale, f"{run.prefix}Time of the largest principal stress",
                            f"time_{run.label}")
            for run, panels in zip(runs, every)]


def extremes_table(runs):
    """Largest and smallest values with place and time."""
    rows = []
    for run in runs:
        values = grid_of(run, "face_stress_envelopes.vtu").values
        for which, word in (("largest", "largest"), ("smallest", "smallest")):
            for title, field in (("arch", "arch_stress"), ("cantilever", "cantilever_stress"),
                                 ("principal", "principal_stress")):
                cells = []
                times = values.get(f"time_of_{which}_{field}_s")
                for side in SIDES:
                    cells.append(extreme_on(run, side, f"{which}_{field}", which, times))
                label = f"{word} {title} stress [MPa]"
                rows.append([f"{run.prefix}{label}", *cells])
    return Table(["", "upstream face", "downstream face"], rows)


def extreme_on(run, side, field, which, times):
    grid = grid_of(run, "face_stress_envelopes.vtu")
    if f"{side} face" not in grid.names("face_set"):
        return "–"
    points = grid.cells[grid.of("face_set", f"{side} face")].ravel()
    values = grid.values[f"{field}_MPa"][points]
    at = points[values.argmax() if which == "largest" else values.argmin()]
    x, _, z = grid.points[at]
    when = f", {number(times[at])} s" if times is not None else ""
    return f"{number(grid.values[f'{field}_MPa'][at])} (x = {number(x)} m, z = {number(z)} m{when})"


