#!/usr/bin/env python3
"""Measures how far cracks follow the lines of the mesh, for doc/damage.md: a notched
plate is pulled apart on meshes whose rows of cells run along the crack or cut
it at an angle. Prints a table and draws doc/mesh_bias.png.

usage: doc/mesh_bias.py PROGRAM FOLDER

Writes meshes and cases into FOLDER and runs those that have no results there
yet, a minute or two on one core. Needs the Debian packages python3-numpy and
python3-matplotlib.
"""

import base64
import csv
import os
import struct
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
import zlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SIDE, NOTCH = 1.2, 0.6  # of the plate, [m]
STRENGTH, FRACTURE_ENERGY = 2e6, 100.  # [Pa], [N/m]
POISSON = 0.2
PULL, TIME = 0.4e-3, 0.1  # [m], [s]

ONE_POINT = """\
subsection Discretization
  set Quadrature = one point
end
"""
FIXED = """\
subsection Materials
  subsection concrete
    set Crack direction = fixed
  end
end
"""
PLANES = ONE_POINT + """\
subsection Materials
  subsection concrete
    set Crack growth = along planes
  end
end
"""
# slope of the rows [degrees], their number, shift of the nodes over the size of a
# cell, further entries of the case
RUNS = {
    "level": (0., 31, 0., ""),
    "15 degrees": (15., 31, 0., ""),
    "30 degrees": (30., 31, 0., ""),
    "level, irregular": (0., 31, 0.25, ""),
    "30 degrees, irregular": (30., 31, 0.25, ""),
    "level, larger cells": (0., 21, 0., ""),
    "30 degrees, larger cells": (30., 21, 0., ""),
    "level, one point": (0., 31, 0., ONE_POINT),
    "30 degrees, one point": (30., 31, 0., ONE_POINT),
    "level, fixed cracks": (0., 31, 0., FIXED),
    "15 degrees, fixed cracks": (15., 31, 0., FIXED),
    "30 degrees, fixed cracks": (30., 31, 0., FIXED),
    "30 degrees, irregular, fixed cracks": (30., 31, 0.25, FIXED),
    "30 degrees, larger cells, fixed cracks": (30., 21, 0., FIXED),
    "30 degrees, one point, fixed cracks": (30., 31, 0., ONE_POINT + FIXED),
    "level, along planes": (0., 31, 0., PLANES),
    "15 degrees, along planes": (15., 31, 0., PLANES),
    "30 degrees, along planes": (30., 31, 0., PLANES),
    "30 degrees, irregular, along planes": (30., 31, 0.25, PLANES),
    "30 degrees, larger cells, along planes": (30., 21, 0., PLANES),
}
DRAWN = ("level", "15 degrees", "30 degrees", "30 degrees, fixed cracks",
         "30 degrees, along planes")

CASE = """\
# A notched plate that is pulled apart; written by doc/mesh_bias.py.
subsection Mesh
  set Type = file
  subsection file
    set File = {name}.msh
  end
end
subsection Materials
  set Names = concrete, ends
  subsection concrete
    set Class            = concrete damage
    set Cell sets        = plate
    set Density          = 2400
    set Young's modulus  = 27e9
    set Poisson's ratio  = {poisson}
    set Tensile strength = {strength}
    set Fracture energy  = {energy}
  end
  subsection ends
    set Cell sets        = ends
    set Density          = 2400
    set Young's modulus  = 27e9
    set Poisson's ratio  = {poisson}
  end
end
subsection Boundaries
  set Fixed  = bottom
  set Roller = side
end
subsection Constraints
  set Names = pull
  subsection pull
    set Face sets     = top
    set Displacement  = 0, 0, {pull}
    set Time function = t/{time}
  end
end
# damps the natural frequencies of the plate, some hundred Hz
subsection Damping
  set Model             = mass proportional
  set Ratio             = 0.1
  set Lowest frequency  = 500
  set Highest frequency = 1000
end
subsection Time
  set End time = {time}
end
subsection Output
  set Folder          = {name}
  set Energy interval = {interval}
  set Observers       = fields
  subsection fields
    set Quantities = displacement
    set Times      = {time}
  end
end
{more}"""


