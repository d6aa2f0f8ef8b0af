#!/usr/bin/env python3
"""Prints the hand calculation of hand_check.md for the dam of prm/hand_check.prm.

usage: doc/hand_check.py [FOLDER]

With the results of a run that has natural modes it also prints the response of these
modes at the crest to the design spectrum.

Only numbers of the case enter; areas and direction of the planes of the block are
those of the mesh. The dam consists of arches and cantilevers: each arch, one metre
high, is a frame of beams on springs of the rock, and takes its shape under a pressure
that falls from the crown to the banks like a cosine. This shape times one function of
the elevation is the displacement of the dam; the energy of bending of the cantilevers
is added to that of the arches (Ritz). Three modes respond to the design spectrum and
are combined by the root of the sum of squares.
"""
import itertools
import json
import pathlib
import sys

import numpy as np
from scipy.integrate import dblquad
from scipy.interpolate import PchipInterpolator
from scipy.linalg import eigh

G, WATER, CONCRETE, LEVEL = 9.81, 1000., 2400., 145.
DYNAMIC, STATIC = 30e9, 0.67 * 30e9  # moduli of the concrete [Pa]
ROCK, NU, NU_ROCK = 25e9, 0.17, 0.25
# peak acceleration along the river [m/s2] and design spectrum over it [-]
PEAK, PLATEAU, CHARACTERISTIC, DECAY = 0.20 * G, 2.5, 0.2, 0.6
VERTICAL = 0.13 * G
# elevation, upstream face, thickness at crown, right, left, radius right, left, half
# width right, left [m]
ARCHES = np.array([[0., 8, 30, 32, 32, 80, 90, 25, 30], [50, 14, 24, 27, 28, 120, 130, 70, 80],
                   [100, 10, 17, 20, 21, 150, 165, 110, 125], [150, 0, 8, 10, 10, 175, 190, 145, 165]])
HEIGHT = ARCHES[-1, 0]
table = PchipInterpolator(ARCHES[:, 0], ARCHES[:, 1:])  # the other columns at an elevation

ELEVATION, VOLUME, DENSITY = 75., 145975., 2700.  # of the block
FRICTION, COHESION, BOTTOM, SIDE = 0.6, 0.1e6, 6680., 4589.  # areas in contact [m2]
PROGRAM = np.array([1430.2e6, -1826.7e6, -4956.7e6])  # force on it by the program [N]
NORMALS = np.array([[-np.sin(np.radians(20.)), 0., np.cos(np.radians(20.))], [-0.967, 0.254, 0.]])


def half(z, bank, n=40):
    """x, y and thickness along half an arch from the crown: the thickness grows with
    the square of the length."""
    face, crown, *sides = table(z)
    thickness, radius, width = sides[bank::2]
    x = np.linspace(0., width, n + 1)
    length = radius / 2. * (x / radius * np.hypot(1., x / radius) + np.arcsinh(x / radius))
    return np.array([x, face - crown / 2. - x**2 / 2. / radius, crown + (thickness - crown) * (length / length[-1])**2])


def arch(z):
    """x, y and thickness along an arch from the right bank to the left."""
    right, left = half(z, 0), half(z, 1)
    right[0] *= -1.
    return np.concatenate((right[:, :0:-1], left), axis=1)


def rock_springs(t, length=440.):
    """Stiffness of a metre of the foundation, t wide and as long as the contour of the
    dam: translation by the mean displacement under a uniform pressure (Boussinesq),
    rotation of a rigid strip on a half-plane."""
    modulus = ROCK / (1. - NU_ROCK**2)
    mean = 4. / length / t * dblquad(lambda v, u: (length - u) * (t - v) / np.hypot(u, v), 0., length, 0., t)[0]
    return np.pi * modulus * t / mean, np.pi * modulus * t**2 / 16.


