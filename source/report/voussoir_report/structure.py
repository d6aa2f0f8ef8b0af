"""The dam in space: its mesh, its natural modes, and its deformation with open joints."""

import functools
import re

import numpy as np

from . import charts, motions, scenes
from .grid import dam_in, dam_of, grid_of
from .page import Pictures, Scene, Section, Table, comparison, number
from .scenes import FROM_DOWNSTREAM

SCALED_JACOBIAN = "scaled Jacobian [-]"
CARRIED = re.compile(r"^Material (.+?): mass ([\d.e+-]+) kg, P wave ([\d.e+-]+) m/s, S wave ([\d.e+-]+) m/s; "
                     r"its largest cells carry waves up to ([\d.e+-]+) Hz with 8 nodes per wavelength", re.MULTILINE)


def rock_faces(dam):
    """Corners of the ground around the dam."""
    grid = dam.grid
    corners = grid.points[grid.outer_faces(dam.others, np.arange(len(grid.cells)))]
    corners = corners[scenes.without_outer_planes(corners)]
    low, high = dam.points.min(axis=0), dam.points.max(axis=0)
    beside = 0.6 * dam.height
    middle = corners.mean(axis=1)
    near = ((middle[:, :2] > low[:2] - beside) & (middle[:, :2] < high[:2] + beside)).all(axis=1)
    return corners[near & (middle[:, 2] < high[2] + beside)]


def mesh_picture(run):
    dam = dam_of(run)
    at_points = np.zeros(len(dam.grid.points))
    at_points[dam.grid.cells] = dam.grid.quality[:, None]
    scale = charts.Scale([dam.grid.quality[dam.cells]], f"{SCALED_JACOBIAN} of the cells of the dam",
                         cut=0., colours="viridis", low=0., high=1.)
    outer = dam.exposed
    actors = [scenes.quadrilaterals(dam.grid.points[outer],
                                    scale.colours(scale.norm(at_points[outer[:, 0]]))[:, :3])]
    if len(dam.others):
        actors.append(scenes.quadrilaterals(rock_faces(dam), scenes.STONE))
    direction, where = (((-1., -0.5, 0.3), "the right bank") if dam.is_slice
                        else (FROM_DOWNSTREAM, "downstream and above"))
    image = scenes.draw(actors, dam.points, direction, zoom=0.85)
    return charts.framed(*image, f"{run.prefix}The mesh, seen from {where}", f"mesh_{run.label}", scale)


def section_picture(run):
    """Outlines of the cells in the crown section and in horizontal sections."""
    dam = dam_of(run)
    levels = [dam.bottom + share * dam.height for share in (0.75, 0.5, 0.25)]
    level = [dam.section(at, axis=2)[0] for at in levels]
    if dam.is_slice or not dam.crown[0]:
        return None
    figure = charts.Figure(figsize=(charts.WIDTH, 3.6))
    axes = charts.place(figure, 0.6, 0.5, 1.6, 2.8)
    for polygon in dam.crown[0]:
        axes.fill(*polygon.T, facecolor="none", edgecolor="0.3", linewidth=0.5)
    axes.set_aspect("equal", adjustable="datalim")
    axes.invert_xaxis()
    axes.set(xlabel="y [m]", ylabel="elevation z [m]")
    axes.set_title("crown, upstream on the left", loc="left")
    points = np.concatenate([polygon for polygons in level for polygon in polygons])
    across, along = (charts.with_margin(points[:, axis]) for axis in (0, 1))
    for n, polygons in enumerate(level):
        axes = charts.place(figure, 2.8, 2.55 - 1.02 * n, 2.1, 0.75)
        for polygon in polygons:
            axes.fill(*polygon.T, facecolor="none", edgecolor="0.3", linewidth=0.5)
        # the same scale in all sections
        axes.set(xlim=across, ylim=along, ylabel="y [m]")
        axes.set_aspect("equal", anchor="W")
        axes.tick_params(labelbottom=n == 2)
        axes.set_title(f"at z = {number(levels[n])} m{', upstream above' if n == 0 else ''}", loc="left")
    axes.set_xlabel("x [m]")
    return charts.picture(figure, f"{run.prefix}Sections through the dam with their cells", f"sections_{run.label}")


