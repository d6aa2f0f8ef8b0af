#!/usr/bin/env python3
"""Amplitudes along a semi-circular canyon in a half-space under plane P and SV waves, for
tests/waves/canyon_p_*.prm and canyon_sv_*.prm: by sources within the canyon.

Lengths over the canyon's radius, e^(-i w t), x along the surface, z downwards. With the
potentials phi and psi, u = (phi_x - psi_z, phi_z + psi_x). Of a rising plane wave
e^(i k x - i nu z) the surface reflects, with g = 2 k^2 - ks^2, R = g^2 + 4 k^2 nu_p nu_s,
    of phi: (4 k^2 nu_p nu_s - g^2) / R phi and 4 k nu_p g / R psi ,
    of psi: - 4 k nu_s g / R phi and (4 k^2 nu_p nu_s - g^2) / R psi .
A source H_0(k_p d) or H_0(k_s d) at some depth is an integral of such waves over k, on a
path that passes below the poles at k > 0, above those at k < 0. Sources within the
canyon have the strengths that cancel the traction on its wall. eta is the canyon's
width over the length of S waves, ks = pi eta; kp = ks / sqrt(3), as Poisson's ratio is
1/4.

usage: canyon_in_plane_reference.py              the amplitudes of the tests
       canyon_in_plane_reference.py --check      the solution against what must hold
       canyon_in_plane_reference.py RUN... --wave P --angle A...   beside runs
                                    [--picture FILE]
"""
import argparse

import numpy as np
from scipy.special import hankel1

from canyon_reference import ETAS, PLACES, amplitudes_of, draw


class HalfSpace:
    def __init__(self, eta):
        self.ks = np.pi * eta
        self.kp = self.ks / np.sqrt(3)

    def nu(self, k):
        """Vertical wave numbers of P and S."""
        return np.sqrt(self.kp**2 - k**2 + 0j), np.sqrt(self.ks**2 - k**2 + 0j)

    def thrown_back(self, k, wave):
        """Reflected potentials phi and psi per unit potential of a rising wave."""
        p, s = self.nu(k)
        g = 2 * k**2 - self.ks**2
        r = g**2 + 4 * k**2 * p * s
        same = (4 * k**2 * p * s - g**2) / r
        return (same, 4 * k * p * g / r) if wave == "P" else (-4 * k * s * g / r, same)

    def fields(self, phi, psi):
        """Displacements x, z, stresses xx, xz, zz over the shear modulus from the
        potentials: functions of the orders of their derivatives by x and z."""
        less = self.ks**2 - 2 * self.kp**2
        return np.array([
            phi(1, 0) - psi(0, 1),
            phi(0, 1) + psi(1, 0),
            2 * phi(2, 0) - 2 * psi(1, 1) - less * phi(0, 0),
            2 * phi(1, 1) - psi(0, 2) + psi(2, 0),
            2 * phi(0, 2) + 2 * psi(1, 1) - less * phi(0, 0),
        ])

    def plane_waves(self, wave, angle, x, z):
        """A wave of unit displacement and its reflection from flat ground."""
        own = self.kp if wave == "P" else self.ks
        k = own * np.sin(np.radians(angle))
        p, s = self.nu(k)

        def plane(factor, nu):
            return lambda i, j: factor / (1j * own) * (1j * k)**i * (1j * nu)**j * np.exp(1j * (k * x + nu * z))
        def nothing(i, j):
            return 0 * x
        a, b = self.thrown_back(k, wave)
        rising = (plane(1, -p), nothing) if wave == "P" else (nothing, plane(1, -s))
        return self.fields(*rising) + self.fields(plane(a, p), plane(b, s))

    def sources(self, x, z, at):
        """Fields at points of unit sources phi, then psi, at places."""
        away, fine, coarse = 0.3, 0.05, 0.5
        # steps that grow beyond the poles, up to where the shallowest source vanishes
        wide = 2 * self.ks / fine
        s = np.arange(-1, 1 + 1e-9, 1 / np.ceil((12 / min(at[:, 1]) + 4 * wide * coarse) / coarse))
        s *= len(s) // 2
        t = coarse * s - (coarse - fine) * wide * np.arctan(s / wide)
        dip = 1j * away / self.ks * np.exp(0.5 - 0.5 * (t / self.ks)**2)
        k = t - dip * t
        weight = (fine + (coarse - fine) * s**2 / (s**2 + wide**2)) * (1 - dip * (1 - (t / self.ks)**2)) / np.pi
        nu = self.nu(k)
        dx, dz = (p[:, None] - at[:, i] for i, p in enumerate((x, z)))
        result = []
        for wave, number in ("P", self.kp), ("SV", self.ks):
            def direct(i, j, number=number):
                return derivative(number, dx, dz, i, j)
            def nothing(i, j):
                return 0 * dx
            field = self.fields(*((direct, nothing) if wave == "P" else (nothing, direct)))
            mine = nu[0] if wave == "P" else nu[1]
            rising = weight / mine * np.exp(1j * (-at[:, :1] * k + at[:, 1:] * mine))

            def reflected(factor, own):
                there = np.exp(1j * (x[:, None] * k + z[:, None] * own))
                return lambda i, j: (there * (1j * k)**i * (1j * own)**j * factor) @ rising.T
            a, b = self.thrown_back(k, wave)
            result.append(field + self.fields(reflected(a, nu[0]), reflected(b, nu[1])))
        return np.concatenate(result, axis=-1)