def nodes_of_plate(slope, rows, shift):
    """x and z of the nodes [m], by column and line, and the row of the notch."""
    size = SIDE / rows
    columns = 2 * (rows // 2)
    x = np.linspace(0., SIDE, columns + 1)
    rise = np.tan(np.radians(slope))
    # beside the notch the rows are level, as far below the middle as those of the
    # ligament rise above it
    lowered = round(0.5 * rise * (SIDE - NOTCH) / size)
    notch = rows // 2 + lowered
    line = np.linspace(0., SIDE, rows + 1)
    x, line = np.meshgrid(x, line, indexing="ij")
    moves = np.ones_like(x, bool)
    moves[[0, -1]] = moves[:, [0, -1]] = False
    moves[:, notch:notch + 2] &= x[:, notch:notch + 2] > NOTCH + 0.1 * size
    jitter = shift * size * np.random.default_rng(1).uniform(-1., 1., (2, *x.shape))
    line = line + moves * jitter[1]
    # in the middle the rows are parallel; bottom and top are level
    plain = 0.5 * rise * (SIDE - NOTCH) + 2. * size
    away = np.maximum(0., np.abs(line - 0.5 * SIDE) - plain) / (0.5 * SIDE - plain)
    height = rise * np.maximum(0., x - NOTCH) - lowered * size
    points = np.stack([x + moves * jitter[0], line + height * (1. - away)], axis=2)
    return points, notch


def write_mesh(name, points, notch):
    columns, rows = points.shape[0] - 1, points.shape[1] - 1
    size = SIDE / rows

    def node(i, j, k):
        return 1 + (j * (columns + 1) + i) * 2 + k

    elements = []
    for j in range(rows):
        for i in range(columns):
            if j == notch and points[i + 1, j, 0] < NOTCH + 0.1 * size:
                continue
            corners = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
            # only the middle may crack: clamped corners would, too
            at_end = abs(j + 0.5 - 0.5 * rows) > 0.2 * rows
            elements.append((5, 5 if at_end else 1, [node(*corner, k) for k in (0, 1) for corner in corners]))
            elements.append((3, 4, [node(*corner, 0) for corner in corners]))
    for i in range(columns):
        for number, j in ((2, 0), (3, rows)):
            elements.append((3, number, [node(i, j, 0), node(i + 1, j, 0),
                                         node(i + 1, j, 1), node(i, j, 1)]))
    nodes = [(points[i, j, 0], -k * size, points[i, j, 1])
             for j in range(rows + 1) for i in range(columns + 1) for k in (0, 1)]
    write_gmsh(name, {(3, 1): "plate", (3, 5): "ends", (2, 2): "bottom", (2, 3): "top",
                      (2, 4): "side"}, nodes, elements)


def write_gmsh(name, sets, nodes, elements):
    """Sets by dimension and number, positions of nodes [m], elements as (kind, number of
    the set, numbers of nodes from 1)."""
    with open(name, "w") as file:
        file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(sets)}\n")
        for (dimension, number), title in sets.items():
            file.write(f'{dimension} {number} "{title}"\n')
        file.write(f"$EndPhysicalNames\n$Nodes\n{len(nodes)}\n")
        for number, place in enumerate(nodes, 1):
            file.write(f"{number} {' '.join(f'{x:.9f}' for x in place)}\n")
        file.write(f"$EndNodes\n$Elements\n{len(elements)}\n")
        for number, (kind, tag, corners) in enumerate(elements, 1):
            file.write(f"{number} {kind} 2 {tag} {tag} {' '.join(map(str, corners))}\n")
        file.write("$EndElements\n")


