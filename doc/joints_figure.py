#!/usr/bin/env python3
"""Picture of the joints of an arch dam in a finished run: the dam with its
motion since the static state magnified, and the largest opening of the joints.

usage: doc/joints_figure.py OUTPUT_FOLDER FILE.png

The run needs the observers "interfaces" and "fields", the latter with
"displacement" at time 0 and at others, of which the one is drawn at which the
joints are open furthest. Needs the Debian packages python3-matplotlib and
python3-vtk9.
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from figures import HEXAHEDRON_FACES

MAGNIFICATION = 300.


def read(name):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    values = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
              for i in range(data.GetNumberOfArrays())}
    return vtk_to_numpy(grid.GetPoints().GetData()), vtk_to_numpy(
        grid.GetCells().GetConnectivityArray()), values


def pictures(folder):
    with open(folder + "/fields.txt") as file:
        lines = [line.split(maxsplit=1) for line in file if line.strip()]
    return [(float(time), f"{folder}/{name.strip()}") for time, name in lines]


def opening_over_time(folder):
    with open(folder + "/interfaces.csv") as file:
        rows = list(csv.reader(file))
    data = np.array(rows[1:], float)
    joints = {title[:-len(" largest opening [mm]")]: data[:, i]
              for i, title in enumerate(rows[0])
              if title.endswith(" largest opening [mm]")}
    return data[:, 0], joints


def dam_faces(points, connectivity, values):
    """Faces of the dam with one cell only, the sides of the joints too."""
    cells = connectivity.reshape(-1, 8)
    cells = cells[values["material"][cells[:, 0]] == 0]
    faces = np.concatenate([cells[:, corners] for corners in HEXAHEDRON_FACES])
    centres = np.round(points[faces].mean(axis=1), 2)
    _, first, counts = np.unique(centres, axis=0, return_index=True,
                                 return_counts=True)
    return faces[first[counts == 1]]


def main(folder, name):
    times, joints = opening_over_time(folder)
    largest = np.max(list(joints.values()), axis=0)
    (_, at_rest), *moved = pictures(folder)
    when, file = max(moved, key=lambda picture: np.interp(picture[0], times,
                                                          largest))
    points, connectivity, values = read(file)
    rest_points, _, rest = read(at_rest)
    motion = values["displacement"] - rest["displacement"]
    faces = dam_faces(points, connectivity, values)

    figure = plt.figure(figsize=(11, 8))
    scene = figure.add_axes((0., 0.4, 1., 0.6), projection="3d")
    corners = points[faces] + MAGNIFICATION * motion[faces]
    normal = np.cross(corners[:, 2] - corners[:, 0],
                      corners[:, 3] - corners[:, 1])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    light = np.array([0.3, 0.5, 0.8]) / np.linalg.norm([0.3, 0.5, 0.8])
    colours = np.ones((len(faces), 4))
    colours[:, :3] = (np.array([0.80, 0.79, 0.75])
                      * (0.55 + 0.45 * np.abs(normal @ light))[:, None])
    scene.add_collection3d(Poly3DCollection(corners, facecolors=colours,
                                            edgecolors=(0, 0, 0, 0.35),
                                            linewidths=0.3, clip_on=False))
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    scene.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]),
              zlim=(low[2], high[2]))
    scene.set_box_aspect(high - low, zoom=1.9)
    scene.view_init(elev=38, azim=90)
    scene.set_axis_off()
    figure.suptitle(f"t = {when:.2f} s, motion since the static state "
                    f"{MAGNIFICATION:.0f} times, from downstream and above",
                    fontsize=9)

    axes = figure.add_subplot(2, 2, 3)
    points, connectivity, values = read(folder + "/interface_envelopes.vtu")
    quads = connectivity.reshape(-1, 4)
    opening = values["largest_opening_mm"]
    # developed: each joint in a panel of its own, upstream to the left
    norm = plt.Normalize(0, opening.max())
    offset = 0.
    for joint in np.unique(values["interface"]):
        mine = quads[values["interface"][quads[:, 0]] == joint]
        across = points[mine][:, :, 1]
        x = across - across.min() + offset
        for u, z, value in zip(x, points[mine][:, :, 2],
                               opening[mine].mean(axis=1)):
            axes.fill(u, z, color=plt.cm.inferno_r(norm(value)), linewidth=0.1)
        axes.text(x.mean(), points[mine][:, :, 2].max() + 8,
                  f"{int(joint) + 1}", ha="center", fontsize=8)
        offset = x.max() + 15.
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_ylabel("elevation [m]")
    axes.set_title("joints seen from the side", fontsize=9)
    bar = figure.colorbar(plt.cm.ScalarMappable(norm, plt.cm.inferno_r),
                          ax=axes, shrink=0.8)
    bar.set_label("largest opening [mm]")

    axes = figure.add_subplot(2, 2, 4)
    for joint, values in joints.items():
        axes.plot(times, values, linewidth=0.8, label=joint)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("opening [mm]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=6, ncol=3)
    figure.subplots_adjust(left=0.06, right=0.98, bottom=0.07, top=0.78,
                           hspace=0.)
    figure.savefig(name, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
