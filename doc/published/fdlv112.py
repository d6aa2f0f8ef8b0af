#!/usr/bin/env python3
"""The arch dam FDLV112 of code_aster's test cases: its mesh for Voussoir, and its crest.

    python3 fdlv112.py mesh FOLDER      reads fdlv112h.mail and fdlv112d.py of a folder,
                                        writes fdlv112.msh and fdlv112.csv
    python3 fdlv112.py crest OUTPUT     compares the crest with code_aster's results

The files of the folder are part of code_aster, under its licence, and not included in
this project. Quadratic hexahedra are cut into eight, wedges into six hexahedra at their
nodes, with the middle of faces and cells by the element's own shape functions.
code_aster has x upstream and y towards the right bank; here y is upstream.
"""
import argparse
import csv
import pathlib
import re

import numpy

NODES = {"TRIA6": 6, "QUAD8": 8, "PENTA15": 15, "HEXA20": 20}
CORNERS = {"TRIA6": 3, "QUAD8": 4, "PENTA15": 6, "HEXA20": 8}
CELL_SETS = {"STRVOU": "dam", "VOLSOL": "rock", "FLUIDE": "reservoir"}
FACE_SETS = {"IFLUSTR": "upstream face", "SLIBRE0": "water surface", "IFLUSOLF": "reservoir end",
             "TH_SOL": "outer", "ISOLSTR": "base"}
# the faces of a hexahedron by their corners
HEXA_FACES = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
# edges of the quadratic cells: corners and the node between them
EDGES = {
    "TRIA6": [(0, 1, 3), (1, 2, 4), (2, 0, 5)],
    "QUAD8": [(0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)],
    "HEXA20": [(0, 1, 8), (1, 2, 9), (2, 3, 10), (3, 0, 11), (0, 4, 12), (1, 5, 13), (2, 6, 14),
               (3, 7, 15), (4, 5, 16), (5, 6, 17), (6, 7, 18), (7, 4, 19)],
    "PENTA15": [(0, 1, 6), (1, 2, 7), (2, 0, 8), (0, 3, 9), (1, 4, 10), (2, 5, 11), (3, 4, 12),
                (4, 5, 13), (5, 3, 14)],
}


def read_mail(name):
    """Coordinates by node, type and nodes by cell, members by name of the group."""
    nodes, cells, groups = {}, {}, {}
    kind = group = None
    words = []
    for line in open(name, errors="replace"):
        line = line.split("%")[0]
        if not line.split():
            continue
        first = line.split()[0]
        if first == "FINSF":
            kind = None
        elif kind is None:
            kind, words = first, []
            named = re.search(r"NOM=(\S+)", line)
            group = named.group(1) if named else None
        elif "=" in line:  # part of the heading
            continue
        elif kind == "COOR_3D":
            nodes[first] = numpy.array([float(x) for x in line.split()[1:4]])
        elif kind in NODES:
            words += line.split()
            while len(words) > NODES[kind]:
                cells[words[0]] = kind, words[1:NODES[kind] + 1]
                del words[:NODES[kind] + 1]
        elif kind == "GROUP_MA":
            groups.setdefault(group, []).extend(line.split())
    return nodes, cells, groups