def run(program, folder, title):
    """Runs one case unless it has results, and returns its output folder."""
    slope, rows, shift, more = RUNS[title]
    name = title.replace(" ", "_").replace(",", "")
    output = os.path.join(folder, name)
    if os.path.exists(os.path.join(output, "summary.json")):
        return output
    print(title, file=sys.stderr)
    write_mesh(output + ".msh", *nodes_of_plate(slope, rows, shift))
    with open(output + ".prm", "w") as file:
        file.write(CASE.format(name=name, strength=STRENGTH, energy=FRACTURE_ENERGY,
                               poisson=POISSON, pull=PULL,
                               time=TIME, interval=TIME / 200., more=more))
    subprocess.run([program, name + ".prm", "--overwrite"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    return output


def read_energy(output):
    with open(os.path.join(output, "energy.csv")) as file:
        rows = list(csv.reader(file))
    return {title: np.array(column, float) for title, column in zip(rows[0], zip(*rows[1:]))}


def read_crest(output):
    """Times [s] and displacement of the crest along the river [mm]."""
    with open(os.path.join(output, "histories.csv")) as file:
        rows = list(csv.reader(file))
    (column,) = (n for n, title in enumerate(rows[0])
                 if "crest" in title and "displacement y" in title)
    times, crest = np.array([(row[0], row[column]) for row in rows[1:]], float).T
    return times, 1e3 * crest


def largest_error(energy):
    """Largest energy-balance error over the input."""
    return np.abs(energy["energy-balance error [J]"]).max() / energy["input [J]"].max()


def read_picture(output):
    """Arrays of the last picture, from the compressed XML of VTK."""
    with open(os.path.join(output, "fields.txt")) as file:
        name = file.read().split("\n")[-2].split(maxsplit=1)[1].strip()
    kinds = {"Float32": "f4", "Float64": "f8", "Int32": "i4", "UInt32": "u4",
             "Int64": "i8", "UInt64": "u8", "UInt8": "u1", "Int8": "i1"}
    arrays = {}
    for entry in ElementTree.parse(os.path.join(output, name)).getroot().iter("DataArray"):
        if entry.get("format") != "binary" or entry.get("type") not in kinds:
            continue
        text = entry.text.strip()
        # number of blocks, bytes of a block, of the last one, of each compressed one
        (blocks,) = struct.unpack("<I", base64.b64decode(text[:8])[:4])
        length = -(-4 * (3 + blocks) // 3) * 4
        sizes = struct.unpack(f"<{3 + blocks}I", base64.b64decode(text[:length])[:4 * (3 + blocks)])
        data, begin, plain = base64.b64decode(text[length:]), 0, b""
        for size in sizes[3:]:
            plain += zlib.decompress(data[begin:begin + size])
            begin += size
        values = np.frombuffer(plain, kinds[entry.get("type")])
        width = int(entry.get("NumberOfComponents") or 1)
        arrays[entry.get("Name") or "points"] = values.reshape(-1, width) if width > 1 else values
    return arrays


def faces_of(arrays, across=1):
    """Corners of the cells [m] in the plane at right angles to an axis, their damage and
    opening [mm]."""
    points = arrays["points"].reshape(-1, 3)
    plane = [axis for axis in range(3) if axis != across]
    cells = arrays["connectivity"].reshape(-1, 8)
    faces = []
    for cell in cells:
        flat = points[cell[points[cell, across] > points[cell, across].mean()]][:, plane]
        out = flat - flat.mean(axis=0)
        faces.append(flat[np.argsort(np.arctan2(out[:, 1], out[:, 0]))])
    first = cells[:, 0]
    return np.array(faces), arrays["tension_damage"][first], arrays["largest_crack_opening_mm"][first]


def result(output):
    """Loads [N/m], energy lost in cracks over that of a level crack, slope of the
    crack [degrees], and the cells with their damage."""
    energy = read_energy(output)
    time = energy["time [s]"]
    work = energy["constraints [J]"]
    load = np.diff(work) / np.diff(time) / (PULL / TIME)
    picture = read_picture(output)
    faces, damage, opening = faces_of(picture)
    thickness = np.ptp(picture["points"].reshape(-1, 3)[:, 1])
    centres = faces.mean(axis=1)
    in_crack = centres[:, 0] > NOTCH
    slope = np.polyfit(*centres[in_crack].T, 1, w=np.sqrt(opening[in_crack]))[0]
    return {"peak": load.max() / thickness,
            "lost": energy["material [J]"][-1] / thickness / (FRACTURE_ENERGY * (SIDE - NOTCH)),
            "left": load[-10:].mean() / thickness,
            "kinetic": energy["kinetic [J]"].max() / work.max(),
            "error": np.abs(energy["energy-balance error [J]"]).max() / work.max(),
            "slope": np.degrees(np.arctan(slope)),
            "time": 0.5 * (time[1:] + time[:-1]),
            "load": load / thickness,
            "cells": (faces, damage)}


def draw(results, picture):
    figure, axes = plt.subplots(2, 3, figsize=(12.5, 6.6))
    for panel, title in zip(axes.flat, DRAWN):
        faces, damage = results[title]["cells"]
        drawn = PolyCollection(faces, array=damage, cmap="inferno_r", edgecolors="0.55",
                               linewidths=0.4)
        drawn.set_clim(0., 1.)
        panel.add_collection(drawn)
        panel.set(xlim=(0.4, SIDE + 0.005), ylim=(0.38, 0.92), aspect="equal")
        panel.set_axis_off()
        panel.set_title(title, fontsize=11)
    curves = axes.flat[-1]
    for title in DRAWN:
        values = results[title]
        curves.plot(1e3 * PULL / TIME * values["time"], 1e-3 * values["load"], label=title,
                    linewidth=1.2)
    curves.set(xlabel="pull [mm]", ylabel="load [kN/m]", xlim=(0., 1e3 * PULL), ylim=(0., None))
    curves.grid(alpha=0.3)
    curves.legend(fontsize=8)
    figure.tight_layout()
    figure.colorbar(drawn, ax=axes, label="damage in tension", shrink=0.7, pad=0.015)
    figure.savefig(picture, dpi=110, bbox_inches="tight")


def main(program, folder):
    os.makedirs(folder, exist_ok=True)
    program = os.path.abspath(program)
    results = {title: result(run(program, folder, title)) for title in RUNS}
    first = next(iter(results.values()))
    print("| rows of cells | slope of the crack | largest load | over that of level rows "
          "| energy over Gf times area | load left at the end |\n"
          "|---|---|---|---|---|---|")
    for title, values in results.items():
        print(f"| {title} | {abs(values['slope']):.0f}° | {1e-3 * values['peak']:.0f} kN/m "
              f"| {values['peak'] / first['peak']:.2f} | {values['lost']:.2f} "
              f"| {100. * values['left'] / values['peak']:.0f} % |")
    for name in ("kinetic", "error"):
        print(f"{name} energy over the work, at most "
              f"{max(values[name] for values in results.values()):.4f}")
    draw(results, os.path.join(ROOT, "doc", "mesh_bias.png"))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
