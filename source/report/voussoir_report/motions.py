"""Input motion, motion of points, and the energy balance."""

import functools
import re

import numpy as np

from . import charts, records
from .case import DIRECTIONS
from .files import refuse
from .motion import (GRAVITY, PERIODS, ROUND_PERIODS, arias_intensity, integral, peak, response_spectrum,
                     significant_duration)
from .page import Pictures, Section, Table, number

DAMPING = 0.05


class GroundMotion:
    """Accelerations [m/s2] by direction, at equal intervals [s]."""

    def __init__(self, table):
        self.time = table.time
        self.interval = (table.time[-1] - table.time[0]) / (len(table.time) - 1)
        if np.ptp(np.diff(self.time)) > 1e-3 * self.interval:
            refuse(table.file, "lacks lines or repeats them, as its times are not at equal intervals")
        self.acceleration = {match[1]: values for match, values
                             in table.matching(r"acceleration ([xyz]) \[m/s2\]")}

    @functools.cached_property
    def spectra(self):
        records = np.array(list(self.acceleration.values()))
        return dict(zip(self.acceleration, response_spectrum(records, self.interval,
                                                             damping=DAMPING)))


    def frequency_of_power(self, share):
        """The frequency below which this share of the power of all components lies [Hz]."""
        sums = np.cumsum(sum(np.abs(np.fft.rfft(a))**2 for a in self.acceleration.values()))
        return (np.fft.rfftfreq(len(self.time), self.interval)[np.searchsorted(sums, share * sums[-1])]
                if sums[-1] > 0. else None)


@functools.lru_cache(maxsize=None)
def ground_motion(run):
    """The ground motion of a run, or None."""
    table = run.table("ground_motion.csv")
    return GroundMotion(table) if table else None


def motion_measures(runs):
    """A table with a row for each run and direction."""
    rows = []
    for run in runs:
        motion = ground_motion(run)
        for direction, a in motion.acceleration.items():
            if not np.any(a):
                continue
            velocity = integral(a, motion.interval)
            first, last = significant_duration(a, motion.interval)
            rows.append([f"{run.prefix}{direction}, {DIRECTIONS[direction]}",
                         number(np.abs(a).max() / GRAVITY),
                         number(100. * np.abs(velocity).max()),
                         number(100. * np.abs(integral(velocity, motion.interval)).max()),
                         number(arias_intensity(a, motion.interval)[-1]),
                         number(last - first), f"{number(first)} to {number(last)}"])
    return Table(["direction", "peak acceleration [g]", "peak velocity [cm/s]",
                  "peak displacement [cm]", "Arias intensity [m/s]",
                  "significant duration 5–95 % [s]", "from, to [s]"], rows)


def spectrum_table(runs):
    """Spectral values at round periods; a row for each run and direction."""
    rows = []
    for run in runs:
        for direction, spectrum in ground_motion(run).spectra.items():
            values = spectrum[np.isin(PERIODS, ROUND_PERIODS)] / GRAVITY
            rows.append([f"{run.prefix}{direction}, {DIRECTIONS[direction]}",
                         *(number(value) for value in values)])
    return Table([f"pseudo-acceleration at {100. * DAMPING:g} % damping [g]",
                  *(f"{period:g} s" for period in ROUND_PERIODS)], rows)


def draw_targets(axes, runs, direction):
    """Draws the target spectra of artificial motions, dashed."""
    for run in runs:
        target = run.summary.get("target spectrum", {})
        if f"{direction} [m/s2]" in target:
            axes.plot(target["periods [s]"], np.array(target[f"{direction} [m/s2]"]) / GRAVITY,
                      color=f"C{run.place % 10}", linestyle="--",
                      label=f"{run.prefix}target, {100. * target['damping ratio']:g} %")


