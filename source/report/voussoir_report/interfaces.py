"""Contraction joints, lift joints, slip planes, and blocks of rock."""

import functools

import numpy as np

from . import charts, scenes
from .faces import SIDES, panel_of
from .grid import area_vectors, centre_keys, dam_of, grid_of, point_keys
from .motion import GRAVITY
from .page import Pictures, Section, Table, number
from .scenes import FROM_DOWNSTREAM
from .verdict import VISIBLE

FILE = "interface_envelopes.vtu"


@functools.lru_cache(maxsize=None)
def surfaces_of(run):
    """Numbers (n, 4) of the corners of each surface in the picture of the interfaces, by name."""
    grid = grid_of(run, FILE)
    if grid is None:
        return {}
    quads = {name: grid.cells[grid.of("interface", name)] for name in grid.names("interface")}
    return {name: cells for name, cells in quads.items() if len(cells)}


@functools.lru_cache(maxsize=None)
def joints_of(run):
    """Names of the surfaces between two parts of the dam."""
    dam = dam_of(run)
    if dam is None or not surfaces_of(run):
        return ()
    keys, counts = np.unique(centre_keys(dam.grid.points[dam.grid.faces(dam.cells)]),
                             return_counts=True)
    on_both = keys[counts == 2]
    points = grid_of(run, FILE).points
    return tuple(name for name, quads in surfaces_of(run).items()
                 if np.isin(centre_keys(points[quads]), on_both).all())


def is_level(run, name):
    """Whether a surface is nearer to level than to steep."""
    x, y, z = np.abs(area_vectors(joint_corners(run, name))).sum(axis=0)
    return z > np.hypot(x, y)


def contraction_joints(run):
    """Names of the joints between blocks of the dam, from the right bank to the left."""
    return tuple(sorted((name for name in joints_of(run) if not is_level(run, name)),
                        key=lambda name: joint_corners(run, name)[..., 0].mean()))


def lift_joints(run):
    """Names of the joints between lifts of concrete, from below."""
    return tuple(sorted((name for name in joints_of(run) if is_level(run, name)),
                        key=lambda name: joint_corners(run, name)[..., 2].mean()))


def joint_corners(run, name):
    """Corners (n, 4, 3) of a joint."""
    return grid_of(run, FILE).points[surfaces_of(run)[name]]


def scale_of_openings(values, label):
    """Colours of openings of joints or cracks [mm], so that visible ones are seen beside those of fragments."""
    values = np.concatenate([np.zeros(0), *(np.ravel(own) for own in values)])
    visible = values[values > VISIBLE]
    high = charts.usual_largest(visible, 0.9) if len(visible) else None
    return charts.Scale([values], label, colours="inferno_r", low=0., high=high)


def opening_sections(runs):
    """Pictures of the contraction joints from the side, coloured by their largest opening."""
    values = [grid_of(run, FILE).values["largest_opening_mm"] for run in runs]
    every = [[(name.removeprefix("joint "), list(joint_corners(run, name)[..., 1:]),
               opening[surfaces_of(run)[name]].mean(axis=1)) for name in contraction_joints(run)]
             for run, opening in zip(runs, values)]
    scale = scale_of_openings([opening for panels in every for _, _, opening in panels], "largest opening [mm]")
    pictures = []
    for run, panels in zip(runs, every):
        above = scale.largest_above(np.concatenate([opening for _, _, opening in panels]))
        caption = (f"{run.prefix}The contraction joints from the side, from the right bank to the left, upstream on the "
                   f"left{above}")
        pictures.append(charts.sections_map(panels, scale, caption, f"opening_{run.label}"))
    return pictures


def edges_of(run, name):
    """Elevation [m] and largest opening [mm] of a joint along each face of the dam,
    from the bottom up."""
    dam, grid = dam_of(run), grid_of(run, FILE)
    numbers = np.unique(surfaces_of(run)[name])
    keys = point_keys(grid.points[numbers])
    found = {}
    for side in SIDES:
        on_face = numbers[np.isin(keys, point_keys(dam.grid.points[dam.side(side)].reshape(-1, 3)))]
        levels, row = np.unique(np.round(grid.points[on_face, 2], 1), return_inverse=True)
        largest = np.zeros(len(levels))
        np.maximum.at(largest, row.reshape(-1), grid.values["largest_opening_mm"][on_face])
        found[side] = levels, largest
    return found