def derivative(number, dx, dz, i, j):
    """Derivatives of H_0(number d) by x and z."""
    d = np.hypot(dx, dz)
    first = -number * hankel1(1, number * d)
    second = -number**2 * hankel1(0, number * d) - first / d
    if i + j == 0:
        return hankel1(0, number * d)
    if i + j == 1:
        return first * (dx if i else dz) / d
    of = {(2, 0): (dx * dx, dz * dz), (0, 2): (dz * dz, dx * dx), (1, 1): (dx * dz, -dx * dz)}[i, j]
    return (second * of[0] + first / d * of[1]) / d**2


def graded(n, first):
    """Angles along the canyon, closer to each other near its edges."""
    most = np.log(np.pi / first - 1)
    return np.pi / (1 + np.exp(np.linspace(-most, most, n)))


def canyon(eta, wave, angle, x, z, n=60, deep=0.7):
    """Displacements and stresses per unit displacement of the incident wave, and the
    remaining traction on the canyon, root mean square, over that of the wave."""
    space = HalfSpace(eta)
    of, on = graded(n, 0.03), graded(3 * n, 0.005)
    at = (1 - deep * np.sin(of))[:, None] * np.transpose([np.cos(of), np.sin(of)])
    normal = np.cos(on), np.sin(on)

    def traction(f):  # weighted by the root of the length that a point represents
        n = [(c * np.sqrt(on * (np.pi - on))).reshape((-1,) + (1,) * (f.ndim - 2)) for c in normal]
        return np.concatenate([f[2] * n[0] + f[3] * n[1], f[3] * n[0] + f[4] * n[1]])
    matrix = traction(space.sources(*normal, at))
    given = traction(space.plane_waves(wave, angle, *normal))
    size = np.linalg.norm(matrix, axis=0)
    strengths = np.linalg.lstsq(matrix / size, -given, rcond=1e-12)[0] / size
    left = np.linalg.norm(matrix @ strengths + given) / np.linalg.norm(given)
    return space.plane_waves(wave, angle, x, z) + space.sources(x, z, at) @ strengths, left


def along(place):
    """x and z on the surface, or below it on the canyon."""
    place = np.asarray(place, float)
    return place, np.sqrt(np.maximum(0, 1 - place**2))


def amplitudes(eta, wave, angle, places=PLACES):
    return abs(canyon(eta, wave, angle, *along(places))[0][:2])


def check():
    x, z, h = np.array([-2.0, 0.3, 1.7]), np.array([0.5, 1.4, 0.2]), 1e-3
    for wave in "P", "SV":
        for eta in ETAS:
            for angle in 0, 30:
                field, left = canyon(eta, wave, angle, *along(PLACES))
                other = canyon(eta, wave, angle, *along(PLACES), 50, 0.6)[0]
                top = canyon(eta, wave, angle, np.linspace(1, 4, 31), np.zeros(31))[0]
                print(f"{wave}, eta {eta}, {angle} degrees: traction left on the canyon {left:.0e}, on the surface "
                      f"{abs(top[3:]).max() / eta:.0e}, off that of other sources {abs(field - other)[:2].max():.0e}")
        around = [[canyon(1, wave, 30, x + i * h, z + j * h)[0] for j in (-1, 0, 1)] for i in (-1, 0, 1)]
        by_x, by_z = (around[2][1] - around[0][1]) / (2 * h), (around[1][2] - around[1][0]) / (2 * h)
        momentum = np.array([by_x[2] + by_z[3], by_x[3] + by_z[4]]) + np.pi**2 * around[1][1][:2]
        stress = np.array([3 * by_x[0] + by_z[1], by_x[1] + by_z[0], by_x[0] + 3 * by_z[1]]) - around[1][1][2:]
        print(f"{wave}: momentum {abs(momentum).max():.0e}, stress from strain {abs(stress).max():.0e}")
    print("flat ground under a long SV wave: 2 =", *(f"{a:.4f}" for a in amplitudes(0.02, "SV", 0, np.array([-3.0, 0.0]))[0]))


def draw_runs(runs, waves, angles, file):
    x = np.linspace(-3, 3, 121)
    found = [amplitudes_of(run, 1, 2) for run in runs]

    def panel(axis, k, eta, i):
        for d, color in (0, "C3"), (1, "C0"):
            axis.plot(x, amplitudes(eta, waves[k], angles[k], x)[d], "k", linewidth=0.8)
            axis.plot(PLACES, found[k][i][d], "o", markersize=4, markerfacecolor="none", color=color,
                      label=("level", "upright")[d])
    draw(runs, [f"{wave}, {angle:g}°" for wave, angle in zip(waves, angles)], 4, file, panel)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="*")
    parser.add_argument("--wave", nargs="+", default=["P", "SV"], choices=["P", "SV"])
    parser.add_argument("--angle", type=float, nargs="+", default=[30, 0])
    parser.add_argument("--picture")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    if options.check:
        check()
    elif not options.runs:
        for wave, angle in zip(options.wave, options.angle):
            found = [amplitudes(eta, wave, angle) for eta in ETAS]
            rows = (", ".join(f"{u:.4f}" for u in of_eta[d]) for d in (0, 1) for of_eta in found)
            print(f"{wave}, {angle:g} degrees:", "; ".join(rows), sep="\n")
    for run, wave, angle in zip(options.runs, options.wave, options.angle):
        for eta, found in zip(ETAS, amplitudes_of(run, 1, 2)):  # horizontal, vertical
            exact = amplitudes(eta, wave, angle)
            print(f"{run}, {wave}, {angle:g} degrees, eta {eta}: largest difference, level and upright, over 2: "
                  + ", ".join(f"{50 * abs(f - e).max():.2f} %" for f, e in zip(found, exact)))
            for line in zip(PLACES, exact[0], found[0], exact[1], found[1]):
                print("%6.1f %9.4f %8.4f %9.4f %8.4f" % line)
    if options.picture:
        draw_runs(options.runs, options.wave, options.angle, options.picture)


if __name__ == "__main__":
    main()