def mesh_section(runs):
    why_refined = [text for text in map(refined, runs) if text]
    runs = [run for run in runs if dam_of(run)]
    if not runs:
        return Section("Mesh", why_refined) if why_refined else None

    def of(of_dam, function):
        def text(run):
            dam = dam_of(run)
            cells = dam.cells if of_dam else dam.others
            return function(dam, cells) if len(cells) else None
        return text

    def edges(dam, cells):
        lengths = dam.grid.edges(cells)
        return f"{number(lengths.min())} to {number(lengths.max())}"

    def through(dam, _):
        return " / ".join(number(dam.cells_through(share)) for share in (0.95, 0.5, 0.02))

    rows = [("cells through the thickness at the crown: top / middle / bottom", of(True, through)),
            ("degree of the elements", lambda run: run.summary.get("degree") and number(run.summary["degree"])),
            ("extent of the model x; y; z [m]", extents),
            ("model beyond the dam, in heights of the dam: left / right, upstream / downstream, down", beyond)]
    for of_dam, where in ((True, "dam"), (False, "rock and water")):
        rows += [(f"{where}: cells, as drawn", of(of_dam, lambda dam, cells: number(len(cells)))),
                 (f"{where}: edges [m]", of(of_dam, edges)),
                 (f"{where}: worst {SCALED_JACOBIAN}",
                  of(of_dam, lambda dam, cells: number(dam.grid.quality[cells].min()))),
                 (f"{where}: cells with a {SCALED_JACOBIAN} below 0.3, in %",
                  of(of_dam, lambda dam, cells: number(100. * (dam.grid.quality[cells] < 0.3).mean())))]
    text = ("The scaled Jacobian is 1 for a brick, 0 where a corner is flat; below 0.2 stresses beside "
            "such a corner are doubtful.")
    # one picture for runs on the same mesh
    pictures = {len(dam_of(run).grid.cells): (mesh_picture(run), section_picture(run)) for run in reversed(runs)}
    pictures = [picture for pair in reversed(pictures.values()) for picture in pair if picture]
    parts = [text, *why_refined, comparison(runs, rows), waves_table(runs), Pictures(pictures, 2)]
    return Section("Mesh", [part for part in parts if part])


def refined(run):
    """Which cells were refined where cracks are expected, and why."""
    found = run.summary.get("refined where cracks are expected")
    if not found:
        return None
    text = (f"{run.prefix}Refined where cracks are expected: {number(found['cells chosen'])} of "
            f"{number(found['cells before'])} cells, {found['chosen']}")
    if "cells in their place" not in found:
        return f"{text}."
    low, high = (", ".join(number(x) for x in found[f"chosen {end} [m]"]) for end in ("from", "to"))
    asked = "; ".join(f"{name}: {number(edge)} m" for name, edge in found["longest edge asked for [m]"].items())
    return (f"{text}; they lie between ({low}) and ({high}) m. In their place are "
            f"{number(found['cells in their place'])} cells with edges of up to {number(found['longest edge there [m]'])} m "
            f"(asked for: {asked}), of which {number(found['cells that stay longer'])} stay longer. The mesh has "
            f"{number(found['cells after'])} cells.")


def extents(run):
    points = dam_of(run).grid.points
    return "; ".join(f"{number(low)} to {number(high)}" for low, high in zip(points.min(axis=0), points.max(axis=0)))


def beyond(run):
    """Extent of the model beyond the dam, in heights of the dam."""
    dam = dam_of(run)
    if not len(dam.others):
        return None
    above = (dam.grid.points.max(axis=0) - dam.points.max(axis=0)) / dam.height
    below = (dam.points.min(axis=0) - dam.grid.points.min(axis=0)) / dam.height
    return (f"{number(above[0], 2)} / {number(below[0], 2)}, {number(above[1], 2)} / {number(below[1], 2)}, "
            f"{number(below[2], 2)}")