def opening_profiles(run, most):
    """A chart for each contraction joint of its largest opening over the elevation on both faces, with
    openings up to @p most [mm]."""
    names = contraction_joints(run)
    columns = min(len(names), 5)
    rows = -(-len(names) // columns)
    width, height = (charts.WIDTH - 0.7) / columns, 1.75
    figure = charts.Figure(figsize=(charts.WIDTH, rows * height + 0.55))
    heights = [level for name in names for levels, _ in edges_of(run, name).values() for level in levels]
    for n, name in enumerate(names):
        row, column = divmod(n, columns)
        axes = charts.place(figure, 0.62 + column * width, 0.42 + (rows - 1 - row) * height, width - 0.14,
                            height - 0.5)
        for (side, style), (levels, largest) in zip((("upstream", "-"), ("downstream", "--")),
                                                    edges_of(run, name).values()):
            axes.plot(largest, levels, style, marker=".", markersize=3, label=f"{side} face")
        axes.set(xlim=(0., 1.05 * most), ylim=(min(heights), max(heights)))
        axes.set_title(name, loc="left", fontsize=8.5)
        axes.tick_params(labelsize=7.5)
        axes.locator_params(axis="x", nbins=3)
        if column:
            axes.tick_params(labelleft=False)
        else:
            axes.set_ylabel("z [m]", fontsize=8.5)
    figure.legend(*axes.get_legend_handles_labels(), ncols=2, frameon=False, loc="upper center")
    figure.supxlabel("largest opening [mm]", fontsize=9)
    return charts.picture(figure, f"{run.prefix}Largest opening of each contraction joint over the elevation, on "
                          "both faces",
                          f"profile_{run.label}")


def history(run, names, quantity, kind, most):
    """A chart of an opening or a slip of several surfaces of a kind over time, up to @p most [mm]."""
    table = run.table("interfaces.csv")
    figure, axes = charts.new_figure(3.)
    charts.lines(axes, [(name, table.time, table[f"{name} {quantity} [mm]"]) for name in names],
                 run.title_in_chart, "time [s]", f"{quantity} [mm]", limits=(0., max(1.05 * most, 1e-3)))
    return charts.picture(figure, f"{quantity.capitalize()} of each {kind}",
                          f"{quantity}_{kind}_{run.label}".replace(" ", "_"))


def most_of(runs, names_of, quantity):
    """The largest opening or slip of surfaces in all runs [mm]."""
    return max(run.table("interfaces.csv")[f"{name} {quantity} [mm]"].max()
               for run in runs for name in names_of(run))


def surfaces_table(runs, names_of):
    """A table of extremes with a row for each surface."""
    rows = []
    for run in runs:
        for name in names_of(run):
            values = run.summary["interfaces"]["surfaces"][name]
            rows.append([f"{run.prefix}{name}",
                         number(values["area [m2]"]), number(values["largest opening [mm]"]),
                         number(run.table("interfaces.csv")[f"{name} largest slip [mm]"][0]),
                         number(values["largest slip [mm]"]), number(values["residual slip [mm]"]),
                         number(values.get("slip rate at the end [mm/s]")),
                         number(values["smallest sliding safety"]),
                         number(values["time at safety one or below [s]"])])
    return Table(["surface", "area [m²]", "largest opening [mm]", "slip at the start [mm]",
                  "largest slip [mm]", "slip at the end [mm]", "slip rate at the end [mm/s]", "smallest sliding safety [-]",
                  "time at safety one or below [s]"], rows)


def recorded(runs):
    return [run for run in runs if run.table("interfaces.csv") and surfaces_of(run)
            and "interfaces" in run.summary]


def contraction_joints_section(runs):
    runs = [run for run in recorded(runs) if contraction_joints(run)]
    if not runs:
        return None
    columns = max(2, min(len(runs), 3))
    most = most_of(runs, contraction_joints, "largest opening")
    if most < charts.NOISE:
        return Section("Contraction joints", ["No contraction joint opened.", surfaces_table(runs, contraction_joints)])
    text = ("Openings are the largest over the run at each place; at an opening of zero the joint "
            "remained closed. Where keys prevent slip there is no sliding safety.")
    return Section("Contraction joints", [
        text, surfaces_table(runs, contraction_joints),
        Pictures(opening_sections(runs) + [opening_profiles(run, most) for run in runs]
                 + [history(run, contraction_joints(run), "largest opening", "contraction joint", most) for run in runs],
                 columns)])


def moved_lifts(run):
    """Names of the lift joints that opened or slipped."""
    surfaces = run.summary["interfaces"]["surfaces"]
    motions = {name: [surfaces[name][f"largest {what} [mm]"] for what in ("opening", "slip")] for name in lift_joints(run)}
    return [name for name, amounts in motions.items() if any(amount is None or amount > charts.NOISE for amount in amounts)]


def moved_in_words(run):
    """How many lift joints opened or slipped, and which, with their mean elevations."""
    places = [f"{name} at z = {number(joint_corners(run, name)[..., 2].mean())} m" for name in moved_lifts(run)]
    return (f"{len(places)} of {len(lift_joints(run))} lift joints opened or slipped"
            + (f": {', '.join(places)}" if places else ""))


def lifts_on_faces(run):
    """Panels of both faces with a band along each lift joint, of its largest opening there [mm]; the concrete has the
    colour of a closed joint."""
    dam, grid = dam_of(run), grid_of(run, FILE)
    quads = np.concatenate([surfaces_of(run)[name] for name in lift_joints(run)])
    edges = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)
    panels = []
    for side in SIDES:
        face = dam.grid.points[dam.side(side)]
        own = edges[np.isin(point_keys(grid.points), point_keys(face.reshape(-1, 3)))[edges].all(axis=1)]
        first, second = grid.points[own].transpose(1, 0, 2)
        up = (0., 0., 0.006 * dam.height)
        bands = np.stack([first - up, second - up, second + up, first + up], axis=1)
        openings = grid.values["largest_opening_mm"][own].mean(axis=1)
        panels.append(panel_of(dam, side, np.concatenate([face, bands]), np.append(np.zeros(len(face)), openings)))
    return panels


