#!/usr/bin/env python3
"""An arch dam by independent code: trilinear hexahedra assembled here, scipy's sparse
solvers, Newmark's constant average acceleration. It shares only mesh and ground motion
with Voussoir, which it reads from a run's fields and ground_motion.csv.

    K   2 x 2 x 2 points      M   at the corners, as Voussoir has it (or row sums, or full)
    C = a (M + M_w) + b K, of each material its own b; a, b from the ratio at two frequencies
    water: mass 7/8 rho sqrt(H h) n n^T per area (Westergaard), H the depth below
           the level, of the column of faces, h that of the node
    rigid base: the forces - (M + M_w) a of all but massless rock
    boundary: springs and dashpots per area; K u + C v + sigma n of the free field,
           which is a column of linear elements, integrated by Newmark, too

usage: arch_dam_newmark.py RUN [--massless] [--step DT] [--mass KIND] [--all-levels] [--write FILE]
                           [--picture FILE] [--calculix FILE]
       RUN is one of doc/published/arch_dam_*.prm
"""
import argparse
import base64
import json
import re
import struct
import zlib

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import eigsh, splu

CONCRETE, ROCK = (30e9, 0.17, 2400.0), (20e9, 0.24, 2700.0)  # modulus, Poisson's ratio, density
WATER, LEVEL = 1000.0, 280.0
RATIO, BAND = 0.05, (1.0, 8.0)
LIGHT = 0.01  # massless rock: share of its mass
SOURCE = np.array([0.0, 0.0, 145.0])  # of the waves that leave through the boundary
GRAVITY = 9.81
# points of printed static stresses: corners of the dam
PLACES = [(0, 0, 289), (0, -14, 289), (0, 16, 208), (0, -19, 208), (0, 21, 125), (0, -28, 125), (0, 5, 0), (0, -58, 0), (158, -39, 289), (-158, -39, 289)]
# corners of a cell and of its faces, as VTK numbers them
CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
FACES = np.array([[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]])
POINTS = CORNERS / np.sqrt(3)