class Arch:
    """An arch, one metre high, displaced upstream by one at the crown."""

    def __init__(self, z, modulus):
        x, y, self.t = arch(z)
        n = len(x)
        h = np.hypot(np.diff(x), np.diff(y))
        along = np.array([np.diff(x), np.diff(y)]) / h
        self.share = np.append(h, 0.) / 2. + np.append(0., h) / 2.
        normal = np.array([np.gradient(-y, x), np.ones(n)])
        self.normal = normal / np.linalg.norm(normal, axis=0)  # upstream
        stiffness, beams = np.zeros((3 * n, 3 * n)), []
        for i, (c, s) in enumerate(along.T):
            t = (self.t[i] + self.t[i + 1]) / 2.
            a, b = modulus * t / h[i], modulus * t**3 / 12. / h[i]
            strains = np.array([[-1, 0, 0, 1, 0, 0], [0, 1 / h[i], 1, 0, -1 / h[i], 0], [0, 1 / h[i], 0, 0, -1 / h[i], 1]])
            strains = strains @ np.kron(np.eye(2), [[c, s, 0], [-s, c, 0], [0, 0, 1]])
            beam = strains.T @ np.array([[a, 0, 0], [0, 4 * b, 2 * b], [0, 2 * b, 4 * b]]) @ strains
            stiffness[3 * i:3 * i + 6, 3 * i:3 * i + 6] += beam
            beams.append(beam)
        springs = {}
        for node in (0, n - 1):
            translation, rotation = rock_springs(self.t[node])
            springs[node] = np.array([translation, translation, rotation])
        for node, spring in springs.items():
            stiffness[3 * node:3 * node + 3, 3 * node:3 * node + 3] += np.diag(spring)
        arc = np.cumsum(h)
        arc = np.append(0., arc) - arc[n // 2 - 1]
        pressure = np.cos(np.pi / 2. * arc / np.where(arc < 0., -arc[0], arc[-1]))
        force = np.zeros(3 * n)
        force[0::3], force[1::3] = -self.normal * self.share * pressure
        u = np.linalg.solve(stiffness, force)
        self.stiffness = u @ force
        scale = u[3 * (n // 2) + 1]
        self.u = u.reshape(-1, 3).T[:2] / scale
        self.stiffness /= scale**2
        self.across = np.sum(self.u * self.normal, axis=0)
        self.along = self.u[0] * self.normal[1] - self.u[1] * self.normal[0]
        self.slope = np.gradient(self.across, arc)
        self.thrust = (beams[n // 2] @ u[3 * (n // 2):3 * (n // 2) + 6])[0] / scale
        self.on_left_bank = springs[n - 1][0] * self.u[:, -1]


def dam(modulus, twist, n=30):
    """The dam with or without the energy of twist and of shear between arches:
    elevations; matrices of stiffness and of mass, without and with Westergaard's added
    mass, the load of the water, and that of a unit acceleration of the ground downstream,
    for values and slopes of the displacement of the crown at these elevations."""
    z, step = np.linspace(0., HEIGHT, n + 1, retstep=True)
    stiffness, empty, full = (np.zeros((2 * n + 2, 2 * n + 2)) for _ in range(3))
    water, inertia = np.zeros(2 * n + 2), np.zeros(2 * n + 2)
    shapes = np.array([[1., 0., -3., 2.], [0., step, -2. * step, step], [0., 0., 3., -2.], [0., 0., -step, step]])
    points, weights = np.polynomial.legendre.leggauss(4)
    for cell in range(n):
        own = slice(2 * cell, 2 * cell + 4)
        for r, weight in zip((points + 1.) / 2., weights * step / 2.):
            shape, sloped, curved = (shapes @ powers for powers in (
                [1., r, r**2, r**3], np.array([0., 1., 2. * r, 3. * r**2]) / step, np.array([0., 0., 2., 6. * r]) / step**2))
            at = z[cell] + r * step
            one, depth, both = Arch(at, modulus), max(0., LEVEL - at), weight * np.outer(shape, shape)
            bending = modulus / 12. / (1. - NU**2) * np.sum(one.t**3 * one.across**2 * one.share)
            stiffness[own, own] += one.stiffness * both + weight * bending * np.outer(curved, curved)
            if twist:
                sheared = one.t**3 / 3. * one.slope**2 + one.t * one.along**2
                shear = modulus / 2. / (1. + NU) * np.sum(sheared * one.share)
                stiffness[own, own] += weight * shear * np.outer(sloped, sloped)
            mass = np.sum(CONCRETE * one.t * one.share * one.u**2)
            added = 7. / 8. * WATER * np.sqrt(LEVEL * depth) * np.sum(one.share * one.across**2)
            empty[own, own] += mass * both
            full[own, own] += (mass + added) * both
            water[own] -= weight * WATER * G * depth * np.sum(one.across * one.share) * shape
            pushed = 7. / 8. * WATER * np.sqrt(LEVEL * depth) * np.sum(one.share * one.across * one.normal[1])
            pushed += np.sum(CONCRETE * one.t * one.share * one.u[1])
            inertia[own] += weight * pushed * shape
    return z, stiffness, empty, full, water, inertia


def spectral(period):
    """Acceleration of the design spectrum [m/s2]."""
    rise = 1. + (PLATEAU - 1.) * period / 0.1
    return PEAK * min(rise, PLATEAU, PLATEAU * max(0.2, (CHARACTERISTIC / period)**DECAY))


def responses(stiffness, mass, inertia, n_modes=3):
    """Response of each mode to the spectrum: circular frequency squared, displacement of
    the crown at each elevation [m]."""
    omega2, shapes = eigh(stiffness, mass, subset_by_index=[0, n_modes - 1])
    spectra = [spectral(2. * np.pi / np.sqrt(one)) / one for one in omega2]
    return omega2, (shapes * (shapes.T @ inertia) * spectra)[::2].T


def push_on_left_bank(arches, elevation, u):
    """Push of the arches above the block, for a displacement of the crown [N]."""
    above = elevation >= ELEVATION
    return np.trapz(np.array([one.on_left_bank for one in arches])[above] * u[above, None], elevation[above], axis=0)


def least_safety(static, thrust):
    """Factor of safety of the block under its static force, the thrust of the first mode and
    its own inertia across and along the river and upwards, of either sign: one in full, the
    others with 40 %."""
    parts = [np.array([*thrust, 0.]), *np.diag(DENSITY * VOLUME * np.array([PEAK, PEAK, VERTICAL]))]
    forces = [static + sum(sign * (1. if i == whole else 0.4) * part for i, (sign, part) in enumerate(zip(signs, parts)))
              for whole in range(4) for signs in itertools.product((-1., 1.), repeat=4)]
    return np.min([safety(force)[:2] for force in forces], axis=0)


def safety(force):
    """Factor of safety of the block that slides along the line of base plane and lateral
    plane, without and with the cohesion of the latter, and the driving force [N]."""
    line = np.cross(*NORMALS)
    line *= np.sign(line @ force) / np.linalg.norm(line)
    drives = line @ force
    normal = np.linalg.solve(np.array([*NORMALS, line]).T, drives * line - force)[:2]
    return [(FRICTION * normal.sum() + COHESION * area) / drives for area in (BOTTOM, BOTTOM + SIDE)] + [drives]


def spectrum_of_modes(folder):
    """Displacement [m] and acceleration [m/s2] of the crest along the river by the
    natural modes of a run, in the directions x, y, z of the earthquake."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(folder / "modes.vtu"))
    reader.Update()
    points, arrays = reader.GetOutput().GetPoints(), reader.GetOutput().GetPointData()
    crest = np.argmin(np.linalg.norm(vtk_to_numpy(points.GetData()) - (1., -4., HEIGHT), axis=1))
    shapes = {arrays.GetArrayName(i): arrays.GetArray(i) for i in range(arrays.GetNumberOfArrays())}
    motions = []
    for number, mode in enumerate(json.loads((folder / "summary.json").read_text())["modes"]["modes"], 1):
        shape = next(values for name, values in shapes.items() if name.startswith(f"mode {number} "))
        factors = np.array(mode["participation factors"]) * vtk_to_numpy(shape)[crest, 1]
        acceleration = factors * spectral(mode["period [s]"]) * [1., 1., VERTICAL / PEAK]
        print(f"  mode of {mode['frequency [Hz]']:.2f} Hz, {factors[1]:.2f} times the spectrum at the crest")
        motions.append([acceleration * (mode["period [s]"] / 2. / np.pi)**2, acceleration])
    return np.linalg.norm(motions, axis=(0, 2))


def volume(line):
    """Volume of an arch, one metre high, cell by cell."""
    x, y, t = line
    return np.hypot(np.diff(x), np.diff(y)) * (t[1:] + t[:-1]) / 2.


def main():
    z = np.linspace(0., HEIGHT, 301)
    lines = [arch(at) for at in z]
    whole = np.trapz([volume(line).sum() for line in lines], z)
    print(f"volume {whole:.0f} m3, weight {1e-6 * CONCRETE * G * whole:.0f} MN")
    # the abutments are vertical planes, normal to the crest
    chord = [sum(abs(x[i]) + t[i] / 2. * np.sin(np.arctan(abs(x[i]) / ARCHES[-1, radius])) for i, radius in ((0, 5), (-1, 6)))
             for x, y, t in lines]
    print(f"thrust {1e-6 * np.trapz(WATER * G * np.maximum(0., LEVEL - z) * chord, z):.0f} MN")
    face, crown = table(z).T[:2]
    middle = face - crown / 2.
    above = z >= 5.  # the middle of the lowest cells
    crown, middle = crown[above], middle[above]
    normal, moment = (np.trapz(CONCRETE * G * crown * arm, z[above]) for arm in (1., middle - middle[0]))
    for side, sign in (("upstream", -1.), ("downstream", 1.)):
        stress = -normal / crown[0] + sign * 6. * moment / crown[0]**2
        print(f"free-standing crown 5 m above its {side} foot: {1e-6 * stress:.2f} MPa")

    # the dam stands on the block left of its foot at the elevation of the block
    foot = table(ELEVATION)[7]
    stands = np.trapz([volume(line)[line[0][1:] > foot].sum() for line in lines], z)
    weight = -G * (DENSITY * VOLUME + CONCRETE * stands)
    for twist in (False, True):
        print(f"with{'' if twist else 'out'} twist and shear between arches:")
        elevation, stiffness, _, _, water, _ = dam(STATIC, twist)
        u = np.linalg.solve(stiffness, water)[::2]
        arches = [Arch(at, STATIC) for at in elevation]
        thrust = np.array([one.thrust for one in arches]) * u
        for at in (50., 100., 150.):
            i = np.argmin(abs(elevation - at))
            print(f"  crown at {at:.0f} m: {1e3 * u[i]:.1f} mm, arch stress {-1e-6 * thrust[i] / table(at)[1]:.2f} MPa")
        print(f"  thrust through the crown {1e-6 * np.trapz(thrust, elevation):.0f} MN")
        force = np.array([*push_on_left_bank(arches, elevation, u), weight])
        print("  on the block [MN]:", *(f"{1e-6 * part:.0f}" for part in force), "and safety {:.2f} to {:.2f}".format(*safety(force)))
        _, stiffness, empty, full, _, inertia = dam(DYNAMIC, twist)
        for name, mass in (("empty", empty), ("with added mass", full)):
            omega2 = eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, 0])
            print(f"  first mode, {name}: {np.sqrt(omega2[0]) / 2. / np.pi:.2f} Hz")
        omega2, modes = responses(stiffness, full, inertia)
        crest = modes[:, -1]
        for square, moved in zip(omega2, crest):
            period = 2. * np.pi / np.sqrt(square)
            print(f"  mode of {1. / period:.2f} Hz, {square * moved / spectral(period):.2f} times the spectrum at the crest:"
                  f" {1e3 * moved:.1f} mm, {square * moved:.2f} m/s2")
        print(f"  crest in the earthquake {1e3 * np.linalg.norm(crest):.1f} mm, {np.linalg.norm(omega2 * crest):.2f} m/s2")
        thrust = push_on_left_bank([Arch(at, DYNAMIC) for at in elevation], elevation, modes[0])
        for name, static in (("own", force), ("the program's", PROGRAM)):
            print(f"  safety of the block in the earthquake, with {name} static force {{:.2f}} to {{:.2f}}".format(
                *least_safety(static, thrust)))
    print("safety by the program's force {:.2f} to {:.2f}, of which {:.4g} N drive".format(*safety(PROGRAM)))
    if len(sys.argv) > 1:
        print("natural modes of the run:")
        moved, acceleration = spectrum_of_modes(pathlib.Path(sys.argv[1]))
        print(f"  crest in the earthquake {1e3 * moved:.1f} mm, {acceleration:.2f} m/s2")


if __name__ == "__main__":
    main()