def lift_pictures(runs):
    """Pictures of the lift joints along the faces of the dam, coloured by their largest opening."""
    every = [lifts_on_faces(run) for run in runs]
    scale = scale_of_openings([panel.values for panels in every for panel in panels], "largest opening [mm]")
    pictures = []
    for run, panels in zip(runs, every):
        above = scale.largest_above(np.concatenate([panel.values for panel in panels]))
        pictures.append(charts.face_map(panels, scale, f"{run.prefix}Largest opening of the lift joints on the faces{above}",
                                        f"lifts_{run.label}"))
    return pictures


def lift_joints_section(runs):
    runs = [run for run in recorded(runs) if lift_joints(run)]
    if not runs:
        return None
    counts = "; ".join(f"{run.prefix}{moved_in_words(run)}" for run in runs)
    moved = [run for run in runs if moved_lifts(run)]
    if not moved:
        return Section("Lift joints", [f"{counts}."])
    parts = [f"{counts}. Openings are the largest over the run at each place.", surfaces_table(moved, moved_lifts)]
    most = most_of(moved, moved_lifts, "largest opening")
    if most > charts.NOISE:
        # the faces of a slice are too narrow
        pictures = lift_pictures([run for run in moved if not dam_of(run).is_slice])
        pictures += [history(run, moved_lifts(run), "largest opening", "lift joint that moved", most) for run in moved]
        parts.append(Pictures(pictures, max(2, min(len(moved), 3))))
    return Section("Lift joints", parts)


def planes_of(run):
    """Names of the surfaces that are not joints of the dam."""
    return [name for name in surfaces_of(run) if name not in joints_of(run)]


def safety_picture(run, columns, caption, name, axis="resistance over contact forces [-]"):
    """A chart of sliding safeties (name, values) over time; with gaps where no sliding is possible."""
    table = run.table("interfaces.csv")
    figure, axes = charts.new_figure(3.)
    curves = [(what, table.time, np.where(np.isfinite(values), np.minimum(values, 100.), np.nan))
              for what, values in columns]
    axes.axhline(1., color="#b3261e", linewidth=1.2)
    finite = np.concatenate([values[np.isfinite(values)] for _, _, values in curves])
    axes.set_ylim(min(0.8, 0.9 * max(finite.min(initial=1.), 0.05)),
                  min(1.5 * finite.max(initial=2.), 20.))
    charts.lines(axes, curves, run.title_in_chart, "time [s]", axis, log=True)
    ticks = [tick for tick in (0.1, 0.2, 0.5, 1., 2., 5., 10., 20., 50.)
             if axes.get_ylim()[0] <= tick <= axes.get_ylim()[1]]
    axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    return charts.picture(figure, caption, f"{name}_{run.label}")


