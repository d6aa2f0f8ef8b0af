#!/usr/bin/env python3
"""Largest mean stress of the notched plate of tests/checks/notched_plate.cc, found in another way:
a fictitious crack whose traction falls with its opening w as ft exp(-w ft / Gf), or with "linear" as
ft (1 - w ft / (2 Gf)).

Half of the plate is elastic (plane stress, bilinear elements that grow away from
the tip, scipy's sparse solver), its upper end clamped. With the tip at each node
in turn the pull is the one at which the stress at the tip is ft, and the
tractions behind it are found by relaxation. Prints the stress [MPa] by the size
of the smallest elements; with "free" for ends under uniform stress: 0.320 MPa
by elements of 0.125 m, linear 0.343 MPa.
"""
import sys

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

WIDTH, HALF_HEIGHT, NOTCH = 99.0, 103.5, 18.0
YOUNG, POISSON, STRENGTH, ENERGY = 36e9, 0.2, 2.5e6, 350.0
FINE = 14.0  # length ahead of the notch with the smallest elements


def graded(length, size):
    """Coordinates from zero to a length, in steps that grow."""
    at = [0.0]
    while at[-1] + size < length:
        at.append(at[-1] + size)
        size = min(1.15 * size, 6.0)
    return np.array(at) * length / at[-1]


def element_stiffness(corners):
    """Of elements with corners (0,0), (1,0), (1,1), (0,1), one a row."""
    moduli = YOUNG / (1 - POISSON ** 2) * np.array([[1, POISSON, 0], [POISSON, 1, 0],
                                                    [0, 0, (1 - POISSON) / 2]])
    stiffness = np.zeros((len(corners), 8, 8))
    gauss = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3)
    for a in gauss:
        for b in gauss:
            derivatives = np.array([[-(1 - b), 1 - b, b, -b], [-(1 - a), -a, a, 1 - a]])
            jacobian = derivatives @ corners
            gradients = np.linalg.solve(jacobian, np.tile(derivatives, (len(corners), 1, 1)))
            dx, dz = np.moveaxis(gradients, 1, 0)
            strain = np.zeros((len(corners), 3, 8))
            strain[:, 0, ::2] = strain[:, 2, 1::2] = dx
            strain[:, 1, 1::2] = strain[:, 2, ::2] = dz
            stiffness += 0.25 * np.linalg.det(jacobian)[:, None, None] * np.einsum(
                "eki,kl,elj->eij", strain, moduli, strain)
    return stiffness


def traction_of(opening, linear):
    """At half of the opening w."""
    fallen = 2 * np.maximum(opening, 0.) * STRENGTH / ENERGY
    return STRENGTH * (np.maximum(0., 1. - fallen / 2) if linear else np.exp(-fallen))


def largest_stress(size, clamped, linear):
    x = np.concatenate([NOTCH - graded(NOTCH, size)[::-1][:-1],
                        np.arange(NOTCH, NOTCH + FINE, size),
                        NOTCH + FINE + graded(WIDTH - NOTCH - FINE, size)])
    z = graded(HALF_HEIGHT, size)
    node = np.arange(len(x) * len(z)).reshape(len(x), len(z))
    corners = np.stack([node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]], 2).reshape(-1, 4)
    dofs = np.stack([2 * corners, 2 * corners + 1], 2).reshape(-1, 8)
    position = np.stack(np.meshgrid(x, z, indexing="ij"), 2).reshape(-1, 2)
    matrix = scipy.sparse.coo_matrix((element_stiffness(position[corners]).ravel(),
                                      (np.repeat(dofs, 8, 1).ravel(), np.tile(dofs, (1, 8)).ravel()))).tocsc()

    def shares(at):
        """Length that belongs to each of these coordinates."""
        half = np.diff(at) / 2
        return np.append(half, 0) + np.append(0, half)

    # the ligament, opened by v, and the pull p, of the end or as a stress
    first = np.searchsorted(x, NOTCH - 1e-6)
    ligament = 2 * node[first:, 0] + 1
    top = 2 * node[:, -1]
    pulled = np.zeros(matrix.shape[0])
    pulled[top + 1] = 1 if clamped else shares(x)
    fixed = np.concatenate([top, top + 1]) if clamped else top[:1]
    free = np.setdiff1d(np.arange(matrix.shape[0]), np.concatenate([fixed, ligament]))
    solve = scipy.sparse.linalg.splu(matrix[free][:, free]).solve
    of_opening = solve(matrix[free][:, ligament].toarray())
    stiffness = matrix[ligament][:, ligament].toarray() - matrix[ligament][:, free] @ of_opening
    force = matrix @ pulled if clamped else -pulled
    of_pull = solve(force[free])
    by_pull = (force[ligament] if clamped else 0) - matrix[ligament][:, free] @ of_pull
    if clamped:
        end = matrix[top + 1]
        load_by_pull = (force[top + 1] - end[:, free] @ of_pull).sum()
        load_by_opening = (end[:, ligament].toarray() - end[:, free] @ of_opening).sum(0)
    else:
        load_by_pull, load_by_opening = WIDTH, np.zeros(len(ligament))

    length = shares(x[first:])
    opening = np.zeros(len(ligament))  # half of w
    largest = 0.
    for tip in range(1, int(FINE / size)):
        open_nodes = np.arange(tip)
        rows = np.append(open_nodes, tip)
        inverse = np.linalg.inv(np.column_stack([stiffness[np.ix_(rows, open_nodes)], by_pull[rows]]))
        change = 1.
        while change > 1e-9:
            traction = traction_of(opening[rows], linear)
            solution = -inverse @ (traction * length[rows])
            step = solution[:-1] - opening[:tip]
            opening[:tip] += 0.1 * step
            change = np.abs(step).max()
        largest = max(largest, (load_by_pull * solution[-1] + load_by_opening @ opening) / WIDTH)
    return largest


if __name__ == "__main__":
    for size in (0.5, 0.25, 0.125):
        stress = largest_stress(size, "free" not in sys.argv, "linear" in sys.argv)
        print(f"elements of {size} m: {1e-6 * stress:.4f} MPa")
