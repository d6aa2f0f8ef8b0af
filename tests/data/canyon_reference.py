#!/usr/bin/env python3
"""Amplitudes along a semi-circular canyon in a half-space under plane SH waves: the
exact series of Trifunac (1973), for tests/waves/*canyon_sh_*.prm.

Lengths over the canyon's radius, e^(-i w t); r, phi from the canyon's centre, phi from
the horizontal direction in which the wave travels, downwards; a from there to the
direction of the wave. The wave and its reflection from the surface, with e_0 = 1,
e_n = 2,
    2 e^(i k r cos phi cos a) cos(k r sin phi sin a) = 2 sum e_n i^n J_n(k r) cos(n a) cos(n phi) ,
leave no traction on the surface; each term has an outgoing wave that cancels its
traction on the canyon, - J_n'(k) / H_n'(k) H_n(k r) cos(n phi). eta is the canyon's
width over the wavelength, k = pi eta.

usage: canyon_reference.py                       the amplitudes of the tests
       canyon_reference.py --check               the series against what must hold
       canyon_reference.py RUN... --angle A...   beside runs of doc/published/canyon.prm
                           [--picture FILE]
"""
import argparse

import numpy as np
from scipy.special import h1vp, hankel1, jvp

ETAS = 0.5, 1, 2
PLACES = np.array([-3, -2, -1.5, -1, -0.7, -0.4, 0, 0.4, 0.7, 1, 1.5, 2, 3])  # along the surface


def plane_waves(k, a, x, y):
    return 2 * np.exp(1j * k * x * np.cos(a)) * np.cos(k * y * np.sin(a))


def canyon(eta, angle, r, phi):
    """Displacement per unit incident displacement; angle to the vertical [degrees]."""
    k, a = np.pi * eta, np.radians(90 - angle)
    u = plane_waves(k, a, r * np.cos(phi), r * np.sin(phi))
    for n in range(60):
        factor = -2 * (2 if n > 0 else 1) * 1j**n * np.cos(n * a)
        u = u + factor * jvp(n, k) / h1vp(n, k) * hankel1(n, k * r) * np.cos(n * phi)
    return u


def along(place):
    """r and phi on the surface, or below it on the canyon."""
    place = np.asarray(place, float)
    return np.maximum(abs(place), 1), np.arccos(np.clip(place, -1, 1))


def by_sources(eta, angle, r, phi):
    """The same by another method: sources within the canyon, each with its mirror
    image, with the strengths that cancel the traction at points of the canyon."""
    k, a = np.pi * eta, np.radians(90 - angle)
    at, of = np.linspace(0, np.pi, 241), np.linspace(0, np.pi, 122)[1:-1]
    x, y = np.cos(at), np.sin(at)
    outwards = 1j * k * np.cos(a) * x * plane_waves(k, a, x, y) - 2 * k * np.sin(a) * y * np.exp(
        1j * k * x * np.cos(a)
    ) * np.sin(k * y * np.sin(a))

    def fields(x, y, order):
        total = 0
        for image in 1, -1:
            dx, dy = x[:, None] - 0.7 * np.cos(of), y[:, None] - image * 0.7 * np.sin(of)
            d = np.hypot(dx, dy)
            total = total + (hankel1(0, k * d) if order == 0 else -k * hankel1(1, k * d) * (dx * x[:, None] + dy * y[:, None]) / d)
        return total

    strengths = np.linalg.lstsq(fields(x, y, 1), -outwards, rcond=1e-13)[0]
    x, y = r * np.cos(phi), r * np.sin(phi)
    return plane_waves(k, a, x, y) + fields(x, y, 0) @ strengths