def waves_table(runs):
    """A table of nodes per shear wave in the largest cells of each material, at relevant frequencies."""
    rows = []
    for run in runs:
        found = {match[1]: match for match in CARRIED.finditer(run.log)}
        modes = run.summary.get("modes", {}).get("modes", [])
        motion = motions.ground_motion(run)
        frequencies = [modes[0]["frequency [Hz]"] if modes else None,
                       *(motion.frequency_of_power(share) if motion else None for share in (0.5, 0.9))]
        for name, match in found.items():
            carried = float(match[5])
            rows.append([f"{run.prefix}{name}", number(float(match[3])), number(float(match[4])), number(carried, 2),
                         *("–" if not f else f"{number(8. * carried / f, 2)} at {number(f)} Hz"
                           for f in frequencies)])
    return Table(["material", "P wave [m/s]", "S wave [m/s]", "8 nodes per wave up to [Hz]",
                  "nodes per wave in the first mode", "below which half of the input's power lies",
                  "below which nine tenths lie"], rows,
                 "Nodes per shear wave in the largest cells, at relevant frequencies; fewer than about five do not "
                 "carry a wave.") if rows else None


def modes_section(runs):
    runs = [run for run in runs if run.summary.get("modes", {}).get("modes")]
    if not runs:
        return None
    parts = []
    for run in runs:
        rows = []
        for n, mode in enumerate(run.summary["modes"]["modes"], 1):
            rows.append([str(n), number(mode["frequency [Hz]"], 4), number(mode["period [s]"]),
                         damping_at(run, mode["frequency [Hz]"]),
                         *(of_mass(share) for share in mode["effective mass [-]"]),
                         *(of_mass(share) for share in mode["cumulative effective mass [-]"])])
        masses = [f"{of} {d} [%]" for of in ("effective mass", "cumulative") for d in "xyz"]
        parts.append(Table(["mode", "frequency [Hz]", "period [s]", "damping achieved [%]", *masses], rows,
                           run.label if len(runs) > 1 else ""))
        if run.has("modes.vtu"):
            pictures = mode_pictures(run)
            parts.append(Pictures(pictures, 2 if len(pictures) in (2, 4) else 3))
    parts.insert(0, "Damping achieved is that of the damping model at the frequency of the mode, interpolated "
                    "between frequencies in the log; radiation through the boundary is added to it. Pictures are views "
                    "from downstream and above; their colours go from no displacement (dark) to the largest of the mode.")
    return Section("Natural modes", parts)


def of_mass(share):
    """Text of an effective mass [%]; shares below a ten-thousandth are zero."""
    return number(100. * share) if share > 1e-4 else "0"


@functools.lru_cache(maxsize=None)
def damping_curve(run):
    """Frequencies [Hz] and damping ratios [%] achieved, by the last such lines of the log."""
    lines = re.findall(r"^Damping: .*achieved\n\s*(.*)$", run.log, re.MULTILINE)
    return [(float(f), float(ratio)) for f, ratio in re.findall(r"([\d.]+) Hz ([\d.]+) %", lines[-1])] if lines else []


def damping_at(run, frequency):
    """Text of the damping achieved at a frequency."""
    curve = damping_curve(run)
    if not curve or not curve[0][0] <= frequency <= curve[-1][0]:
        return "–"
    frequencies, ratios = zip(*curve)
    return number(float(np.interp(np.log(frequency), np.log(frequencies), ratios)), 2)


def mode_pictures(run, most=6):
    dam = dam_in(run, "modes.vtu")
    grid, outer = dam.grid, dam.exposed
    names = [name for name in grid.values if name.startswith("mode ")][:most]
    pictures = []
    for name in names:
        shape = grid.values[name][outer]
        amount = np.linalg.norm(shape, axis=2)
        scale = charts.Scale([amount], "", cut=0., colours="viridis", low=0., high=amount.max())
        colours = scale.colours(amount / amount.max())[..., :3]
        corners = grid.points[outer] + 0.1 * dam.height / amount.max() * shape
        image = scenes.draw([scenes.quadrilaterals(corners, colours)], dam.points, FROM_DOWNSTREAM,
                            size=(1500, 840), zoom=0.92)
        pictures.append(charts.framed(*image, name[0].upper() + name[1:],
                                      f"{run.label}_{name.split(' (')[0]}"))
    return pictures


