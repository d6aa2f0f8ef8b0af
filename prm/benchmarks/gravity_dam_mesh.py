#!/usr/bin/env python3
"""Meshes of a slice of Pine Flat or Koyna Dam, in the format of Gmsh.

    python3 gravity_dam_mesh.py FILE [--dam koyna] [--refine N] [--water LENGTH] [--rock EXTENT]

Pine Flat's section is that of input/INPUT.TXT in the GitHub repository NiliAbtahi/
Modern-Fortran-Finite-Element-Analysis-for-Dam-Reservoir-Foundation-system-; Koyna's
that of koyna.prm, with water up to the crest.
Metres; y upstream from the heel, z up from the base.
"""
import argparse

# Elevation and distances of the upstream and the downstream face from the heel; rows of
# cells between these elevations; number of these intervals under water.
DAMS = {
    "pine flat": ([(0, 0, 95.71), (91.44, 4.57, 24.38), (102.17, 5.11, 17.70),
                   (106.68, 5.11, 15.64), (112.41, 5.11, 14.86), (116.19, 5.11, 14.86),
                   (121.92, 5.11, 14.86)], [16, 2, 1, 1, 1, 1], 5),
    "koyna": ([(0, 0, 70), (66.5, 0, 19.25), (103, 0, 14.8)], [12, 7], 2),
}
COLUMNS = 8  # of cells from face to face
THICKNESS = 10  # of the slice
SIDES = {"dam": "side", "rock": "rock side"}  # names of the faces across the slice


def between(a, b, part):
    return a + (b - a) * part


def section(corners, numbers, refine):
    """Elevation and distances of the faces at each row of nodes."""
    rows = []
    for low, high, cells in zip(corners, corners[1:], numbers):
        rows += [[between(a, b, k / (cells * refine)) for a, b in zip(low, high)]
                 for k in range(cells * refine)]
    return rows + [list(corners[-1])]


def graded(length, first, growth):
    """Distances up to a length, in steps that grow from about the first one."""
    steps = [first]
    while sum(steps) < length:
        steps.append(steps[-1] * growth)
    scale = length / sum(steps)
    return [scale * sum(steps[:k]) for k in range(len(steps) + 1)]


class Mesh:
    """Quadrilaterals of the section, to be extruded across the slice."""

    def __init__(self):
        self.nodes, self.cells, self.edges = {}, [], []

    def node(self, y, z):
        return self.nodes.setdefault((round(y, 6), round(z, 6)), len(self.nodes))

    def grid(self, name, points, sides):
        """Cells between rows of points (upwards, each from upstream to downstream), with the
        names of the sides (bottom, top, upstream, downstream)."""
        number = [[self.node(*p) for p in row] for row in points]
        for low, high in zip(number, number[1:]):
            self.cells += [(name, (low[i], high[i], high[i + 1], low[i + 1]))
                           for i in range(len(low) - 1)]
        for side, nodes in zip(sides, [number[0], number[-1], [r[0] for r in number],
                                       [r[-1] for r in number]]):
            if side:
                self.edges += [(side, edge) for edge in zip(nodes, nodes[1:])]

    def write(self, file):
        volumes = {name for name, _ in self.cells}
        count = len(self.nodes)
        faces = [(name, (a, b, b + count, a + count)) for name, (a, b) in self.edges]
        hexahedra = []
        for name, q in self.cells:
            hexahedra.append((name, q + tuple(i + count for i in q)))
            if name in SIDES:
                faces += [(SIDES[name] + " minus", q),
                          (SIDES[name] + " plus", tuple(i + count for i in q))]
        names = sorted(volumes | {name for name, _ in faces})
        print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames", len(names), sep="\n", file=file)
        for i, name in enumerate(names, 1):
            print(3 if name in volumes else 2, i, f'"{name}"', file=file)
        print("$EndPhysicalNames\n$Nodes", 2 * count, sep="\n", file=file)
        for side in range(2):
            for (y, z), i in self.nodes.items():
                print(i + 1 + side * count, side * THICKNESS, y, z, file=file)
        print("$EndNodes\n$Elements", len(faces) + len(hexahedra), sep="\n", file=file)
        for i, (name, nodes) in enumerate(faces + hexahedra, 1):
            tag = names.index(name) + 1
            print(i, 3 if len(nodes) == 4 else 5, 2, tag, tag, *[n + 1 for n in nodes], file=file)
        print("$EndElements", file=file)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=argparse.FileType("w"))
    parser.add_argument("--dam", choices=DAMS, default="pine flat")
    parser.add_argument("--refine", type=int, default=1, help="cells per cell of the coarsest mesh")
    parser.add_argument("--water", type=float, default=0, help="length of the reservoir [m]")
    parser.add_argument("--rock", type=float, default=0, help="rock below, up- and downstream [m]")
    options = parser.parse_args()

    mesh = Mesh()
    corners, numbers, wet_parts = DAMS[options.dam]
    rows = section(corners, numbers, options.refine)
    columns = [k / (COLUMNS * options.refine) for k in range(COLUMNS * options.refine + 1)]
    mesh.grid("dam", [[(-between(u, d, c), z) for c in columns] for z, u, d in rows],
              ["base", None, "upstream face", "downstream face"])
    away = graded(options.rock or options.water, 6 / options.refine, 1.06)
    if options.water:
        wet = [y for y in away if y < 1.01 * options.water][::-1]
        wet_rows = rows[:sum(numbers[:wet_parts]) * options.refine + 1]
        mesh.grid("reservoir", [[(between(-u, wet[0], y / wet[0]), z) for y in wet]
                                for z, u, _ in wet_rows],
                  ["reservoir bottom", "water surface", "reservoir end", None])
    if options.rock:
        along = away[:0:-1] + [-corners[0][2] * c for c in columns] + \
            [-corners[0][2] - y for y in away[1:]]
        mesh.grid("rock", [[(y, -z) for y in along] for z in away[::-1]],
                  ["bottom", None, "upstream end", "downstream end"])
    mesh.write(options.file)


if __name__ == "__main__":
    main()
