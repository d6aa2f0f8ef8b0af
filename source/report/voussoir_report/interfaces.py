"""Joints, slip planes, and blocks of rock."""

import functools

import numpy as np

from . import charts
from .grid import centre_keys, dam_of, grid_of
from .page import Pictures, Section, Table, number

FILE = "interface_envelopes.vtu"


@functools.lru_cache(maxsize=None)
def surfaces_of(run):
    """Numbers (n, 4) of the corners in the picture of the interfaces, by name."""
    grid = grid_of(run, FILE)
    if grid is None:
        return {}
    quads = {name: grid.cells[grid.of("interface", name)] for name in grid.names("interface")}
    return {name: cells for name, cells in quads.items() if len(cells)}


@functools.lru_cache(maxsize=None)
def joints_of(run):
    """Names of the surfaces with the dam on both sides, from the right bank to the left."""
    dam = dam_of(run)
    if dam is None or not surfaces_of(run):
        return ()
    keys, counts = np.unique(centre_keys(dam.grid.points[dam.grid.faces(dam.cells)]),
                             return_counts=True)
    on_both = keys[counts == 2]
    points = grid_of(run, FILE).points
    found = [name for name, quads in surfaces_of(run).items()
             if np.isin(centre_keys(points[quads]), on_both).all()]
    return tuple(sorted(found, key=lambda name: points[surfaces_of(run)[name], 0].mean()))


def joint_corners(run, name):
    """(n, 4, 3)"""
    return grid_of(run, FILE).points[surfaces_of(run)[name]]


def opening_sections(runs):
    """The joints from the side, coloured by their largest opening."""
    values = [grid_of(run, FILE).values["largest_opening_mm"] for run in runs]
    scale = charts.Scale(values, "largest opening [mm]", 0., "inferno_r", low=0.)
    pictures = []
    for run, opening in zip(runs, values):
        panels = [(name.removeprefix("joint "), list(joint_corners(run, name)[..., 1:]),
                   opening[surfaces_of(run)[name]].mean(axis=1)) for name in joints_of(run)]
        caption = f"{run.prefix}The joints from the side, from the right bank to the left, upstream on the left"
        pictures.append(charts.sections_map(panels, scale, caption, f"opening_{run.label}"))
    return pictures


def opening_profile(run, most):
    """Largest opening of each joint over the elevation, up to @p most [mm]."""
    figure, axes = charts.new_figure(3.4)
    charts.cycle_colours(axes, len(joints_of(run)))
    for name in joints_of(run):
        points = surfaces_of(run)[name].ravel()
        levels, row = np.unique(np.round(grid_of(run, FILE).points[points, 2], 1),
                                return_inverse=True)
        largest = np.zeros(len(levels))
        np.maximum.at(largest, row.reshape(-1), grid_of(run, FILE).values["largest_opening_mm"][points])
        axes.plot(largest, levels, label=name, marker=".", markersize=3)
    axes.set(xlabel="largest opening over the thickness [mm]", ylabel="elevation [m]")
    axes.set_xlim(0., max(1.05 * most, 1e-3))
    axes.set_title(run.title_in_chart, loc="left")
    axes.legend(ncols=2, frameon=False)
    return charts.picture(figure, "Profiles of the largest opening", f"profile_{run.label}")


def history(run, names, quantity, title, most):
    """An opening or a slip of several surfaces over time, up to @p most [mm]."""
    table = run.table("interfaces.csv")
    figure, axes = charts.new_figure(3.)
    charts.lines(axes, [(name, table.time, table[f"{name} {quantity} [mm]"]) for name in names],
                 run.title_in_chart, "time [s]", f"{quantity} [mm]", limits=(0., max(1.05 * most, 1e-3)))
    return charts.picture(figure, title, f"{quantity.replace(' ', '_')}_{run.label}")


def most_of(runs, names_of, quantity):
    """The largest opening or slip of surfaces in all runs [mm]."""
    return max(run.table("interfaces.csv")[f"{name} {quantity} [mm]"].max()
               for run in runs for name in names_of(run))