def check():
    everywhere, wall, h = along(np.linspace(-4, 4, 81)), np.linspace(0, np.pi, 100), 1e-4
    for eta in ETAS:
        for angle in 0, 30, 60:
            other = abs(by_sources(eta, angle, *everywhere) - canyon(eta, angle, *everywhere)).max()
            traction = (canyon(eta, angle, 1 + h, wall) - canyon(eta, angle, 1 - h, wall)) / (2 * h * np.pi * eta)
            print(f"eta {eta}, {angle} degrees: off the solution by sources {other:.0e}, traction left {abs(traction).max():.0e}")
    print("flat ground, 2: long waves", *(f"{abs(canyon(1e-3, 30, *along(p))):.4f}" for p in (-2, 0, 2)))
    print("2 far away, beside the wave and before it:", *(f"{abs(canyon(1, g, 1e4, p)):.3f}" for g, p in ((0, 0.0), (30, 0.0), (60, np.pi))))
    # reciprocity of scattered waves in the far field: from angle a, seen at b, as from b, seen at a
    far = lambda a, b: canyon(1, a, 1e5, np.radians(90 - b)) - plane_waves(np.pi, np.radians(90 - a), *(1e5 * f(np.radians(90 - b)) for f in (np.cos, np.sin)))
    print(f"far away at 20 degrees of a wave of 50 over the opposite: {far(50, 20) / far(-20, -50):.6f}")


def amplitudes_of(run, *directions):
    """Amplitudes of these directions (0: x) at the points of PLACES [2.5, 5, 10 Hz],
    over that of the wave."""
    table = np.genfromtxt(f"{run}/histories.csv", delimiter=",", skip_header=1)
    motion = np.genfromtxt(f"{run}/ground_motion.csv", delimiter=",", skip_header=1)
    result = []
    for eta in ETAS:
        w = 2 * np.pi * 5 * eta
        transform = lambda t, f: (f.T * np.exp(-1j * w * t)).sum(axis=-1) * (t[1] - t[0])
        incident = transform(motion[:, 0], motion[:, 1]) / -(w**2)
        result.append([abs(transform(table[:, 0], table[:, 1 + d::3]) / incident) for d in directions])
    return result


def draw(runs, names, largest, file, panel):
    """panel(axis, number of the run, eta, number of eta) draws into a panel."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(len(ETAS), len(runs), figsize=(9, 6), sharex=True, sharey=True, squeeze=False)
    for k, (column, name) in enumerate(zip(axes.T, names)):
        for i, (axis, eta) in enumerate(zip(column, ETAS)):
            panel(axis, k, eta, i)
            axis.text(0.03, 0.9, f"η = {eta}, {name}", transform=axis.transAxes, fontsize=9)
            axis.grid(alpha=0.3)
    axes[0, 0].legend(fontsize=8, loc="upper right")
    axes[0, 0].set_ylim(0, largest)
    figure.supxlabel("place over the canyon's radius; the wave travels to the right", fontsize=9)
    figure.supylabel("amplitude over that of the wave", fontsize=9)
    figure.tight_layout()
    figure.savefig(file, dpi=90)


def draw_runs(runs, angles, file):
    x = np.linspace(-3, 3, 601)
    found = [amplitudes_of(run, 0) for run in runs]

    def panel(axis, k, eta, i):
        axis.plot(x, abs(canyon(eta, angles[k], *along(x))), "k", linewidth=0.8, label="series")
        axis.plot(PLACES, found[k][i][0], "o", markersize=4, markerfacecolor="none", color="C3", label="Voussoir")
    draw(runs, [f"{angle:g}°" for angle in angles], 4.4, file, panel)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="*")
    parser.add_argument("--angle", type=float, nargs="+", default=[0, 30, 60])
    parser.add_argument("--picture")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    if options.check:
        check()
    elif not options.runs:
        for angle in options.angle:
            rows = (", ".join(f"{abs(u):.4f}" for u in canyon(eta, angle, *along(PLACES))) for eta in ETAS)
            print(f"{angle:g} degrees:", "; ".join(rows), sep="\n")
    for run, angle in zip(options.runs, options.angle):
        for eta, (found,) in zip(ETAS, amplitudes_of(run, 0)):
            exact = abs(canyon(eta, angle, *along(PLACES)))
            print(f"{run}, {angle:g} degrees, eta {eta}:")
            for line in zip(PLACES, exact, found, 100 * (found / exact - 1)):
                print("%6.1f %8.4f %8.4f %7.2f %%" % line)
    if options.picture:
        draw_runs(options.runs, options.angle, options.picture)


if __name__ == "__main__":
    main()