def input_section(runs):
    runs = [run for run in runs if ground_motion(run)]
    if not runs:
        return None
    pictures = []
    for direction in DIRECTIONS:
        moved = [run for run in runs if direction in ground_motion(run).acceleration]
        if not moved:
            continue
        figure, axes = charts.new_figure()
        charts.lines_of_runs(axes, [(run, ground_motion(run).time,
                                     ground_motion(run).acceleration[direction] / GRAVITY)
                                    for run in moved],
                             f"{direction}, {DIRECTIONS[direction]}", "time [s]", "acceleration [g]", zero=True)
        pictures.append(charts.picture(figure, f"Input acceleration {direction}", f"input_{direction}"))
        figure, axes = charts.new_figure()
        draw_targets(axes, moved, direction)
        curves = [(run, PERIODS, ground_motion(run).spectra[direction] / GRAVITY) for run in moved]
        charts.lines_of_runs(axes, curves,
                             f"{direction}, {DIRECTIONS[direction]}, {100. * DAMPING:g} % damping",
                             "period [s]", "pseudo-acceleration [g]")
        axes.set_xscale("log")
        axes.set_xticks([0.03, 0.1, 0.3, 1., 3.], ["0.03", "0.1", "0.3", "1", "3"])
        axes.set_ylim(bottom=0.)
        pictures.append(charts.picture(figure, f"Response spectrum {direction}", f"spectrum_{direction}"))
    given = {run.entry("Ground motion/Given at") for run in runs}
    text = (f"The scaled motion, given at the {' or '.join(sorted(given))}, up to the end of the run. "
            "Arias intensity is π/2g ∫a²dt; the significant duration is "
            "the time between 5 and 95 % of it.")
    parts = [records.sources_table(runs), text, motion_measures(runs),
             records.correlation_table(runs, ground_motion), spectrum_table(runs), Pictures(pictures)]
    return Section("Input motion", [part for part in parts if part])


def column(run, point, quantity, direction):
    """Values of a column of histories.csv and the text "relative to ..." of its title, or None."""
    table = run.table("histories.csv")
    found = table.matching(rf"{re.escape(point)} {quantity} {direction}( relative to .*)? \[.*\]")
    return (found[0][1], found[0][0][1] or "") if found else None


def points_of(run):
    """Names of the points of histories.csv that move."""
    table = run.table("histories.csv")
    if table is None:
        return []
    names = dict.fromkeys(match[1] for match, values in table.matching(
        r"(.*) (?:displacement|velocity|acceleration) [xyz].*") if np.any(values))
    return [name for name in names if not name.endswith(" filtered")]


def displacement_of(run, point, direction):
    return column(run, point, "displacement", direction)


def acceleration_of(run, point, direction):
    """An acceleration filtered at the frequency that the mesh carries, as column()."""
    return column(run, point, "filtered acceleration", direction)


def amplification_table(runs):
    """A table of peaks of absolute accelerations and their ratios to those of the input."""
    moving = [run for run in runs if ground_motion(run)]
    directions = [d for d in DIRECTIONS if any(d in ground_motion(run).acceleration for run in moving)]

    def cell(run, point, direction):
        ground = ground_motion(run).acceleration.get(direction)
        largest = absolute_peak(run, point, direction)
        if ground is None or largest is None:
            return "–"
        return f"{number(largest / GRAVITY)} g, {number(largest / np.abs(ground).max())}"

    rows = [[f"{run.prefix}{point}", *(cell(run, point, d) for d in directions)]
            for run in moving for point in points_of(run)]
    rows = [row for row in rows if set(row[1:]) != {"–"}]
    return Table(["point", *(f"{d}, {DIRECTIONS[d]}" for d in directions)], rows,
                 "Peak of the absolute acceleration, and its ratio to the peak of the input motion.") if rows else None


def absolute_peak(run, point, direction):
    """Peak of the absolute acceleration of a point [m/s2], or None if only the relative one is known."""
    found = acceleration_of(run, point, direction)
    if not found:
        return None
    values, relative = found
    if relative:
        base = acceleration_of(run, relative[len(" relative to "):], direction)
        if not base or base[1] or not np.any(base[0]):
            return None
        values = values + base[0]
    return np.abs(values).max()


