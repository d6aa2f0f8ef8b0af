#!/usr/bin/env python3
"""Damped modes of the column of tests/stability/modal_*.prm, by another method: the
roots s of s^2 + a s + w0^2 M(s) = 0, in the complex plane. Under Maxwell damping
M = (1 + sum D s t / (1 + s t)) / S(f0), with D found by scipy from the definition: the
ratio Im M / 2 Re M is as constant as possible over the band. Prints damping ratio [%] and
frequency [Hz] of the free decay.
"""
import numpy as np
from scipy.optimize import fsolve, least_squares

RATIO, BAND, REFERENCE, BRANCHES = 0.05, (1.0, 20.0), 3.0, 3


def maxwell():
    times = 1 / (2 * np.pi * np.geomspace(*BAND, BRANCHES))

    def modulus(s, strengths):
        return 1 + sum(d * s * t / (1 + s * t) for d, t in zip(strengths, times))

    def off(strengths):
        m = modulus(2j * np.pi * np.geomspace(*BAND, 400), strengths)
        return m.imag / (2 * m.real) - RATIO

    strengths = least_squares(off, [RATIO] * BRANCHES, bounds=(0, np.inf), xtol=1e-14).x
    scale = modulus(2j * np.pi * REFERENCE, strengths).real
    return 0, lambda s: modulus(s, strengths) / scale


def rayleigh():
    a, b = 2 * np.pi * np.array(BAND)
    return 2 * RATIO * a * b / (a + b), lambda s: 1 + s * 2 * RATIO / (a + b)


def free_decay(frequency, mass_coefficient, modulus):
    natural = 2 * np.pi * frequency

    def rest(x):
        s = natural * complex(*x)
        value = (s * (s + mass_coefficient)) / natural**2 + modulus(s)
        return value.real, value.imag

    s = natural * complex(*fsolve(rest, [-RATIO, 1], xtol=1e-13))
    return -100 * s.real / abs(s), s.imag / (2 * np.pi)


if __name__ == "__main__":
    for damping in maxwell, rayleigh:
        print(damping.__name__)
        for frequency in 1, 3, 10, 20:
            print("  %g Hz: %.4f %%, %.5f Hz" % (frequency, *free_decay(frequency, *damping())))