def read_vtu(name):
    """Points, cells and point data of a file with compressed base64 arrays."""
    kinds = {"Float32": "f4", "Float64": "f8", "Int32": "i4", "UInt8": "u1"}
    arrays = {}
    for head, body in re.findall(r"<DataArray ([^>]*)>([^<]*)</DataArray>", open(name).read()):
        attribute = dict(re.findall(r'(\w+)="([^"]*)"', head))
        if attribute["format"] != "binary" or attribute["type"] not in kinds:
            continue
        body = body.strip()
        blocks = struct.unpack("<I", base64.b64decode(body[:8])[:4])[0]
        length = 4 * -(-4 * (3 + blocks) // 3)
        sizes = struct.unpack(f"<{3 + blocks}I", base64.b64decode(body[:length])[: 4 * (3 + blocks)])[3:]
        data, text = base64.b64decode(body[length:]), b""
        for size in sizes:
            text, data = text + zlib.decompress(data[:size]), data[size:]
        values = np.frombuffer(text, kinds[attribute["type"]])
        if attribute.get("NumberOfComponents") == "3":
            values = values.reshape(-1, 3)
        arrays[attribute.get("Name", "points")] = values
    return arrays


class Mesh:
    def __init__(self, run):
        file = re.search(r'file="([^"]*)"', open(f"{run}/fields.pvd").read())[1]
        self.data = read_vtu(f"{run}/{file}")
        corners = self.data["points"][self.data["connectivity"]].astype(float)
        # cells share no points in the file
        _, first, number = np.unique(np.round(corners, 2), axis=0, return_index=True, return_inverse=True)
        self.nodes, self.cells = corners[first], number.reshape(-1, 8)
        self.rock = self.data["material"][self.data["connectivity"]].reshape(-1, 8)[:, 0] == 1
        outer = {}
        for cell, nodes in enumerate(self.cells):
            for face in nodes[FACES]:
                outer.setdefault(tuple(sorted(face)), []).append((cell, face))
        outer = [of[0] for of in outer.values() if len(of) == 1]
        self.outer_faces = np.array([face for _, face in outer])
        self.outer_cells = np.array([cell for cell, _ in outer])

    def normals(self, faces):
        x = self.nodes[faces]
        n = np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])
        return n / np.linalg.norm(n, axis=1)[:, None]

    def rim(self):
        """Faces on the five outer planes."""
        x, low, high = self.nodes[self.outer_faces], self.nodes.min(axis=0), self.nodes.max(axis=0)
        on = np.zeros(len(x), bool)
        for d, plane in ((0, low), (0, high), (1, low), (1, high), (2, low)):
            on |= (abs(x[:, :, d] - plane[d]) < 0.01).all(axis=1)
        return self.outer_faces[on]

    def upstream_face(self):
        dam = self.outer_faces[~self.rock[self.outer_cells]]
        return dam[self.normals(dam)[:, 1] > 0.5]

    def face_areas(self, faces, at_corners=False):
        """Integrals of shape function times normal, by corner [m2]."""
        x, areas = self.nodes[faces], np.zeros((len(faces), 4, 3))
        for s, t in np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / (1 if at_corners else np.sqrt(3)):
            N = np.array([(1 - s) * (1 - t), (1 + s) * (1 - t), (1 + s) * (1 + t), (1 - s) * (1 + t)]) / 4
            ds = np.array([-(1 - t), 1 - t, 1 + t, -(1 + t)]) / 4
            dt = np.array([-(1 - s), -(1 + s), 1 + s, 1 - s]) / 4
            n = np.cross(np.einsum("a,fad->fd", ds, x), np.einsum("a,fad->fd", dt, x))
            areas += N[:, None] * n[:, None, :]
        return areas


def moduli(material):
    E, nu, _ = material
    lam, mu = E * nu / (1 + nu) / (1 - 2 * nu), E / 2 / (1 + nu)
    D = np.diag([2 * mu] * 3 + [mu] * 3)
    D[:3, :3] += lam
    return D


def gradients(x, point):
    """Gradients of the shape functions in space, by cell, and the determinant."""
    one = 1 + CORNERS * point
    d = np.stack([CORNERS[:, 0] * one[:, 1] * one[:, 2], CORNERS[:, 1] * one[:, 0] * one[:, 2], CORNERS[:, 2] * one[:, 0] * one[:, 1]], axis=1) / 8
    jacobian = np.einsum("ai,cad->cid", d, x)
    return np.einsum("cdi,ai->cad", np.linalg.inv(jacobian), d), np.linalg.det(jacobian)


def strain_matrix(g):
    B = np.zeros((len(g), 6, 24))
    for row, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))):
        B[:, row, i::3] = g[:, :, j]
        if i != j:
            B[:, row, j::3] = g[:, :, i]
    return B


