"""All results of each static stage in the summary."""

import numpy as np

from . import charts, scenes
from .grid import dam_in
from .page import Pictures, Section, Table, number
from .run import is_quantity
from .structure import magnified

FILE, FIELD = "static_stages.vtu", "displacement after "

# data of the solver, and quantities in the table of the load cases
LEFT_OUT = ("name", "names", "iterations", "load increments", "found by multigrid", "steps of dynamic relaxation",
            "loads", "sum of loads so far [N]", "sum of reactions [N]")


def stages_of(run):
    """Names and values of the static stages."""
    stages = run.summary.get("static state", {}).get("stages", [])
    return [(stage.get("name") or ", ".join(stage.get("names", [])) or f"static {n}",
             {key: value for key, value in stage.items() if key not in LEFT_OUT}) for n, stage in enumerate(stages, 1)]


def objects_in(values, name=""):
    """Names of the objects in an object of the summary, and their quantities."""
    quantities = {key: value for key, value in values.items() if is_quantity(value)}
    if quantities:
        yield name, quantities
    for key, value in values.items():
        if isinstance(value, dict):
            yield from objects_in(value, f"{name}, {key}" if name else key)


def amounts(value):
    return [abs(v) for v in (value if isinstance(value, list) else [value]) if v is not None and v == v]


def place_of(key, keys):
    """The quantity whose place is under this key, or None."""
    if not key.startswith("place of the "):
        return None
    what = key.removeprefix("place of the ").removesuffix("[m]")
    return next((other for other in keys if other.startswith(what + "[")), None)


def table_of(heads, rows):
    """A table of rows (words, quantities) with a column for each quantity, each value with
    its place; positions first, displacements in mm."""
    keys = dict.fromkeys(key for _, quantities in rows for key in quantities)
    placed = {place_of(key, keys): key for key in keys if place_of(key, keys)}
    places = [key for key in keys if key in placed.values() or key.startswith(("position", "at "))]
    # values that are so small against the others are round-off
    noise = {key: max(1e-9 if key.endswith("[m]") else 1e-6, 1e-6 * max(
        (amount for _, quantities in rows for amount in amounts(quantities.get(key))), default=0.)) for key in keys}
    shown = sorted((key for key in keys if key not in placed.values()), key=lambda key: not key.startswith("position"))

    def small(key):
        return "displacement" in key and key.endswith("[m]") and key not in places

    def text(key, value):
        if isinstance(value, list):
            return "; ".join(text(key, part) for part in value)
        value = 0. if value is not None and abs(value) < noise[key] else value
        return number(1e3 * value if small(key) and value is not None else value)

    def cell(key, quantities):
        if key not in quantities:
            return "–"
        place = quantities.get(placed.get(key))
        return text(key, quantities[key]) + (f" at {text(placed[key], place)}" if place else "")

    def acts(quantities):
        return any(quantities[key] is None or any(amount >= noise[key] for amount in amounts(quantities[key]))
                   for key in quantities if key not in places)

    titles = [(f"{key[:-3]}[mm]" if small(key) else key) + (" at x; y; z [m]" if key in placed else "") for key in shown]
    return Table([*heads, *titles], [[*words, *(cell(key, quantities) for key in shown)]
                                     for words, quantities in rows if acts(quantities)])


def different(runs):
    """The runs without those that repeat the stages of an earlier one."""
    seen = []
    for run in runs:
        if stages_of(run) and not any(stages_of(run) == stages_of(other) for other in seen):
            seen.append(run)
    return seen


def grouted(run, n):
    """Words on gaps in joints that are grouted by the end of the @p n-th stage: displacements count from the unloaded
    model, openings from grouting."""
    loads = [load.strip() for stage in run.list("Static state/Stages", ";")[:n]
             for load in stage.rpartition(":")[2].split(",")]
    after = dict.fromkeys(entries["Grouted after"] for _, entries in run.objects("Interfaces")
                          if entries.get("Grouted after") in loads)
    return (f"; gaps that joints had when they were grouted, after {', '.join(after)}, are filled and no openings"
            if after else "")


def stage_pictures(run):
    """Pictures of the dam after each stage, all with the same magnification and colours."""
    dam = dam_in(run, FILE)
    faces = dam.exposed
    fields = {name.removeprefix(FIELD): values[faces] for name, values in dam.grid.values.items()
              if name.startswith(FIELD)}
    amounts = {name: np.linalg.norm(values, axis=2) for name, values in fields.items()}
    largest = max((amount.max() for amount in amounts.values()), default=0.)
    if largest < 1e-9:
        return []
    factor = magnified(dam, largest)
    scale = charts.Scale([1e3 * amount for amount in amounts.values()], "displacement [mm]", 0., "viridis", low=0.)
    pictures = []
    for n, (name, values) in enumerate(fields.items(), 1):
        moved = dam.grid.points[faces] + factor * values
        actor = scenes.quadrilaterals(moved, scale.colours(scale.norm(1e3 * amounts[name]))[..., :3])
        image = scenes.draw([actor], dam.points, scenes.FROM_DOWNSTREAM, zoom=0.85)
        pictures.append(charts.framed(*image, f"{run.prefix}After the stage \"{name}\", from downstream and above, drawn "
                                              f"{factor:g} times: up to {number(1e3 * amounts[name].max())} mm"
                                              f"{grouted(run, n)}",
                                      f"stage_{n}_{run.label}", scale))
    return pictures


def last_seen_first(table, last):
    """The lines of a table after the last stage, by their words, and the whole table folded behind them."""
    rows = [row for row in table.rows if tuple(row[:2]) in last]
    if len(rows) in (0, len(table.rows)):
        return [table]
    return [Table(table.head, rows), Table(table.head, table.rows, folded=f"{table.head[0]}, after each stage")]


def stages_section(runs):
    """Tables of the quantities of stages, and of each group of named objects."""
    groups, last = {}, set()
    shown = different(runs)
    for run in shown:
        prefix = run.prefix if len(shown) > 1 else ""
        for stage, values in stages_of(run):
            own = {key: value for key, value in values.items() if is_quantity(value)}
            if own:
                groups.setdefault("", {}).setdefault(prefix, []).append(((prefix + stage,), own))
            for group in values:
                for name, quantities in objects_in(values[group]) if isinstance(values[group], dict) else ():
                    name = prefix + name
                    groups.setdefault(group, {}).setdefault(name, []).append(((name, stage), quantities))
                    if stage == stages_of(run)[-1][0]:
                        last.add((name, stage))
    tables = [table_of([group, "after the stage"] if group else ["after the stage"],
                       [row for rows in of_names.values() for row in rows]) for group, of_names in groups.items()]
    tables = [part for table in tables if table.rows for part in last_seen_first(table, last)]
    if not tables:
        return None
    pictures = [picture for run in shown if run.has(FILE) for picture in stage_pictures(run)]
    return Section("Static stages", [
        *(["They are the same in all runs."] if len(shown) == 1 < len(runs) else []),
        "Results after each stage, under all loads so far. Displacements are relative to the unloaded model. Objects "
        "whose values are all zero after a stage, such as joints that are grouted later, have no line for it."
        + (" Tables of objects show the last stage; those of all stages unfold on a screen, and are in static_stages.csv."
           if any(table.folded for table in tables) else ""), *tables,
        *([Pictures(pictures, 2)] if pictures else [])])