def single_steps_of(run, point, direction):
    """An acceleration of single steps, for a run without the filtered one."""
    return (None if acceleration_of(run, point, direction)
            else column(run, point, "acceleration", direction))


# quantity, factor to its unit, its unit, function that reads it
MOTIONS = (("displacement", 100., "cm", displacement_of),
           ("acceleration", 1. / GRAVITY, "g", acceleration_of),
           ("single-step acceleration", 1. / GRAVITY, "g", single_steps_of))


def motion_picture(runs, point, direction, quantity, factor, unit, read):
    """A picture of a history in all runs, or None if all values are round-off."""
    found = [(run, read(run, point, direction)) for run in runs if point in points_of(run)]
    found = [(run, *values) for run, values in found if values]
    if max((np.abs(values).max() for _, values, _ in found), default=0.) < 1e-9:
        return None
    figure, axes = charts.new_figure(2.5)
    charts.lines_of_runs(axes, [(run, run.table("histories.csv").time, factor * values)
                                for run, values, _ in found],
                         f"{point}, {direction} ({DIRECTIONS[direction]}){found[0][2]}", "time [s]",
                         f"{quantity} [{unit}]", zero=True)
    return charts.picture(figure, f"{point}: {quantity} {direction}", f"{point}_{quantity}_{direction}")


def motion_section(runs):
    names = dict.fromkeys(point for run in runs for point in points_of(run))
    pictures = [motion_picture(runs, point, direction, *motion)
                for point in names for direction in DIRECTIONS for motion in MOTIONS]
    pictures = [picture for picture in pictures if picture]
    if not pictures:
        return None
    carried = {values["filtered at [Hz]"] for run in runs
               for values in run.summary.get("histories", {}).values()}
    at_rest = any(run.list("Static state/Stages", ";") for run in runs)
    text = (("Displacements include those of the static state. " if at_rest else "")
            + "Accelerations are filtered at the highest frequency that the mesh carries "
            f"({' or '.join(number(f) for f in sorted(carried))} Hz); those of single steps are not, "
            "and show the pounding of cracks and joints.")
    return Section("Motion of the crest and other points",
                   [part for part in (text, amplification_table(runs), Pictures(pictures)) if part])


# column of energy.csv, sign, label
ENERGIES = (("kinetic [J]", 1., "kinetic"), ("strain [J]", 1., "strain"),
            ("damping [J]", 1., "lost in damping"), ("material [J]", 1., "lost in cracks and plastic flow"),
            ("closing cracks [J]", 1., "lost by closing cracks"),
            ("constraints [J]", -1., "lost in joints"))


def energy_picture(run):
    table = run.table("energy.csv")
    entered = table["input [J]"] - table["boundary [J]"]
    largest = max(np.abs(entered).max(), table["kinetic [J]"].max(), 1e-30)
    power, unit = next((power, unit) for power, unit in ((1e9, "GJ"), (1e6, "MJ"), (1e3, "kJ"), (1., "J"))
                       if largest >= power or power == 1.)
    figure, axes = charts.new_figure(3.1)
    curves = [("input less radiation", table.time, entered / power)]
    curves += [(what, table.time, sign * table[name] / power) for name, sign, what in ENERGIES
               if np.abs(table[name]).max() > 1e-4 * largest]
    charts.lines(axes, curves, run.title_in_chart, "time [s]", f"energy [{unit}]", zero=True)
    return charts.picture(figure, f"{run.prefix}Energies over time", f"energy_{run.label}")


def energy_section(runs):
    runs = [run for run in runs if run.table("energy.csv")]
    if not runs:
        return None
    text = ("Input less radiation is the work of the earthquake less the energy radiated through "
            "the absorbing boundary; at each time it equals the sum of the other curves and of a small "
            "part stored in the damping.")
    return Section("Energy balance", [text, Pictures([energy_picture(run) for run in runs],
                                                     min(len(runs), 3))])