def blocks_table(runs):
    rows = []
    for run in runs:
        for name, values in run.summary["interfaces"].get("blocks", {}).items():
            mass = values.get("mass [kg]")
            rows.append([f"{run.prefix}{name}", number(mass and 1e-6 * GRAVITY * mass),
                         number(values.get("safety at the start")), number(values.get("smallest safety")),
                         number(values.get("time of the smallest safety [s]")),
                         number(values.get("time at safety one or below [s]")),
                         number(values.get("slip at the end [mm]")), number(values.get("slip rate at the end [mm/s]")),
                         number(values.get("largest mobilised ratio"))])
    return Table(["block", "weight [MN]", "resistance over driving forces at the start [-]", "smallest [-]",
                  "at the time [s]", "time at one or below [s]", "slip at the end [mm]", "slip rate at the end [mm/s]",
                  "largest mobilised ratio [-]"], rows) if rows else None


def forces_table(runs):
    """The forces on each block at its smallest factor of safety, for a check by hand."""
    rows = []
    for run in runs:
        for name, values in run.summary["interfaces"].get("blocks", {}).items():
            forces = values.get("forces at the smallest safety [N]", {})
            acting = {f"contact force of {plane}": force for plane, force in forces.get("contact", {}).items()}
            if "driving, with inertia" in forces:
                acting["driving force, with its inertia"] = forces["driving, with inertia"]
            rows += [[f"{run.prefix}{name}", what, *(number(1e-6 * component) for component in force)]
                     for what, force in acting.items()]
    return Table(["block", "at its smallest safety", "x [MN]", "y [MN]", "z [MN]"], rows) if rows else None


def planes_picture(runs):
    """Pictures of the dam and the planes, each in its colour; runs with the same planes once."""
    pictures, seen = [], []
    for run in runs:
        names = tuple(planes_of(run))
        corners = [joint_corners(run, name) for name in names]
        place = (names, *(tuple(np.round(c.mean(axis=(0, 1)), 1)) for c in corners))
        if place in seen or dam_of(run) is None:
            continue
        seen.append(place)
        colours = charts.distinct(len(names))
        dam = dam_of(run)
        drawn = [scenes.quadrilaterals(dam.grid.points[dam.exposed], scenes.CONCRETE)]
        drawn += [scenes.quadrilaterals(c, colour) for c, colour in zip(corners, colours)]
        around = np.concatenate([dam.points, *(c.reshape(-1, 3) for c in corners)])
        for direction, where, short in ((FROM_DOWNSTREAM, "from downstream and above", "downstream"),
                                        ((0.02, -0.05, 1.), "from above", "above")):
            pictures.append(charts.framed(
                *scenes.draw(drawn, around, direction), f"{run.prefix}Slip planes and the dam, seen {where}",
                f"planes_{short}_{run.label}", legend=dict(zip(names, colours))))
    return Pictures(pictures, 2)


def planes_section(runs):
    runs = [run for run in recorded(runs) if planes_of(run)]
    if not runs:
        return None
    pictures = []
    for run in runs:
        table = run.table("interfaces.csv")
        blocks = [(match[1], values) for match, values in table.matching(r"(.*) block safety \[-\]")]
        if blocks:
            pictures.append(safety_picture(run, blocks, "Blocks: resistance over driving forces; red: one",
                                           "block_safety", "resistance over driving forces [-]"))
        planes = [(name, table[f"{name} sliding safety [-]"]) for name in planes_of(run)]
        planes = [(name, values) for name, values in planes if np.isfinite(values).any()]
        if planes:
            pictures.append(safety_picture(run, planes, "Planes: resistance over contact forces; red: one",
                                           "plane_safety"))
        for quantity in ("largest slip", "largest opening"):
            most = most_of(runs, planes_of, quantity)
            if most > charts.NOISE:
                pictures.append(history(run, planes_of(run), quantity, "plane", most))
    text = ("Factor of safety of a block: resistance of its planes over the driving forces (weight, water, uplift, "
            "thrust of the dam and the block's inertia as if it moved with its base), by limit equilibrium; below one "
            "the block slides, and slip and slip rate show how far. The mobilised ratio is the shear of the contact "
            "forces over the resistance of the planes: about one at most, as friction limits the shear, "
            "and above it for moments, as friction follows the pressure with a delay. Sliding safety "
            "of a plane: resistance by friction and cohesion over the shear force, by the resultants of its contact "
            "forces, which does not fall below one either. At a gap in a curve the block has no driving force, or other "
            "planes prevent its slip.")
    parts = [text, planes_picture(runs), blocks_table(runs), forces_table(runs), surfaces_table(runs, planes_of),
             Pictures(pictures, 2)]
    return Section("Slip planes and blocks", [part for part in parts if part])
