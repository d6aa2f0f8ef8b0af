"""Stresses on the faces of the dam."""

import dataclasses

import numpy as np
from matplotlib import ticker

from . import charts
from .grid import dam_of, grid_of
from .page import Pictures, Section, Table, number

FILE = "face_stress_envelopes.vtu"
STRESSES = {"arch_stress": "arch stress", "cantilever_stress": "cantilever stress",
            "principal_stress": "principal stress"}
AT_REST = {"arch_stress": "arch stress", "cantilever_stress": "cantilever stress",
           "largest_principal_stress": "largest principal stress",
           "smallest_principal_stress": "smallest principal stress"}
# +x is the left bank, on the left as seen looking downstream
SIDES = {"upstream": ("upstream face, seen from upstream (left bank on the left)", True),
         "downstream": ("downstream face, seen from downstream (left bank on the right)", False)}


def panel_of(dam, side, corners, values):
    """Values on corners (n, 4, 3) of a face, unrolled along the crest."""
    title, runs_left = SIDES[side]
    places = np.stack([dam.developed(corners[..., 0]), corners[..., 2]], axis=-1)
    xs = corners[..., 0]
    ticks = ticker.MaxNLocator(7, steps=[1, 2, 5, 10]).tick_values(xs.min(), xs.max())
    ticks = ticks[(ticks >= xs.min()) & (ticks <= xs.max())]
    return charts.Panel(title, places, values, (dam.developed(ticks), ticks), runs_left)


def face_panels(run, field, file=FILE):
    """Panels of a field on both faces."""
    grid, dam = grid_of(run, file), dam_of(run)
    panels = []
    for side in SIDES:
        if f"{side} face" in grid.names("face_set"):
            quads = grid.cells[grid.of("face_set", f"{side} face")]
            if len(quads):  # all face sets have names, those not evaluated no quadrilaterals
                panels.append(panel_of(dam, side, grid.points[quads], grid.values[field][quads]))
    return panels


def maps(runs, every, label, caption, name, unit="", largest=None, colours=None):
    """A picture of panels for each run, in the same colours; of slices of a dam, whose faces
    are too narrow for it, one of all."""
    is_slice = [dam_of(run).is_slice for run in runs]
    slices = [run for run, narrow in zip(runs, is_slice) if narrow]
    wide = [(run, panels) for run, panels, narrow in zip(runs, every, is_slice) if not narrow]
    pictures = []
    if wide:
        scale = charts.Scale([panel.values for _, panels in wide for panel in panels], label, colours=colours)
        pictures = [charts.face_map(panels, scale, run.prefix + caption, f"{name}_{run.label}", unit, largest)
                    for run, panels in wide]
    if slices:
        pictures.append(charts.face_profiles(
            slices, [panels for panels, narrow in zip(every, is_slice) if narrow], label,
            f"{caption}, over the elevation" + (", dashed on the downstream face" if len(slices) > 1 else ""), name))
    return pictures


def stress_maps(runs, field, title, largest):
    """A picture of a field for each run, with the largest or smallest value marked."""
    return maps(runs, [face_panels(run, field) for run in runs], f"{title} [MPa]", title[0].upper() + title[1:],
                field.removesuffix("_MPa"), "MPa", largest)


def face_stress_section(runs):
    runs = [run for run in runs if run.has(FILE) and dam_of(run)
            and face_panels(run, "largest_arch_stress_MPa")]
    if not runs:
        return None
    columns = max(2, min(len(runs), 3))
    parts = ["Arch stress acts along the horizontal of the face, cantilever stress along its steepest "
             "line. Tension is positive and red, compression negative and blue, equally deep at the same amount; "
             "the colour range omits the outermost half per cent of the values, the numbers do not. Faces are "
             "unrolled along the crest and have the x of the model below them, as in the table.",
             extremes_table(runs)]
    at_rest = different([run for run in runs if run.list("Static state/Stages", ";")
                         and "arch_stress_at_start_MPa" in grid_of(run, FILE).values],
                        "arch_stress_at_start_MPa")
    if at_rest:
        pictures = [picture for field, title in AT_REST.items() for picture in stress_maps(
            at_rest, f"{field}_at_start_MPa", f"static {title}", not field.startswith("smallest"))]
        title = "Static state" + (", the same in all runs" if len(at_rest) == 1 < len(runs) else "")
        parts.append(Pictures(pictures, columns, title))
    runs = [run for run in runs if run.summary.get("steps", 1)]  # without steps there is the static state only
    for field, title in STRESSES.items() if runs else ():
        pictures = [picture for which in ("largest", "smallest") for picture in stress_maps(
            runs, f"{which}_{field}_MPa", f"{which} {title} during the run", which == "largest")]
        parts.append(Pictures(pictures, columns, f"Envelopes of the {title}"))
    timed = [run for run in runs if "time_of_largest_principal_stress_s" in grid_of(run, FILE).values]
    if timed:
        parts.append(Pictures(time_maps(timed), columns, "Time of the largest tension"))
    return Section("Stresses on the faces", parts)


def different(runs, field):
    """The runs without those that repeat the values of an earlier one."""
    seen = []
    for run in runs:
        values = grid_of(run, FILE).values[field]
        if not any(np.array_equal(values, grid_of(other, FILE).values[field])
                   for other in seen):
            seen.append(run)
    return seen


def time_maps(runs):
    every = [[dataclasses.replace(panel, values=panel.values.mean(axis=1)) for panel in face_panels(
        run, "time_of_largest_principal_stress_s")] for run in runs]
    return maps(runs, every, "time [s]", "Time of the largest principal stress", "time", colours="viridis")


def extremes_table(runs):
    """A table of largest and smallest values with place and time."""
    rows = [[f"{run.prefix}{which} {title} [MPa]", *(extreme_on(run, side, which, field) for side in SIDES)]
            for run in runs for which in ("largest", "smallest") for field, title in STRESSES.items()]
    return Table(["", "upstream face", "downstream face"], rows)


def extreme_on(run, side, which, field):
    """Text of the largest or smallest stress on a face."""
    grid = grid_of(run, FILE)
    if f"{side} face" not in grid.names("face_set"):
        return "–"
    points = grid.cells[grid.of("face_set", f"{side} face")].ravel()
    values = grid.values[f"{which}_{field}_MPa"]
    at = points[values[points].argmax() if which == "largest" else values[points].argmin()]
    x, _, z = grid.points[at]
    times = grid.values.get(f"time_of_{which}_{field}_s")
    when = f", {number(times[at])} s" if times is not None else ""
    return f"{number(values[at])} (x = {number(x)} m, z = {number(z)} m{when})"