def opened_section(runs):
    """The dam with its motion magnified: when its joints were widest open or, without
    joints, at its largest displacement."""
    parts = [part for part in (deformed(run) for run in runs) if part]
    pictures = [part for part in parts if not isinstance(part, str)]
    if not parts:
        return None
    return Section("The dam deformed", [*(part for part in parts if isinstance(part, str)),
                                        *([Pictures(pictures, min(len(pictures), 2))] if pictures else [])])


def widest_opening(run):
    """Size [mm] and time [s] of the widest opening of any joint or plane in any step, or None."""
    key, when = "largest opening [mm]", "time of the largest opening [s]"
    surfaces = run.summary.get("interfaces", {}).get("surfaces", {}).values()
    return max(((values[key], values[when]) for values in surfaces if values.get(key) and values.get(when) is not None),
               default=None)


def openings_over_time(run):
    """Times and the largest opening of any joint or plane [mm], or None."""
    table = run.table("interfaces.csv")
    columns = [values for _, values in table.matching(r".* largest opening \[mm\]")] if table else []
    return (table.time, np.max(columns, axis=0)) if columns else None


@functools.lru_cache(maxsize=None)
def shown_time(run):
    """Time and file of the picture with the widest opening or largest motion; if there are
    joints, their opening in it, and time and size of the widest opening; None without
    pictures of displacements."""
    files = run.pictures("fields")
    files = [(time, file) for time, file in (files[1:] if files and files[0][0] <= 0. else files)
             if "displacement" in grid_of(run, file).values]
    if not files:
        return None
    openings = openings_over_time(run)
    if openings and openings[1].max() > charts.NOISE:
        time, file = max(files, key=lambda item: np.interp(item[0], *openings))
        # the table has some of the steps only
        widest, when = widest_opening(run) or (openings[1].max(), openings[0][openings[1].argmax()])
        return time, file, np.interp(time, *openings), when, widest

    def largest(item):
        return np.linalg.norm(motion_of(run, item[1])[dam_in(run, item[1]).grid.cells[dam_of(run).cells]], axis=-1).max()

    return *max(files, key=largest), None, None, None


def start_of(run):
    """The picture of the start of the earthquake, or None."""
    time, file = run.pictures("fields")[0]
    return file if time <= 0. and "displacement" in grid_of(run, file).values else None


def motion_of(run, file):
    """Displacement [m] at all corners since the start of the earthquake, if there is a
    picture of it, without the mean displacement of the foundation of the dam, which may
    exceed the deformation."""
    values, start = grid_of(run, file).values["displacement"].astype(float), start_of(run)
    if start:
        values -= grid_of(run, start).values["displacement"]
    foundation = dam_in(run, file).foundation
    return values - values[foundation].mean(axis=0) if len(foundation) else values


def magnified(dam, largest):
    """A round factor that magnifies the largest motion [m] to an eighth of the height."""
    return float(f"{0.12 * dam.height / largest:.0e}")


def without_fragments(dam, amount):
    """The largest of the motions of faces (n, 4) [m] without fragments, which move farther than the rest and than a
    thousandth of the height and would be drawn far outside; whether each face belongs to none; and words on those that
    do."""
    largest = charts.usual_largest(amount, 0.99, 1e-3 * dam.height)
    near = amount.max(axis=1) <= 2. * largest
    return largest, near, "" if near.all() else f"what moved by more than {number(200. * largest)} cm is left out"


