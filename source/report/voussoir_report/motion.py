"""Measures of an earthquake record."""

import numpy as np

GRAVITY = 9.81  # the value of the program [m/s2]
ROUND_PERIODS = np.array([0.1, 0.2, 0.5, 1., 2.])  # [s]
PERIODS = np.unique(np.concatenate([np.geomspace(0.03, 4., 120), ROUND_PERIODS]))


def integral(values, time_step):
    """Integral over time from the first sample on, by trapezoids."""
    return np.concatenate([[0.], np.cumsum(0.5 * time_step * (values[1:] + values[:-1]))])


def arias_intensity(acceleration, time_step):
    """pi/2g int a^2 dt [m/s] up to each sample, of accelerations [m/s2] (Arias 1970)."""
    return np.pi / (2. * GRAVITY) * integral(acceleration**2, time_step)


def significant_duration(acceleration, time_step, first=0.05, last=0.95):
    """Times at which the Arias intensity reaches these shares of its final value [s]."""
    intensity = arias_intensity(acceleration, time_step)
    times = time_step * np.arange(len(intensity))
    share = intensity / intensity[-1]
    return tuple(np.interp((first, last), share, times))


def response_spectrum(accelerations, time_step, periods=PERIODS, damping=0.05):
    """Pseudo-acceleration [m/s2] of oscillators at these periods [s].

    Takes records of shape (..., samples) and returns (..., periods). For an
    acceleration that is linear between samples each step is exact (Nigam and
    Jennings 1969): a particular solution plus a free oscillation. The record is followed
    by free motion for one longest period.
    """
    accelerations, periods = np.asarray(accelerations, float), np.asarray(periods, float)
    # steps so short that a maximum between two of them exceeds the larger value by 0.8 % at most
    parts = int(np.ceil(25. * time_step / periods.min()))
    h = time_step / parts
    n = accelerations.shape[-1]
    rest = int(np.ceil(periods.max() / h)) + 1
    a = np.zeros(((n - 1) * parts + 1 + rest,) + accelerations.shape[:-1])
    for index in np.ndindex(accelerations.shape[:-1]):
        a[(slice(-rest), *index)] = np.interp(np.arange((n - 1) * parts + 1) / parts,
                                              np.arange(n), accelerations[index])

    w = 2. * np.pi / periods
    wd = w * np.sqrt(1. - damping**2)
    decay = np.exp(-damping * w * h)
    cosine, sine = decay * np.cos(wd * h), decay * np.sin(wd * h)
    u = np.zeros(a.shape[1:] + w.shape)
    v, largest = np.zeros_like(u), np.zeros_like(u)
    for now, slope in zip(a[:-1, ..., None], np.diff(a, axis=0)[..., None] / h):
        dp = -slope / w**2
        p = -now / w**2 - 2. * damping / w * dp
        free = u - p
        c = (v - dp + damping * w * free) / wd
        u = p + dp * h + cosine * free + sine * c
        v = dp + cosine * (wd * c - damping * w * free) - sine * (wd * free + damping * w * c)
        np.maximum(largest, np.abs(u), out=largest)
    return w**2 * largest


def peak(time, values):
    """The value of largest magnitude, and its time."""
    at = np.argmax(np.abs(values))
    return values[at], time[at]
