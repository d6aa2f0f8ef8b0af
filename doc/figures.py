#!/usr/bin/env python3
"""Pictures of a finished run: history of one point, and the dam with its rock.

usage: doc/figures.py OUTPUT_FOLDER POINT FILE.png

Needs the Debian packages python3-matplotlib and python3-vtk9.
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


HEXAHEDRON_FACES = ((0, 3, 7, 4), (1, 2, 6, 5), (0, 1, 5, 4), (3, 2, 6, 7),
                    (0, 1, 2, 3), (4, 5, 6, 7))


def read_histories(folder):
    """Titles and numbers of histories.csv."""
    with open(folder + "/histories.csv") as file:
        rows = list(csv.reader(file))
    return rows[0], np.array(rows[1:], float)


def column_of(titles, point, quantity):
    """Number of a column, of absolute or relative motion."""
    return next(i for i, title in enumerate(titles)
                if title.startswith(f"{point} {quantity} "))


def number_of(grid, kind, name):
    """The number that stands for a name in the field of this kind."""
    names = grid.GetFieldData().GetAbstractArray(kind + "_names")
    return [names.GetValue(i) for i in range(names.GetNumberOfValues())].index(name)


def faces_of(grid, material):
    """Outer faces of one material: corner points (n, 4, 3) and point values.

    The cells of the file share no points, so faces that two cells have in
    common are found by their coordinates.
    """
    points = vtk_to_numpy(grid.GetPoints().GetData())
    data = grid.GetPointData()
    values = vtk_to_numpy(data.GetArray("largest_acceleration_m_per_s2"))
    materials = vtk_to_numpy(data.GetArray("material"))
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 8)
    cells = cells[materials[cells[:, 0]] == number_of(grid, "material", material)]
    faces = np.concatenate([cells[:, corners] for corners in HEXAHEDRON_FACES])
    centres = np.round(points[faces].mean(axis=1), 2)
    _, first, counts = np.unique(centres, axis=0, return_index=True,
                                 return_counts=True)
    faces = faces[first[counts == 1]]
    return points[faces], values[faces].mean(axis=1)


def without_outer_planes(faces):
    """The faces that do not lie in the planes that bound the model."""
    low, high = faces.min(axis=(0, 1)), faces.max(axis=(0, 1))
    keep = np.ones(len(faces), bool)
    for axis in range(3):
        for plane in ((low[axis], high[axis]) if axis < 2 else (low[axis],)):
            keep &= ~np.all(np.abs(faces[:, :, axis] - plane) < 1e-3, axis=1)
    return faces[keep], keep


def main(folder, point, name):
    titles, data = read_histories(folder)
    figure = plt.figure(figsize=(11, 4.6))
    left = figure.add_subplot(2, 2, 1)
    below = figure.add_subplot(2, 2, 3, sharex=left)
    for axes, quantity, scale, label in (
            (left, "displacement y", 100., "displacement [cm]"),
            (below, "acceleration y", 1. / 9.81, "acceleration [g]")):
        axes.plot(data[:, 0],
                  scale * data[:, column_of(titles, point, quantity)],
                  linewidth=0.9)
        axes.set_ylabel(label)
        axes.grid(alpha=0.3)
    left.set_title(f"{point}, along the river, relative to the base", fontsize=9)
    below.set_xlabel("time [s]")

    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(folder + "/envelopes.vtu")
    reader.Update()
    scene = figure.add_subplot(1, 2, 2, projection="3d", computed_zorder=False)
    dam, acceleration = faces_of(reader.GetOutput(), "concrete")
    rock, _ = faces_of(reader.GetOutput(), "rock")
    rock, _ = without_outer_planes(rock)
    near = np.all(np.abs(rock.mean(axis=1)[:, :2]) < (480., 330.), axis=1)
    # from upstream, left of the river, above
    light = np.array([0.3, 0.5, 0.8])

    def shade(faces):
        normal = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        return 0.65 + 0.35 * np.abs(normal @ (light / np.linalg.norm(light)))

    colours = plt.cm.viridis(acceleration / acceleration.max())
    colours[:, :3] *= shade(dam)[:, None]
    stone = np.ones((near.sum(), 4))
    stone[:, :3] = np.array([0.78, 0.74, 0.68]) * shade(rock[near])[:, None]
    scene.add_collection3d(Poly3DCollection(
        np.concatenate([rock[near], dam]),
        facecolors=np.concatenate([stone, colours]),
        edgecolors=(0, 0, 0, 0.25), linewidths=0.2))
    scene.set_xlim(-480, 480)
    scene.set_ylim(-330, 330)
    scene.set_zlim(0, 300)
    scene.set_box_aspect((960, 660, 300), zoom=1.45)
    scene.view_init(elev=32, azim=62)
    scene.set_axis_off()
    bar = figure.colorbar(
        plt.cm.ScalarMappable(
            plt.Normalize(0, acceleration.max() / 9.81), plt.cm.viridis),
        ax=scene, shrink=0.6, pad=0.02)
    bar.set_label("largest acceleration [g]")
    figure.tight_layout()
    figure.savefig(name, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