def surfaces_table(runs, names_of):
    """Extremes of surfaces; a row for each."""
    rows = []
    for run in runs:
        for name in names_of(run):
            values = run.summary["interfaces"]["surfaces"][name]
            rows.append([f"{run.prefix}{name}",
                         number(values["area [m2]"]), number(values["largest opening [mm]"]),
                         number(run.table("interfaces.csv")[f"{name} largest slip [mm]"][0]),
                         number(values["largest slip [mm]"]), number(values["residual slip [mm]"]),
                         number(values["smallest sliding safety"]),
                         number(values["time at safety one or below [s]"])])
    return Table(["surface", "area [m²]", "largest opening [mm]", "slip at the start [mm]",
                  "largest slip [mm]", "slip at the end [mm]", "smallest sliding safety [-]",
                  "time at safety one or below [s]"], rows)


def recorded(runs):
    return [run for run in runs if run.table("interfaces.csv") and surfaces_of(run)
            and "interfaces" in run.summary]


def joints_section(runs):
    runs = [run for run in recorded(runs) if joints_of(run)]
    if not runs:
        return None
    columns = max(2, min(len(runs), 3))
    most = most_of(runs, joints_of, "largest opening")
    text = ("Openings are the largest over the run at each place; an opening of zero is a joint that "
            "stayed closed. Where keys hold the joint there is no sliding safety.")
    return Section("Joints", [
        text, surfaces_table(runs, joints_of),
        Pictures(opening_sections(runs) + [opening_profile(run, most) for run in runs]
                 + [history(run, joints_of(run), "largest opening", "Largest opening of each joint", most)
                    for run in runs], columns)])


def planes_of(run):
    """Names of the surfaces that are not joints of the dam."""
    return [name for name in surfaces_of(run) if name not in joints_of(run)]


def safety_picture(run, columns, caption, name):
    """Sliding safety over time of some (name, values); none where nothing slides."""
    table = run.table("interfaces.csv")
    figure, axes = charts.new_figure(3.)
    curves = [(what, table.time, np.where(np.isfinite(values), np.minimum(values, 100.), np.nan))
              for what, values in columns]
    axes.axhline(1., color="#b3261e", linewidth=1.2)
    finite = np.concatenate([values[np.isfinite(values)] for _, _, values in curves])
    axes.set_ylim(min(0.8, 0.9 * max(finite.min(initial=1.), 0.05)),
                  min(1.5 * finite.max(initial=2.), 20.))
    charts.lines(axes, curves, run.title_in_chart, "time [s]", "sliding safety [-]", log=True)
    ticks = [tick for tick in (0.1, 0.2, 0.5, 1., 2., 5., 10., 20., 50.)
             if axes.get_ylim()[0] <= tick <= axes.get_ylim()[1]]
    axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    return charts.picture(figure, caption, f"{name}_{run.label}")


def blocks_table(runs):
    rows = []
    for run in runs:
        for name, values in run.summary["interfaces"].get("blocks", {}).items():
            rows.append([f"{run.prefix}{name}",
                         number(values.get("safety at the start")), number(values.get("smallest safety")),
                         number(values.get("time of the smallest safety [s]")),
                         number(values.get("time at safety one or below [s]"))])
    return Table(["block", "safety at the start [-]", "smallest safety [-]", "at the time [s]",
                  "time at one or below [s]"], rows) if rows else None


def planes_section(runs):
    runs = [run for run in recorded(runs) if planes_of(run)]
    if not runs:
        return None
    pictures = []
    for run in runs:
        table = run.table("interfaces.csv")
        blocks = [(match[1], values) for match, values in table.matching(r"(.*) block safety \[-\]")]
        if blocks:
            pictures.append(safety_picture(run, blocks, "Safety of blocks against sliding; red: one",
                                           "block_safety"))
        planes = [(name, table[f"{name} sliding safety [-]"]) for name in planes_of(run)]
        planes = [(name, values) for name, values in planes if np.isfinite(values).any()]
        if planes:
            pictures.append(safety_picture(run, planes, "Sliding safety of each plane; red: one",
                                           "plane_safety"))
        for quantity in ("largest slip", "largest opening"):
            pictures.append(history(run, planes_of(run), quantity, f"{quantity.capitalize()} of each plane",
                                    most_of(runs, planes_of, quantity)))
    text = ("The safety of a block is that of limit equilibrium under the contact forces on all its "
            "planes; that of a plane is what friction and cohesion could bear over its shear force, "
            "point by point. A gap in a curve means that nothing drives the block, or that its way is "
            "barred. A safety below one for a short time moves a block a little; what counts then is "
            "the slip that stays.")
    parts = [text, blocks_table(runs), surfaces_table(runs, planes_of), Pictures(pictures, 2)]
    return Section("Slip planes and blocks", [part for part in parts if part])