class Refined:
    """Nodes of the new cells, each once."""

    def __init__(self, nodes):
        self.known = nodes
        self.numbers, self.points = {}, []

    def number(self, key, point):
        if key not in self.numbers:
            self.numbers[key] = len(self.points)
            self.points.append(point)
        return self.numbers[key]

    def node(self, name):
        return self.number(name, self.known[name])

    def middle(self, corners, middles):
        """The middle of a face or a cell, by the quadratic shape functions."""
        key = frozenset(corners)
        weights = {3: (-1 / 9, 4 / 9), 4: (-1 / 4, 1 / 2), 8: (-1 / 4, 1 / 4)}[len(corners)]
        return self.number(key, sum(weights[0] * self.known[n] for n in corners) +
                           sum(weights[1] * self.known[n] for n in middles))

    def face(self, cell, corners):
        """The middle of a cell's face, and its edges."""
        kind, nodes = cell
        between = {frozenset((a, b)): m for a, b, m in EDGES[kind]}
        edges = [nodes[between[frozenset((corners[i], corners[(i + 1) % len(corners)]))]]
                 for i in range(len(corners))]
        return self.middle([nodes[i] for i in corners], edges), edges

    def cut_face(self, cell):
        """The quadrilaterals of a face, one at each corner."""
        kind, nodes = cell
        n = CORNERS[kind]
        middle, edges = self.face(cell, range(n))
        return [(self.node(nodes[i]), self.node(edges[i]), middle, self.node(edges[i - 1]))
                for i in range(n)]

    def cut_hexahedron(self, cell):
        """The hexahedra of a hexahedron, one at each corner, from a grid of 3 x 3 x 3 nodes."""
        _, nodes = cell
        place = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2),
                 (0, 2, 2)]
        grid = {place[i]: self.node(nodes[i]) for i in range(8)}

        def between(*corners):
            return tuple(sum(place[i][d] for i in corners) // len(corners) for d in range(3))
        for a, b, m in EDGES["HEXA20"]:
            grid[between(a, b)] = self.node(nodes[m])
        for corners in HEXA_FACES:
            grid[between(*corners)] = self.face(cell, corners)[0]
        grid[1, 1, 1] = self.middle(nodes[:8], nodes[8:])
        return [[grid[i + a // 2, j + b // 2, k + c // 2] for a, b, c in place]
                for i in (0, 1) for j in (0, 1) for k in (0, 1)]

    def cut_wedge(self, cell):
        """The hexahedra of a wedge, three in each half of its height."""
        _, nodes = cell
        sides = [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]
        levels = []
        for corners in ((0, 1, 2), (3, 4, 5)):
            middle, edges = self.face(cell, corners)
            levels.append(([self.node(nodes[i]) for i in corners],
                           [self.node(e) for e in edges], middle))
        upright = nodes[9:12]
        middles = [self.face(cell, side)[0] for side in sides]
        key = frozenset(nodes[:6])
        centre = -sum(self.known[n] for n in upright) / 9 + \
            4 / 9 * sum(self.points[m] for m in middles)
        levels.insert(1, ([self.node(n) for n in upright], middles, self.number(key, centre)))
        cut = []
        for low, high in zip(levels, levels[1:]):
            for i in range(3):
                cut.append([part for corners, edges, middle in (low, high)
                            for part in (corners[i], edges[i], middle, edges[i - 1])])
        return cut


def write_msh(name, points, cells, faces):
    names = sorted({n for n, _ in cells} | {n for n, _ in faces})
    volumes = {n for n, _ in cells}
    with open(name, "w") as out:
        print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames", len(names), sep="\n", file=out)
        for i, n in enumerate(names, 1):
            print(3 if n in volumes else 2, i, f'"{n}"', file=out)
        print("$EndPhysicalNames\n$Nodes", len(points), sep="\n", file=out)
        for i, (x, y, z) in enumerate(points, 1):
            print(i, f"{-y:.9g} {x:.9g} {z:.9g}", file=out)
        print("$EndNodes\n$Elements", len(faces) + len(cells), sep="\n", file=out)
        for i, (n, corners) in enumerate(faces + cells, 1):
            tag = names.index(n) + 1
            print(i, 3 if len(corners) == 4 else 5, 2, tag, tag, *[c + 1 for c in corners], file=out)
        print("$EndElements", file=out)


def positive(points, corners):
    """The corners in an order in which the edges at the first corner are right-handed."""
    p = [points[c] for c in corners]
    if numpy.dot(numpy.cross(p[1] - p[0], p[3] - p[0]), p[4] - p[0]) > 0:
        return corners
    return corners[4:] + corners[:4]


def write_mesh(folder):
    nodes, cells, groups = read_mail(folder / "fdlv112h.mail")
    refined = Refined(nodes)
    volumes, faces = [], []
    for group, name in CELL_SETS.items():
        for member in groups[group]:
            cell = cells[member]
            cut = refined.cut_hexahedron if cell[0] == "HEXA20" else refined.cut_wedge
            volumes += [(name, corners) for corners in cut(cell)]
    for group, name in FACE_SETS.items():
        for member in groups[group]:
            faces += [(name, corners) for corners in refined.cut_face(cells[member])]
    volumes = [(name, positive(refined.points, corners)) for name, corners in volumes]
    write_msh("fdlv112.msh", refined.points, volumes, faces)

    text = (folder / "fdlv112d.py").read_text().split("VALE")[1]
    text = re.sub("#.*", "", text)
    numbers = [float(n) for n in re.findall(r"-?\d+\.\d*(?:[Ee][+-]?\d+)?", text)]
    with open("fdlv112.csv", "w") as out:
        print("time [s],acceleration upstream [m/s2]", file=out)
        for time, value in zip(numbers[::2], numbers[1::2]):
            print(f"{time:g},{value:g}", file=out)
    print(len(refined.points), "nodes,", len(volumes), "hexahedra in fdlv112.msh;",
          len(numbers) // 2, "accelerations in fdlv112.csv")


# Crest, NO10027 in fdlv112h: time, acceleration; frequency, spectrum at 5 %, by
# fdlv112h (finite elements alone) and fdlv112d (rock and water by boundary elements).
REFERENCE = [("acceleration upstream at 1.01 s", 5.0422, 4.8846),
             ("spectrum at 10.7 Hz, 5 %", 19.3109, 17.3987)]


def spectrum(time, acceleration, frequency, damping=0.05):
    """Largest absolute acceleration of an oscillator, exact for linear acceleration between
    the points."""
    import scipy.linalg
    omega, dt = 2 * numpy.pi * frequency, time[1] - time[0]
    a = numpy.array([[0, 1, 0, 0], [-omega**2, -2 * damping * omega, -1, 0], [0, 0, 0, 1],
                     [0, 0, 0, 0]])
    step = scipy.linalg.expm(a * dt)
    state, largest = numpy.zeros(4), 0.
    for now, then in zip(acceleration, acceleration[1:]):
        state[2:] = now, (then - now) / dt
        state = step @ state
        largest = max(largest, abs(omega**2 * state[0] + 2 * damping * omega * state[1]))
    return largest


def crest_history(folder, decay=1.):
    """Acceleration of the crest when the rock at the end of the crest moves as recorded: by
    the transfer function between the two, from histories that are faded out, so that the
    end of the run has little influence, and without frequencies above 50 Hz."""
    table = list(csv.reader(open(folder / "histories.csv")))
    heading, rows = table[0], numpy.array(table[1:], float)

    def column(start):
        return rows[:, [h.startswith(start) for h in heading].index(True)]
    time = column("time")
    grid = numpy.arange(0, time[-1], 0.001)
    record = numpy.loadtxt("fdlv112.csv", delimiter=",", skiprows=1)
    fade, size = numpy.exp(-decay * grid), 4 * len(grid)

    def transform(times, values):
        return numpy.fft.rfft(fade * numpy.interp(grid, times, values, right=0), size)
    crest, rock = (transform(time, column(f"{point} acceleration y")) for point in ("crest", "rock"))
    frequency = numpy.fft.rfftfreq(size, 0.001)
    passed = 0.5 - 0.5 * numpy.cos(numpy.pi * numpy.clip(2 - frequency / 25, 0, 1))
    ratio = passed * crest / numpy.where(passed > 0, rock, 1)
    return grid, numpy.fft.irfft(ratio * transform(*record.T), size)[:len(grid)] / fade


def report_crest(folder):
    time, history = crest_history(folder)
    found = [numpy.interp(1.01, time, history), spectrum(time, history, 10.7)]
    print("m/s2                              fdlv112h  fdlv112d  Voussoir  off h")
    for (name, h, d), value in zip(REFERENCE, found):
        print(f"{name:32s} {h:9.3f} {d:9.3f} {value:9.3f} {100 * (value / h - 1):+6.1f} %")
    print(f"largest acceleration {abs(history).max():.3f} at {time[abs(history).argmax()]:.3f} s")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("action", choices=["mesh", "crest"])
    parser.add_argument("folder", type=pathlib.Path)
    options = parser.parse_args()
    (write_mesh if options.action == "mesh" else report_crest)(options.folder)


if __name__ == "__main__":
    main()
