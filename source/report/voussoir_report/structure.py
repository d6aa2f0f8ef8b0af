"""The dam in space: its mesh, its natural modes, and how it moved with its joints."""

import numpy as np

from . import charts, scenes
from .grid import dam_in, dam_of, grid_of
from .page import Pictures, Section, Table, comparison, number

FROM_DOWNSTREAM = (0.35, -1., 0.55)
SCALED_JACOBIAN = "scaled Jacobian [-]"


def framed(image, caption, name, scale=None):
    """A picture of a scene, with a colour bar."""
    height = charts.WIDTH * image.shape[0] / image.shape[1]
    bar = 0.7 if scale else 0.
    figure = charts.Figure(figsize=(charts.WIDTH, height + bar))
    axes = charts.place(figure, 0., bar, charts.WIDTH, height)
    axes.imshow(image)
    axes.set_axis_off()
    if scale:
        scale.bar(figure)
    return charts.picture(figure, caption, name, shaded=True)


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
    return framed(image, f"{run.prefix}The mesh, seen from {where}", f"mesh_{run.label}", scale)


def mesh_section(runs):
    runs = [run for run in runs if dam_of(run)]
    if not runs:
        return None

    def of(of_dam, function):
        def text(run):
            dam = dam_of(run)
            cells = dam.cells if of_dam else dam.others
            return function(dam, cells) if len(cells) else None
        return text

    def edges(dam, cells):
        lengths = dam.grid.edges(cells)
        return f"{number(lengths.min())} to {number(lengths.max())}"

    rows = []
    for of_dam, where in ((True, "dam"), (False, "rock and water")):
        rows += [(f"{where}: cells, as drawn", of(of_dam, lambda dam, cells: number(len(cells)))),
                 (f"{where}: edges [m]", of(of_dam, edges)),
                 (f"{where}: worst {SCALED_JACOBIAN}",
                  of(of_dam, lambda dam, cells: number(dam.grid.quality[cells].min()))),
                 (f"{where}: cells with a {SCALED_JACOBIAN} below 0.3, in %",
                  of(of_dam, lambda dam, cells: number(100. * (dam.grid.quality[cells] < 0.3).mean())))]
    text = ("The scaled Jacobian is 1 for a brick, 0 where a corner is flat; below 0.2 stresses beside "
            "such a corner are doubtful.")
    # runs on the same mesh need one picture
    pictures = {len(dam_of(run).grid.cells): mesh_picture(run) for run in reversed(runs)}
    return Section("Mesh", [text, comparison(runs, rows),
                            Pictures(list(reversed(pictures.values())), min(len(pictures), 2))])


def modes_section(runs):
    runs = [run for run in runs if run.summary.get("modes", {}).get("modes")]
    if not runs:
        return None
    parts = []
    for run in runs:
        rows = []
        for n, mode in enumerate(run.summary["modes"]["modes"], 1):
            rows.append([str(n), number(mode["frequency [Hz]"], 4), number(mode["period [s]"]),
                         *(number(100. * share) for share in mode["effective mass [-]"]),
                         *(number(100. * share) for share in mode["cumulative effective mass [-]"])])
        parts.append(Table(["mode", "frequency [Hz]", "period [s]", "effective mass x [%]", "y [%]",
                            "z [%]", "up to here x [%]", "y [%]", "z [%]"], rows,
                           run.label if len(runs) > 1 else ""))
        if run.has("modes.vtu"):
            parts.append(Pictures(mode_pictures(run), 3))
    return Section("Natural modes", parts)


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
                            size=(1000, 560), zoom=0.92)
        pictures.append(framed(image, name[0].upper() + name[1:], f"{run.label}_{name.split(' (')[0]}"))
    return pictures


def opened_section(runs):
    """The dam with its motion since the start magnified, when its joints were widest open."""
    pictures = [picture for picture in (opened_picture(run) for run in runs) if picture]
    if not pictures:
        return None
    return Section("The dam with its joints open", [Pictures(pictures, min(len(pictures), 2))])


def opened_picture(run):
    pictures, table = run.pictures("fields"), run.table("interfaces.csv")
    if len(pictures) < 2 or pictures[0][0] > 0. or table is None:
        return None
    openings = np.max([values for _, values in table.matching(r".* largest opening \[mm\]")], axis=0)

    def widest(time):
        return np.interp(time, table.time, openings)

    now, file = max(pictures[1:], key=lambda item: widest(item[0]))
    dam, start = dam_in(run, file), grid_of(run, pictures[0][1])
    grid = dam.grid
    if "displacement" not in grid.values or widest(now) < 0.2 * widest(table.time).max():
        return None
    motion = grid.values["displacement"] - start.values["displacement"]
    # with the sides of the joints, which lie inside
    faces = dam.grid.faces(dam.cells)
    largest = np.linalg.norm(motion[faces], axis=2).max()
    factor = float(f"{0.12 * dam.height / largest:.0e}")
    moved = grid.points[faces] + factor * motion[faces]
    actors = [scenes.quadrilaterals(moved, (0.82, 0.81, 0.77))]
    image = scenes.draw(actors, moved.reshape(-1, 3), FROM_DOWNSTREAM)
    return framed(image, f"{run.prefix}Motion from the start to {number(now)} s, {factor:g} times, "
                         "seen from downstream and above", f"opened_{run.label}")
