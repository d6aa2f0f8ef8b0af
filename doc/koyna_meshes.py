#!/usr/bin/env python3
"""Cracks of prm/koyna.prm on meshes of several sizes whose rows of cells are level or
rise towards one face, for doc/damage.md. Prints a table and draws doc/koyna_meshes.png.

usage: doc/koyna_meshes.py PROGRAM FOLDER

Writes meshes into FOLDER and runs the case on those that have no results there yet, half
an hour on one core. Needs the Debian packages python3-numpy and python3-matplotlib.
"""

import os
import subprocess
import sys

import numpy as np
from mesh_bias import (ROOT, PolyCollection, faces_of, largest_error, plt, read_crest, read_energy,
                       read_picture, write_gmsh)

HEIGHT, NECK, THICKNESS = 103., 66.5, 1.5  # of the slice [m]
COLUMNS = {36: 14, 52: 20, 72: 28, 104: 40}  # cells along the river, by rows over the height
SLOPES = (-20., 0., 20.)  # of the rows at the neck: rise towards downstream [degrees]
LAWS = {
    "eight points": (),
    "along planes": ("Discretization/Quadrature=one point",
                     "Materials/concrete/Crack growth=along planes"),
}


def downstream_face(z):
    return -np.interp(z, (0., NECK, HEIGHT), (70., 19.25, 14.8))


def nodes_of_section(columns, rows, slope):
    """y and z of the nodes [m], by column from the downstream face and by row."""
    below = round(rows * NECK / HEIGHT)
    z = np.append(np.linspace(0., NECK, below + 1)[:-1],
                  np.linspace(NECK, HEIGHT, rows - below + 1))
    # base and crest are level, the rows between 40 m and 83 m parallel
    turned = np.minimum(1., np.minimum(z / 40., (HEIGHT - z) / 20.))
    y = np.linspace(1., 0., columns + 1)[:, None] * downstream_face(z)
    fall = np.tan(np.radians(slope)) * turned * (y - downstream_face(z))
    return np.stack([y, z - fall], axis=2)


def write_mesh(name, points):
    columns, rows = points.shape[0] - 1, points.shape[1] - 1

    def node(i, j, k):
        return 1 + (j * (columns + 1) + i) * 2 + k

    elements = []
    for j in range(rows):
        for i in range(columns):
            corners = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
            elements.append((5, 1, [node(*corner, k) for k in (0, 1) for corner in corners]))
            for k in (0, 1):
                elements.append((3, 3 + k, [node(*corner, k) for corner in corners]))
    for i in range(columns):
        elements.append((3, 2, [node(i, 0, 0), node(i + 1, 0, 0), node(i + 1, 0, 1), node(i, 0, 1)]))
    for j in range(rows):
        elements.append((3, 5, [node(columns, j, 0), node(columns, j + 1, 0),
                                node(columns, j + 1, 1), node(columns, j, 1)]))
    nodes = [(k * THICKNESS, *points[i, j])
             for j in range(rows + 1) for i in range(columns + 1) for k in (0, 1)]
    write_gmsh(name, {(3, 1): "dam", (2, 2): "base", (2, 3): "side minus", (2, 4): "side plus",
                      (2, 5): "upstream face"}, nodes, elements)


def run(program, folder, law, rows, slope):
    """Runs one case unless it has results, and returns its output folder."""
    mesh = os.path.join(folder, f"{rows}_rows_{slope:.0f}_degrees.msh")
    output = os.path.join(folder, law.replace(" ", "_") + "_" + os.path.basename(mesh)[:-4])
    if not os.path.exists(os.path.join(output, "summary.json")):
        print(law, os.path.basename(mesh), file=sys.stderr)
        write_mesh(mesh, nodes_of_section(COLUMNS[rows], rows, slope))
        subprocess.run([program, os.path.join(ROOT, "prm/koyna.prm"), "--overwrite", "--set",
                        "Mesh/Type=file", f"Mesh/file/File={mesh}", f"Output/Folder={output}",
                        *LAWS[law]], check=True, stdout=subprocess.DEVNULL)
    return output


def result(output):
    """Extremes of the crest [mm], energies [kJ], elevation of the cracks at the neck in
    the quarters of the section from upstream [m], cells with their damage."""
    _, crest = read_crest(output)
    energy = read_energy(output)
    faces, damage, opening = faces_of(read_picture(output), across=0)
    y, z = faces.mean(axis=1).T
    quarter = np.floor(4. * y / downstream_face(z))
    neck = (z > 50.) & (z < 90.)
    path = [np.average(z[neck & (quarter == q)], weights=opening[neck & (quarter == q)])
            for q in range(4)]
    return {"crest": (crest.min(), crest.max()), "cracks": 1e-3 * energy["material [J]"][-1],
            "closing": 1e-3 * energy["closing cracks [J]"][-1], "path": path, "error": largest_error(energy),
            "cells": (faces, damage)}


def draw(results, rows, picture):
    figure, axes = plt.subplots(len(LAWS), len(SLOPES), figsize=(9., 5.6))
    for panels, law in zip(axes, LAWS):
        for panel, slope in zip(panels, SLOPES):
            faces, damage = results[law, rows, slope]["cells"]
            drawn = PolyCollection(faces, array=damage, cmap="inferno_r", edgecolors="0.6",
                                   linewidths=0.2)
            drawn.set_clim(0., 1.)
            panel.add_collection(drawn)
            panel.set(xlim=(-34., 1.), ylim=(50., 80.), aspect="equal")
            panel.set_axis_off()
            panel.set_title(f"{law}, rows at {slope:.0f}°", fontsize=10)
    figure.colorbar(drawn, ax=axes, label="damage in tension", shrink=0.6, pad=0.02)
    figure.savefig(picture, dpi=110, bbox_inches="tight")


def main(program, folder):
    os.makedirs(folder, exist_ok=True)
    program, folder = os.path.abspath(program), os.path.abspath(folder)
    results = {(law, rows, slope): result(run(program, folder, law, rows, slope))
               for law in LAWS for rows in COLUMNS for slope in SLOPES}
    print("| law | rows over the height | slope | crest | energy in cracks | lost by closing "
          "| crack at the neck, from upstream to downstream |\n|---|---|---|---|---|---|---|")
    for (law, rows, slope), values in results.items():
        print(f"| {law} | {rows} | {slope:.0f}° | {values['crest'][0]:.1f} to "
              f"{values['crest'][1]:+.1f} mm | {values['cracks']:.0f} kJ | {values['closing']:.0f} kJ | "
              + ", ".join(f"{z:.1f}" for z in values["path"]) + " m |")
    print("energy-balance error over the input, at most "
          f"{max(values['error'] for values in results.values()):.5f}")
    draw(results, max(COLUMNS), os.path.join(ROOT, "doc", "koyna_meshes.png"))


if __name__ == "__main__":
    main(*sys.argv[1:])