class Model:
    """Matrices of all unknowns; `free` are the unknowns that can move."""

    def __init__(self, mesh, light_rock, kind_of_mass="corners"):
        self.mesh, self.size = mesh, 3 * len(mesh.nodes)
        self.at_corners = kind_of_mass == "corners"
        self.stiffness, mass = [], []
        for material, cells in ((CONCRETE, mesh.cells[~mesh.rock]), (ROCK, mesh.cells[mesh.rock])):
            x, density = mesh.nodes[cells], material[2] * (LIGHT if light_rock and material is ROCK else 1)
            K, m = np.zeros((len(cells), 24, 24)), np.zeros((len(cells), 8, 8))
            for point in POINTS:
                g, determinant = gradients(x, point)
                B = strain_matrix(g)
                K += determinant[:, None, None] * np.einsum("cki,kl,clj->cij", B, moduli(material), B, optimize=True)
                if not self.at_corners:
                    N = (1 + CORNERS * point).prod(axis=1) / 8
                    m += density * determinant[:, None, None] * np.outer(N, N)
            if self.at_corners:
                for a in range(8):
                    m[:, a, a] = density * gradients(x, CORNERS[a])[1]
            dofs = (3 * cells[:, :, None] + np.arange(3)).reshape(-1, 24)
            self.stiffness.append(self.assemble(dofs, dofs, K))
            if kind_of_mass == "rows":
                m = np.einsum("cab,ad->cad", m, np.eye(8))
            m = sum(self.assemble(dofs[:, d::3], dofs[:, d::3], m) for d in range(3))
            mass.append(m)
        self.concrete_mass = mass[0]
        self.mass = mass[0] + mass[1]
        self.driven = mass[0] if light_rock else self.mass
        self.added = self.added_mass()
        self.free = np.arange(self.size)

    def assemble(self, rows, columns, values):
        shape = np.broadcast_shapes(rows[:, :, None].shape, columns[:, None, :].shape)
        return sparse.csr_matrix(
            (values.ravel(), (np.broadcast_to(rows[:, :, None], shape).ravel(), np.broadcast_to(columns[:, None, :], shape).ravel())),
            (self.size, self.size),
        )

    def blocks(self, nodes, values):
        """Matrix of 3 x 3 blocks at nodes."""
        dofs = 3 * nodes[:, None] + np.arange(3)
        return self.assemble(dofs, dofs, values)

    def added_mass(self):
        faces = self.mesh.upstream_face()
        x, areas = self.mesh.nodes[faces], self.mesh.face_areas(faces, self.at_corners)
        wet = x.reshape(-1, 3)
        values = np.zeros((len(faces), 4, 3, 3))
        for f in range(len(faces)):
            rim = 1e-6 * np.ptp(x[f], axis=0).max()
            below = (wet[:, 0] >= x[f, :, 0].min() - rim) & (wet[:, 0] <= x[f, :, 0].max() + rim)
            depth = LEVEL - wet[below, 2].min()
            for a in range(4):
                if x[f, a, 2] < LEVEL:
                    area = np.linalg.norm(areas[f, a])
                    n = areas[f, a] / area
                    values[f, a] = 7 / 8 * WATER * np.sqrt(depth * (LEVEL - x[f, a, 2])) * area * np.outer(n, n)
        return self.blocks(faces.ravel(), values.reshape(-1, 3, 3))

    def hold(self):
        fixed = np.unique(self.mesh.rim())
        self.free = np.setdiff1d(self.free, (3 * fixed[:, None] + np.arange(3)).ravel())

    def inner(self, matrix):
        return matrix[self.free][:, self.free].tocsc()

    def modes(self, number, water=True):
        """Natural frequencies [Hz] and shapes."""
        mass = self.mass + self.added if water else self.mass
        values, shapes = eigsh(self.inner(self.stiffness[0] + self.stiffness[1]), number, self.inner(mass), sigma=0)
        return np.sqrt(values) / (2 * np.pi), shapes

    def static_state(self):
        """Displacements under the weight of the dam and the pressure of the water [m]."""
        force = -GRAVITY * (self.concrete_mass @ np.tile([0.0, 0.0, 1.0], self.size // 3))
        faces = self.mesh.upstream_face()
        x = self.mesh.nodes[faces]
        # the level cuts faces: many points
        middles = (np.arange(32) + 0.5) / 16 - 1
        for s, t in np.array([[s, t] for s in middles for t in middles]):
            N = np.array([(1 - s) * (1 - t), (1 + s) * (1 - t), (1 + s) * (1 + t), (1 - s) * (1 + t)]) / 4
            ds, dt = np.array([-(1 - t), 1 - t, 1 + t, -(1 + t)]) / 4, np.array([-(1 - s), -(1 + s), 1 + s, 1 - s]) / 4
            n = np.cross(np.einsum("a,fad->fd", ds, x), np.einsum("a,fad->fd", dt, x))
            pressure = WATER * GRAVITY * np.maximum(LEVEL - np.einsum("a,fa->f", N, x[:, :, 2]), 0)
            push = -(1 / 16) ** 2 * N[None, :, None] * pressure[:, None, None] * n[:, None, :]
            np.add.at(force, (3 * faces[:, :, None] + np.arange(3)), push)
        u = np.zeros(self.size)
        u[self.free] = splu(self.inner(self.stiffness[0] + self.stiffness[1])).solve(force[self.free])
        return u

    def stresses(self, u):
        """Principal stresses at the eight corners of the dam's cells [Pa]."""
        cells = self.mesh.cells[~self.mesh.rock]
        of_cell = u.reshape(-1, 3)[cells].reshape(-1, 24)
        at = [strain_matrix(gradients(self.mesh.nodes[cells], corner)[0]) for corner in CORNERS]
        s = np.stack([np.einsum("kl,cli,ci->ck", moduli(CONCRETE), B, of_cell) for B in at], axis=1)
        tensor = s[..., [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(*s.shape[:2], 3, 3)
        return np.linalg.eigvalsh(tensor)


def rayleigh():
    w = 2 * np.pi * np.array(BAND)
    return 2 * RATIO * w[0] * w[1] / w.sum(), 2 * RATIO / w.sum()


class Newmark:
    """M a + C v + K u = f, from rest."""

    def __init__(self, mass, damping, stiffness, step):
        self.m, self.c, self.k, self.step = mass, damping, stiffness, step
        self.solve = splu((mass + step / 2 * damping + step**2 / 4 * stiffness).tocsc()).solve
        self.u = np.zeros(mass.shape[0])
        self.v, self.a = self.u.copy(), self.u.copy()

    def advance(self, force):
        dt = self.step
        u, v = self.u + dt * self.v + dt**2 / 4 * self.a, self.v + dt / 2 * self.a
        self.a = self.solve(force - self.c @ v - self.k @ u)
        self.u, self.v = u + dt**2 / 4 * self.a, v + dt / 2 * self.a


class Boundary:
    """Absorbing planes around the rock, with the vertical waves that enter there."""

    def __init__(self, model, step, all_levels):
        mesh = model.mesh
        E, nu, rho = ROCK
        G, M = E / 2 / (1 + nu), E * (1 - nu) / (1 + nu) / (1 - 2 * nu)
        cs, cp = np.sqrt(G / rho), np.sqrt(M / rho)
        faces = mesh.rim()
        areas, normals = mesh.face_areas(faces), mesh.normals(faces)
        nodes, size = faces.ravel(), np.linalg.norm(areas, axis=2).ravel()
        normal = np.einsum("fi,fj->fij", normals, normals).repeat(4, axis=0)
        across = np.eye(3) - normal
        r = np.linalg.norm(mesh.nodes[nodes] - SOURCE, axis=1)
        shape = (slice(None), None, None)
        self.springs = model.blocks(nodes, (size / r)[shape] * (4 / 3 * G * normal + 2 / 3 * G * across))
        self.dashpots = model.blocks(nodes, size[shape] * rho * (cp * normal + cs * across))
        self.nodes = mesh.nodes

        # the column: levels of the planes on the two banks, or of all; x and y (S), z (P)
        a, b = rayleigh()
        x = mesh.nodes[faces]
        upright = abs(normals[:, 2]) < 0.1 if all_levels else abs(normals[:, 0]) > 0.5
        self.levels = np.unique(np.round(x[upright, :, 2], 2))
        h = np.diff(self.levels)
        lumped = rho * np.convolve(h, [0.5, 0.5])
        self.columns, self.b, self.moduli, self.impedance = [], b, (G, G, M), rho * np.array([cs, cs, cp])
        for modulus, impedance in zip(self.moduli, self.impedance):
            k = np.zeros((len(h) + 1,) * 2)
            for e in range(len(h)):
                k[e : e + 2, e : e + 2] += modulus / h[e] * np.array([[1, -1], [-1, 1]])
            c = np.diag(a * lumped) + b * k
            c[0, 0] += impedance
            self.columns.append(Newmark(*(sparse.csc_matrix(m) for m in (np.diag(lumped), c, k)), step))
        # stress times area: sum over faces, of the element at the height of their middle
        self.faces, self.areas, self.ratio = faces, areas, nu / (1 - nu)
        self.level_face = abs(normals[:, 2]) > 0.5
        self.element = np.clip(np.searchsorted(self.levels, x[:, :, 2].mean(axis=1)) - 1, 0, len(h) - 1)
        self.h = h

    def force(self, incident_velocity):
        """Forces of the next step [N], under the incident velocities at the bottom
        [m/s]."""
        u, v, stress = np.zeros_like(self.nodes), np.zeros_like(self.nodes), np.zeros((len(self.h), 3))
        bottom = np.zeros(3)
        for d, column in enumerate(self.columns):
            push = np.zeros(len(self.levels))
            push[0] = 2 * self.impedance[d] * incident_velocity[d]
            column.advance(push)
            u[:, d], v[:, d] = (np.interp(self.nodes[:, 2], self.levels, f) for f in (column.u, column.v))
            stress[:, d] = self.moduli[d] * np.diff(column.u + self.b * column.v) / self.h
            bottom[d] = self.impedance[d] * (2 * incident_velocity[d] - column.v[0])
        s, n = stress[self.element][:, None, :], self.areas
        traction = np.stack([self.ratio * s[..., 2] * n[..., 0], self.ratio * s[..., 2] * n[..., 1], s[..., 0] * n[..., 0] + s[..., 1] * n[..., 1]], axis=-1)
        traction[self.level_face] = -n[self.level_face][..., 2:] * bottom
        result = self.springs @ u.ravel() + self.dashpots @ v.ravel()
        np.add.at(result, 3 * self.faces[:, :, None] + np.arange(3), traction)
        return result


def integral(values, step):
    return np.concatenate([0 * values[:1], np.cumsum((values[1:] + values[:-1]) * step / 2, axis=0)])


def response(model, motion, points, step, every, massless, all_levels):
    """Absolute displacements of points [m], by time, at intervals of some steps."""
    a, b = rayleigh()
    concrete, rock = model.stiffness
    times = np.arange(0, motion[-1, 0] + step / 2, step)
    ground = np.stack([np.interp(times, motion[:, 0], motion[:, d]) for d in (1, 2, 3)], axis=1)
    damping = a * (model.mass + model.added) + b * (concrete if massless else concrete + rock)
    stiffness = concrete + rock
    if massless:
        model.hold()
        driven = -(model.driven + model.added)
        directions = [driven @ np.tile(np.eye(3)[d], model.size // 3) for d in range(3)]
        force = lambda n: (sum(ground[n, d] * directions[d] for d in range(3)))[model.free]
        ground_displacement = integral(integral(ground, step), step)
    else:
        boundary = Boundary(model, step, all_levels)
        damping, stiffness = damping + boundary.dashpots, stiffness + boundary.springs
        # half of the outcrop motion is incident
        velocity = integral(ground / 2, step)
        ground_displacement = 0 * ground
        force = lambda n: boundary.force(velocity[n])
    scheme = Newmark(*(model.inner(m) for m in (model.mass + model.added, damping, stiffness)), step)
    rows = []
    for n in range(len(times)):
        if n > 0:
            scheme.advance(force(n))
        if n % every == 0:
            u = np.zeros(model.size)
            u[model.free] = scheme.u
            rows.append([times[n], *(u.reshape(-1, 3)[points] + ground_displacement[n]).ravel()])
    return np.array(rows)


def compare_modes(mesh, summary, kind_of_mass):
    rigid_rock = Model(mesh, True, kind_of_mass)
    rigid_rock.hold()
    for n, (f, theirs) in enumerate(zip(rigid_rock.modes(6)[0], summary["modes"]["modes"]), 1):
        print(f"mode {n}: {f:.5f} Hz, Voussoir {theirs['frequency [Hz]']:.5f} Hz, off by {100 * (theirs['frequency [Hz]'] / f - 1):.4f} %")


def compare_static(mesh):
    """Displacements and principal stresses of the dam in the static state."""
    model = Model(mesh, True)
    model.hold()
    u = model.static_state()
    connectivity = mesh.data["connectivity"].reshape(-1, 8)[~mesh.rock]
    cells = mesh.cells[~mesh.rock]
    theirs = mesh.data["displacement"][connectivity]
    ours = u.reshape(-1, 3)[cells]
    print(f"at rest: largest displacement {1e3 * abs(ours).max():.3f} mm, off by {100 * abs(theirs - ours).max() / abs(ours).max():.5f} % at most")
    principal = model.stresses(u) / 1e6
    for name, mine in (("largest", principal[..., 2]), ("smallest", principal[..., 0])):
        other = mesh.data[name + "_principal_stress_MPa"][connectivity]
        print(f"{name} principal stress, {mine.min():.3f} to {mine.max():.3f} MPa, off by {abs(other - mine).max():.2g} MPa at most")
    centres = mesh.nodes[cells].mean(axis=1)
    print("cells' corners, x y z [m]; displacement down the river [mm]; largest, smallest principal stress [MPa]; Voussoir's")
    for corner in PLACES:
        cell, a = np.unravel_index(np.argmin(np.linalg.norm(mesh.nodes[cells] - corner, axis=2)), cells.shape)
        print(*(f"{c:.1f}" for c in mesh.nodes[cells[cell, a]]), "|", f"{-1e3 * ours[cell, a, 1]:.3f} {principal[cell, a, 2]:.4f} {principal[cell, a, 0]:.4f}", "|",
              f"{-1e3 * theirs[cell, a, 1]:.3f}", *(f"{mesh.data[n + '_principal_stress_MPa'][connectivity[cell, a]]:.4f}" for n in ("largest", "smallest")))


def write_calculix(mesh, name):
    """The dam under its static loads, and natural modes with an empty reservoir, for
    ccx."""
    model = Model(mesh, True)
    model.hold()
    force = (model.stiffness[0] + model.stiffness[1]) @ model.static_state()
    with open(name, "w") as file:
        print("*NODE, NSET=ALL", file=file)
        for n, x in enumerate(mesh.nodes, 1):
            print(n, *(f"{c:.9g}" for c in x), sep=", ", file=file)
        for part, cells, (E, nu, density) in (
            ("DAM", np.flatnonzero(~mesh.rock), CONCRETE),
            ("ROCK", np.flatnonzero(mesh.rock), (*ROCK[:2], LIGHT * ROCK[2])),
        ):
            print(f"*ELEMENT, TYPE=C3D8, ELSET={part}", file=file)
            for cell in cells:
                print(cell + 1, *(mesh.cells[cell] + 1), sep=", ", file=file)
            print(f"*MATERIAL, NAME={part}\n*ELASTIC\n{E}, {nu}\n*DENSITY\n{density}", file=file)
            print(f"*SOLID SECTION, ELSET={part}, MATERIAL={part}", file=file)
        print("*NSET, NSET=HELD", *(n + 1 for n in np.unique(mesh.rim())), sep="\n", file=file)
        print("*BOUNDARY\nHELD, 1, 3\n*STEP\n*STATIC\n*CLOAD", file=file)
        for dof in model.free[abs(force[model.free]) > 1e-3]:
            print(dof // 3 + 1, dof % 3 + 1, f"{force[dof]:.10g}", sep=", ", file=file)
        print("*NODE PRINT, NSET=ALL\nU\n*END STEP\n*STEP\n*FREQUENCY\n6\n*END STEP", file=file)
    crest = np.argmin(np.linalg.norm(mesh.nodes - [0, -7, 289], axis=1))
    model = Model(mesh, True, "full")
    model.hold()
    print(f"{name}: node {crest + 1} is the middle of the crest; empty modes with full mass [Hz]", *(f"{f:.6f}" for f in model.modes(6, False)[0]))


def draw(names, ours, theirs, file):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(3, 1, figsize=(9, 6), sharex=True)
    for d, axis in enumerate(axes):
        axis.plot(ours[:, 0], 1e3 * ours[:, 1 + d], "k", linewidth=2.4, alpha=0.35, label="Newmark, scipy")
        axis.plot(theirs[:, 0], 1e3 * theirs[:, 1 + d], "C3", linewidth=0.8, label="Voussoir")
        axis.set_ylabel(f"crest, {'xyz'[d]} [mm]", fontsize=9)
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=8, loc="upper right")
    axes[2].set_xlabel("time [s]", fontsize=9)
    figure.tight_layout()
    figure.savefig(file, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run")
    parser.add_argument("--massless", action="store_true", help="with modes and static state")
    parser.add_argument("--mass", choices=("corners", "rows", "full"), default="corners")
    parser.add_argument("--step", type=float, default=0.002, help="[s]")
    parser.add_argument("--all-levels", action="store_true", help="free field on the levels of all planes")
    parser.add_argument("--calculix", help="only write an input of CalculiX")
    parser.add_argument("--write", help="table of the histories")
    parser.add_argument("--picture")
    options = parser.parse_args()

    mesh = Mesh(options.run)
    if options.calculix:
        return write_calculix(mesh, options.calculix)
    model = Model(mesh, options.massless, options.mass)
    print(f"{len(mesh.cells)} cells, {len(mesh.nodes)} nodes, dam {model.concrete_mass.sum() / 3:.5g} kg, "
          f"water along the river {model.added[1::3][:, 1::3].sum():.5g} kg")
    if options.massless:
        compare_modes(mesh, json.load(open(f"{options.run}/summary.json")), options.mass)
        compare_static(mesh)

    names = open(f"{options.run}/histories.csv").readline().strip().split(",")
    table = np.genfromtxt(f"{options.run}/histories.csv", delimiter=",", skip_header=1)
    motion = np.genfromtxt(f"{options.run}/ground_motion.csv", delimiter=",", skip_header=1)
    motion = motion[motion[:, 0] < table[-1, 0] + 0.01]
    text = re.search(r"set Points\s*=\s*([^#\n]*)", open(f"{options.run}/parameters.prm").read())[1]
    places = np.array([[float(c) for c in p.split(":")[1].split()] for p in text.split(";")])
    points = [np.argmin(np.linalg.norm(mesh.nodes - p, axis=1)) for p in places]
    print("points off nodes by", *(f"{np.linalg.norm(mesh.nodes[n] - p):.4f}" for n, p in zip(points, places)), "m")
    every = round((table[1, 0] - table[0, 0]) / options.step)
    rows = response(model, motion, points, options.step, every, options.massless, options.all_levels)
    if options.write:
        np.savetxt(options.write, rows, delimiter=",", fmt="%.6g", header=",".join(names), comments="")
    if options.picture:
        draw(names, rows, table, options.picture)
    for i in range(1, len(names)):
        theirs = np.interp(rows[:, 0], table[:, 0], table[:, i])
        peak, off = abs(rows[:, i]).max(), abs(rows[:, i] - theirs).max()
        print(f"{names[i]}: peak {1e3 * peak:.3f} mm, Voussoir {1e3 * abs(table[:, i]).max():.3f} mm, largest difference {100 * off / peak:.2f} % of it")


if __name__ == "__main__":
    main()
