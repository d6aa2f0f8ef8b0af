#!/usr/bin/env python3
"""Largest load and energy lost of the notched beam of tests/checks/notched_beam.cc, by
another method: the fictitious crack of Hillerborg, Modeer and Petersson (1976).

Half of the beam is elastic (plane strain, standard bilinear elements, scipy's sparse
solver). Above the tip of the crack the nodes of the plane of symmetry are fixed;
between notch and tip they open by w/2 under the stress ft (1 - w/wc), wc = 2 Gf/ft.
With the tip at each node in turn, the displacement of the press is the one at which the
stress at the tip is ft. Prints load [kN/m] and energy [J/m] under a press of 0.4 mm by
the number of elements over the height.
"""
import numpy as np
import scipy.sparse
import scipy.sparse.linalg

HEIGHT, HALF_LENGTH, NOTCH = 0.6, 1.05, 0.3
SUPPORT, HALF_LOAD = 0.1, 0.05
YOUNG, POISSON, STRENGTH, ENERGY = 20e9, 0.2, 2e6, 100.0


def element_stiffness(a, b):
    lam = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON)
    mu = YOUNG / 2 / (1 + POISSON)
    moduli = np.array([[lam + 2 * mu, lam, 0], [lam, lam + 2 * mu, 0], [0, 0, mu]])
    stiffness = np.zeros((8, 8))
    gauss = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3)
    for x in gauss:
        for y in gauss:
            # corners (0,0), (1,0), (1,1), (0,1)
            dx = np.array([-(1 - y), 1 - y, y, -y]) / a
            dy = np.array([-(1 - x), -x, x, 1 - x]) / b
            strain = np.zeros((3, 8))
            strain[0, 0::2] = dx
            strain[1, 1::2] = dy
            strain[2, 0::2] = dy
            strain[2, 1::2] = dx
            stiffness += 0.25 * a * b * strain.T @ moduli @ strain
    return stiffness


def ligament_and_load(rows):
    """Load [N/m] and pull of the plane of symmetry by node above the notch [N/m],
    each of half the beam, under unit displacements of the press and of those
    nodes; and the nodes' share of the height [m]."""
    h = HEIGHT / rows
    columns = round(HALF_LENGTH / h)
    node = lambda i, j: j * (columns + 1) + i
    local = element_stiffness(h, h)
    data, at_row, at_column = [], [], []
    for j in range(rows):
        for i in range(columns):
            corners = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]
            dofs = np.ravel([[2 * n, 2 * n + 1] for n in corners])
            at_row.append(np.repeat(dofs, 8))
            at_column.append(np.tile(dofs, 8))
            data.append(local.ravel())
    size = 2 * (columns + 1) * (rows + 1)
    matrix = scipy.sparse.csr_matrix(
        (np.concatenate(data), (np.concatenate(at_row), np.concatenate(at_column))), (size, size)
    )
    fixed = [2 * node(i, 0) + 1 for i in range(columns + 1) if i * h < SUPPORT + 1e-9]
    # the press also fixes its nodes along the beam
    fixed += [2 * node(i, rows) for i in range(columns) if i * h > HALF_LENGTH - HALF_LOAD - 1e-9]
    pressed = [2 * node(i, rows) + 1 for i in range(columns + 1) if i * h > HALF_LENGTH - HALF_LOAD - 1e-9]
    first = round(NOTCH / h)
    ligament = [2 * node(columns, j) for j in range(first, rows + 1)]
    # forces of the ligament and of the load under unit displacements of both
    known = np.array(fixed + pressed + ligament)
    free = np.setdiff1d(np.arange(size), known)
    solve = scipy.sparse.linalg.factorized(matrix[free][:, free].tocsc())
    units = np.zeros((len(known), len(ligament) + 1))
    units[len(fixed) : len(fixed) + len(pressed), 0] = -1.0
    for k in range(len(ligament)):
        units[len(fixed) + len(pressed) + k, k + 1] = 1.0
    coupling = matrix[free][:, known] @ units
    inner = np.column_stack([solve(-coupling[:, k]) for k in range(units.shape[1])])
    forces = matrix[known][:, free] @ inner + matrix[known][:, known] @ units
    load = -forces[len(fixed) : len(fixed) + len(pressed)].sum(axis=0)
    pull = forces[len(fixed) + len(pressed) :]
    area = np.full(len(ligament), h)
    area[[0, -1]] *= 0.5

    return load, pull, area


def largest_load(rows):
    load, pull, area = ligament_and_load(rows)
    opening = 2 * ENERGY / STRENGTH
    best = 0.0
    for tip in range(1, len(area) - 1):
        # unknown: press, and displacement -w/2 of the nodes below the tip
        n = tip
        system = np.zeros((n + 1, n + 1))
        right = np.zeros(n + 1)
        for row in range(n):
            # held back by ft (1 - w/wc): force on the beam to the right
            system[row, 0] = pull[row, 0]
            system[row, 1:] = pull[row, 1 : n + 1]
            system[row, row + 1] -= area[row] * STRENGTH * 2 / opening
            right[row] = area[row] * STRENGTH
        system[n, 0] = pull[tip, 0]
        system[n, 1:] = pull[tip, 1 : n + 1]
        right[n] = area[tip] * STRENGTH
        solution = np.linalg.solve(system, right)
        if (-2 * solution[1:] > opening).any():
            break
        # both halves
        best = max(best, 2 * (load[0] * solution[0] + load[1 : n + 1] @ solution[1:]))
    return best



def energy(rows, press):
    """Energy lost where the ligament opens, at this displacement of the press [J/m]:
    unloading goes to the origin, so that a node of opening w has lost Gf min(w/wc,
    1)."""
    load, pull, area = ligament_and_load(rows)
    opening = 2 * ENERGY / STRENGTH
    n_open, n_free = 1, 0  # from below
    while True:
        softening = np.zeros(n_open)
        softening[n_free:] = 2 * STRENGTH / opening
        held = np.where(np.arange(n_open) < n_free, 0.0, STRENGTH)
        system = pull[:n_open, 1 : n_open + 1] - np.diag(area[:n_open] * softening)
        moved = np.linalg.solve(system, area[:n_open] * held - pull[:n_open, 0] * press)
        tip = pull[n_open, 0] * press + pull[n_open, 1 : n_open + 1] @ moved
        widths = -2 * moved
        if (widths[n_free:] > opening).any():
            n_free += 1
        elif tip > area[n_open] * STRENGTH and n_open < len(area) - 2:
            n_open += 1
        else:
            return ENERGY * area[:n_open] @ np.minimum(widths / opening, 1)


if __name__ == "__main__":
    for rows in (24, 48, 96, 144):
        print(f"{rows}: {1e-3 * largest_load(rows):.2f} kN/m, {energy(rows, 0.4e-3):.2f} J/m")