def deformed(run):
    """A picture of the deformed dam, or a sentence with the reason why there is none."""
    shown = shown_time(run)
    if shown is None:
        return None
    time, file, opening, widest_time, widest = shown
    if opening is not None and opening < 0.2 * widest:
        return (f"{run.prefix}No picture is near the time of the widest opening, {number(widest_time)} s: request "
                'one by "Times" in section "Output/fields".')
    dam = dam_in(run, file)
    motion = motion_of(run, file)
    # including the sides of the joints, which lie inside
    faces = dam.grid.faces(dam.cells)
    amount = np.linalg.norm(motion[faces], axis=2)
    if amount.max() < 1e-9:
        return None
    largest, near, left_out = without_fragments(dam, amount)
    factor = magnified(dam, largest)
    scale = charts.Scale([100. * amount], "displacement [cm]", 0., "viridis", low=0., high=100. * largest)
    moved = dam.grid.points[faces[near]] + factor * motion[faces[near]]
    thrown = scale.largest_above(100. * amount) + (f", and {left_out}" if left_out else "")
    actors = [scenes.quadrilaterals(moved, scale.colours(scale.norm(100. * amount[near]))[..., :3])]
    image = scenes.draw(actors, moved.reshape(-1, 3), FROM_DOWNSTREAM)
    since = "the start of the earthquake" if start_of(run) else "the unloaded model"
    if len(dam.foundation):
        since += ", without the mean motion of its foundation,"
    when = (f"; joints and planes are open by up to {number(opening)} mm at that time, by {number(widest)} mm when "
            f"widest, at {number(widest_time)} s" if opening is not None else "")
    return charts.framed(*image, f"{run.prefix}The dam from downstream and above at {number(time)} s, its motion from "
                                 f"{since} drawn {factor:g} times{thrown}{when}", f"opened_{run.label}", scale,
                         dpi=charts.FULL_DPI)


MOST_FACES = 40000  # of a scene that turns, so that the page stays small
STRESS = "largest_principal_stress_MPa"


def scene_section(runs):
    """The dam of the first run in a scene that turns, coloured by its largest tension,
    with its motion."""
    run = next((run for run in runs if dam_of(run)), None)
    if run is None:
        return None
    dam, shown = dam_of(run), shown_time(run)
    # including the sides of the joints, unless there are too many faces
    faces = dam.grid.faces(dam.cells) if shown and 6 * len(dam.cells) < MOST_FACES else dam.exposed
    if len(faces) > MOST_FACES:
        return None
    motion = motion_of(run, shown[1])[faces] if shown else np.zeros((*faces.shape, 3))
    largest, near, left_out = without_fragments(dam, np.linalg.norm(motion, axis=-1))
    factor = magnified(dam, largest) if largest > 1e-9 else 0.
    faces, motion = np.concatenate([faces[near], faces[~near]]), motion[near]
    if STRESS in dam.grid.values:
        values = dam.grid.values[STRESS][faces]
        scale = charts.Scale([values], "largest principal stress of the run [MPa]")
        colours = scale.colours(scale.norm(values))[..., :3]
        what = ", coloured by the largest principal stress of the run at each place"
    else:
        scale, what = None, ""
        colours = np.broadcast_to(scenes.CONCRETE, (*faces.shape, 3))
    rock = rock_faces(dam) if len(dam.others) else np.zeros((0, 4, 3))
    rock = rock if len(rock) + len(faces) <= MOST_FACES else rock[:0]
    data = scenes.as_json(dam.grid.points[faces], colours, rock, motion, factor)
    actors = [scenes.quadrilaterals(dam.grid.points[faces], colours)]
    if len(rock):
        actors.append(scenes.quadrilaterals(rock, scenes.STONE))
    picture = charts.framed(*scenes.draw(actors, dam.points, FROM_DOWNSTREAM, zoom=0.9),
                            f"{run.prefix}The dam from downstream and above{what}", f"scene_{run.label}", scale, dpi=charts.FULL_DPI)
    return Section("The dam in space", [Scene(data, picture, factor, number(shown[0]) if shown else "",
                                             scale and scale.picture(f"scene_bar_{run.label}"), left_out)])
