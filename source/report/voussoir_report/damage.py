"""Damage on the faces of the dam, in the section of its crown and in its joints."""

import numpy as np

from . import charts
from .faces import SIDES, panel_of
from .grid import centre_keys, dam_in, dam_of
from .interfaces import contraction_joints, joint_corners, scale_of_openings
from .page import Pictures, Section

SCALES = {"tension_damage": "damage in tension [-]", "compression_damage": "damage in compression [-]",
          "damage": "damage [-]", "largest_crack_opening_mm": "largest opening of cracks in a cell [mm]",
          "crack_opening_now_mm": "opening of cracks in a cell at that time [mm]"}


def damaged(run):
    """Fields of damage in the picture at the end that exceed 0.01 somewhere in the dam."""
    dam = dam_of(run)
    return [field for field in SCALES
            if dam and field in dam.grid.values and np.any(of_cells(dam, field)[dam.cells] > 0.01)]


def of_cells(dam, field):
    return dam.grid.values[field][dam.grid.cells].mean(axis=1)


def scale_of(runs, field):
    if field.endswith("damage"):
        return charts.Scale([], SCALES[field], cut=0., colours="inferno_r", low=0., high=1.)
    return scale_of_openings([of_cells(dam_of(run), field)[dam_of(run).cells] for run in runs], SCALES[field])


def on_faces(run, field, scale):
    dam = dam_of(run)
    panels = []
    for side in SIDES:
        faces = dam.side(side)
        panels.append(panel_of(dam, side, dam.grid.points[faces], dam.grid.values[field][faces].mean(axis=1)))
    above = scale.largest_above(np.concatenate([panel.values for panel in panels]))
    return charts.face_map(panels, scale, f"{run.prefix}On the faces{above}", f"{field}_faces_{run.label}")


def in_sections(run, field, scale):
    """A picture of the section in the middle of the dam and of the joints, with the larger
    value of their two sides; for a slice of a dam its last pictures in time."""
    dams = [("middle", dam_of(run))]
    if dam_of(run).is_slice:
        dams = [(f"{time:.2f} s", dam_in(run, file)) for time, file in run.pictures("fields")[-4:]] or dams
    panels = [(title, dam.crown[0], of_cells(dam, field)[dam.crown[1]])
              for title, dam in dams if field in dam.grid.values]

    grid = dam_of(run).grid
    faces = grid.faces(dam_of(run).cells)
    keys, values = centre_keys(grid.points[faces]), grid.values[field][faces].mean(axis=1)
    for name in contraction_joints(run):
        corners = joint_corners(run, name)
        largest = [values[keys == key].max() for key in centre_keys(corners)]
        panels.append((name.removeprefix("joint "), list(corners[..., 1:]), np.array(largest)))
    where = "the middle of the dam" + (" and its contraction joints" if contraction_joints(run) else "")
    above = scale.largest_above(np.concatenate([own for _, _, own in panels]))
    return charts.sections_map(panels, scale, f"{run.prefix}Sections in {where}, upstream on the left{above}",
                               f"{field}_sections_{run.label}")


def damage_section(runs):
    cracked = [run for run in runs if damaged(run)]
    if not cracked:
        return None
    parts = ["The colour of a cell is its mean; the main results have the largest value of any point."]
    unhurt = [run.label for run in runs if run not in cracked]
    if unhurt:
        parts.append(f"No damage in {', '.join(unhurt)}.")
    for field in SCALES:
        some = [run for run in cracked if field in damaged(run)]
        if not some:
            continue
        scale = scale_of(some, field)
        pictures = [on_faces(run, field, scale) for run in some if not dam_of(run).is_slice]
        pictures += [in_sections(run, field, scale) for run in some]
        title = SCALES[field].split(" [")[0]
        parts.append(Pictures(pictures, max(2, min(len(some), 3)), title[0].upper() + title[1:]))
    return Section("Damage at the end", parts)
