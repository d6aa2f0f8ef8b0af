#!/usr/bin/env python3
"""Largest mean stress of a plate of 99 m by 207 m with a notch 18 m deep and 27 m high, of
tests/checks/notches.cc, whose upper edge a fictitious crack leaves level; of one with a slit;
and of plates of 216 m with a V-shaped notch 18 m deep, by the angle that the solid fills. Law
and constants are those of notched_plate_reference.py.

Each side of the level of the crack is an elastic body (plane stress, bilinear elements that
grow away from the edge), whose stiffness is condensed to the nodes on this level. With the
tip at each node in turn the pull of the clamped upper end is the one at which the stress at
the tip is ft; the openings behind it are found by Newton's method. The traction has the
direction of the opening. Prints the stress by the size of the smallest elements, 0.125 m at
last: corner 0.559, slit 0.379, V of 205, 215, 225, 247.5 and 270 degrees 0.686, 0.549, 0.474,
0.401 and 0.381 MPa.
"""
import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from notched_plate_reference import (ENERGY, HALF_HEIGHT, NOTCH, STRENGTH, WIDTH, element_stiffness,
                                     graded, traction_of)

NOTCH_HEIGHT, V_HALF_HEIGHT = 27.0, 108.0
FINE, FOLLOWED = 14.0, 12.0  # lengths ahead of the notch: with the smallest elements, of the crack


def condensed(x, z, removed, slope=0.):
    """Stiffness of the nodes ahead of the notch at z = 0 of a body from there to z[-1], and
    the forces on them by a unit displacement of its clamped end. With a slope the left side
    recedes from the notch on, and columns follow it."""
    node = np.arange(len(x) * len(z)).reshape(len(x), len(z))
    corners = np.stack([node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]], 2).reshape(-1, 4)
    left = np.maximum(NOTCH - slope * z, 0)
    turned = left + (x[:, None] - NOTCH) / (WIDTH - NOTCH) * (WIDTH - left)
    position = np.stack([np.where(x[:, None] < NOTCH, x[:, None], turned),
                         z + 0 * turned], 2).reshape(-1, 2)
    kept = ~removed(*np.meshgrid((x[1:] + x[:-1]) / 2, (z[1:] + z[:-1]) / 2, indexing="ij")).ravel()
    dofs = np.stack([2 * corners, 2 * corners + 1], 2).reshape(-1, 8)[kept]
    matrix = scipy.sparse.coo_matrix(
        (element_stiffness(position[corners[kept]]).ravel(),
         (np.repeat(dofs, 8, 1).ravel(), np.tile(dofs, (1, 8)).ravel())),
        shape=(2 * node.size, 2 * node.size)).tocsc()
    line = node[x > NOTCH - 1e-6, 0]
    line = np.stack([2 * line, 2 * line + 1], 1).ravel()
    end = np.append(2 * node[:, -1], 2 * node[:, -1] + 1)
    free = np.setdiff1d(np.unique(dofs), np.append(line, end))
    moved = np.zeros(2 * node.size)
    moved[2 * node[:, -1] + 1] = 1
    solve = scipy.sparse.linalg.splu(matrix[free][:, free]).solve
    coupling = matrix[line][:, free]
    stiffness = matrix[line][:, line].toarray() - coupling @ solve(matrix[free][:, line].toarray())
    force = coupling @ solve(matrix[free] @ moved) - matrix[line] @ moved
    return stiffness, force


def tractions(opening):
    """On the lower side, by opening, x and z of each node in turn; no penetration."""
    along, apart = opening.reshape(-1, 2).T
    size = np.hypot(along, np.maximum(apart, 0)) + 1e-12
    per_opening = traction_of(size / 2, False) / size
    return np.stack([per_opening * along,
                     np.where(apart > 0, per_opening * apart, 1e13 * apart)], 1).ravel()


def largest_stress(size, notch):
    """@p notch: "slit", "corner" or the angle of the solid at a V [degrees]."""
    x = np.concatenate([NOTCH - graded(NOTCH, size)[::-1][:-1],
                        np.arange(NOTCH, NOTCH + FINE, size),
                        NOTCH + FINE + graded(WIDTH - NOTCH - FINE, size)])
    if notch == "corner":
        level = HALF_HEIGHT + NOTCH_HEIGHT / 2
        above, below = graded(2 * HALF_HEIGHT - level, size), graded(level, size)
        below[np.argmin(np.abs(below - NOTCH_HEIGHT))] = NOTCH_HEIGHT
        upper, by_pull = condensed(x, above, lambda x, z: np.zeros_like(x, bool))
        lower, _ = condensed(x, below, lambda x, z: (x < NOTCH) & (z < NOTCH_HEIGHT))
    elif notch == "slit":
        upper, by_pull = condensed(x, graded(HALF_HEIGHT, size),
                                   lambda x, z: np.zeros_like(x, bool))
        lower = upper
    else:
        above, slope = graded(V_HALF_HEIGHT, size), np.tan(np.radians(notch / 2 - 90))
        above[np.argmin(np.abs(above - NOTCH / slope))] = NOTCH / slope
        upper, by_pull = condensed(x, above, lambda x, z: x < NOTCH, slope)
        lower = upper
    mirror = np.tile([1, -1], len(by_pull) // 2)  # z points downwards in the lower body
    flexibility = np.linalg.inv(upper) + np.linalg.inv(lower * np.outer(mirror, mirror))
    # forces between the bodies by pull p and openings w: stiffness (p free_opening - w)
    stiffness, free_opening = np.linalg.inv(flexibility), np.linalg.solve(upper, by_pull)
    of_pull = stiffness @ free_opening

    half = np.diff(x[x > NOTCH - 1e-6]) / 2
    length = np.append(half, 0) + np.append(0, half)
    of_dofs = np.repeat(length, 2)
    opening, pull = np.zeros(0), STRENGTH * length[0] / of_pull[1]
    largest = pull * of_pull[1::2].sum()
    for tip in range(1, int(FOLLOWED / size)):
        n = 2 * tip
        opening = np.append(opening, [0, 1e-7])
        change = 1.
        while change > 1e-9:
            # traction at open nodes, and ft at the tip
            error = np.append(of_dofs[:n] * tractions(opening) + stiffness[:n, :n] @ opening
                              - of_pull[:n] * pull,
                              pull * of_pull[n + 1] - stiffness[n + 1, :n] @ opening
                              - STRENGTH * length[tip])
            tangent = np.zeros((n + 1, n + 1))
            tangent[:n, :n] = stiffness[:n, :n]
            tangent[n, :n] = -stiffness[n + 1, :n]
            tangent[:n, n], tangent[n, n] = -of_pull[:n], of_pull[n + 1]
            small = 1e-9
            for component in (0, 1):
                shifted = opening.copy()
                shifted[component::2] += small
                slope = of_dofs[:n] * (tractions(shifted) - tractions(opening)) / small
                for of_node in (0, 1):
                    at = np.arange(0, n, 2)
                    tangent[at + of_node, at + component] += slope[of_node::2]
            step = np.linalg.solve(tangent, -error)
            opening, pull = opening + step[:n], pull + step[n]
            change = np.abs(step[:n]).max() / np.abs(opening).max()
        force = of_pull * pull - stiffness[:, :n] @ opening
        largest = max(largest, force[1::2].sum())
    return largest / WIDTH


if __name__ == "__main__":
    for notch in ("corner", "slit", 205, 215, 225, 247.5, 270):
        for size in (0.5, 0.25, 0.125):
            print(notch, f"elements of {size} m: {1e-6 * largest_stress(size, notch):.4f} MPa",
                  flush=True)
