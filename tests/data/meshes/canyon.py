#!/usr/bin/env python3
"""Writes canyon.msh: a slice of rock with a semi-circular canyon of radius 1, to an
outer half circle, or half square, in the format of Gmsh; y along the surface, z up,
x across the slice.

usage: canyon.py FILE [--outer RADIUS] [--around CELLS] [--thickness T] [--square]
"""
import argparse
import math


def write(file, outer, around, thickness, square):
    # as long as they are wide
    layers = round(math.log(outer) * around / math.pi)
    nodes, quads, cells = [], [], []
    node = lambda i, j, k: 1 + (j * (around + 1) + i) * 2 + k  # around, outwards, across
    for j in range(layers + 1):
        for i in range(around + 1):
            phi = math.pi * (i / around - 1)  # from -y downwards to y
            c, s = math.cos(phi), math.sin(phi) if 0 < i < around else 0.0
            # straight lines from the canyon to the outer rim
            end = outer / max(abs(c), abs(s)) if square else outer
            share = (outer ** (j / layers) - 1) / (outer - 1)
            r = 1 + share * (end - 1)
            nodes += [(k * thickness, r * c, r * s) for k in (0, 1)]
    for j in range(layers):
        for i in range(around):
            corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
            cells.append([node(*c, k) for k in (0, 1) for c in corners])
            quads += [(2, [node(*c, k) for c in corners]) for k in (0, 1)]
            if j + 1 == layers:
                quads.append((3, [node(i, layers, 0), node(i + 1, layers, 0),
                                  node(i + 1, layers, 1), node(i, layers, 1)]))
    print('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n3 1 "rock"\n2 2 "sides"\n2 3 "outer"', file=file)
    print("$EndPhysicalNames\n$Nodes", len(nodes), sep="\n", file=file)
    for n, x in enumerate(nodes, 1):
        print(n, *(f"{c:.10g}" for c in x), file=file)
    print("$EndNodes\n$Elements", len(quads) + len(cells), sep="\n", file=file)
    for n, (kind, tag, corners) in enumerate([(3, *q) for q in quads] + [(5, 1, c) for c in cells], 1):
        print(n, kind, 2, tag, tag, *corners, file=file)
    print("$EndElements", file=file)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=argparse.FileType("w"))
    parser.add_argument("--outer", type=float, default=4, help="radius, or half width and depth")
    parser.add_argument("--around", type=int, default=32, help="cells around the canyon")
    parser.add_argument("--thickness", type=float, default=0.25)
    parser.add_argument("--square", action="store_true", help="with level bottom and upright ends")
    write(**vars(parser.parse_args()))


if __name__ == "__main__":
    main()
