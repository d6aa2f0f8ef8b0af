"""Evaluations of a study: convergence, fragility, sensitivity, calibration."""

import math

import numpy as np

from . import charts
from .files import NUMBER, NUMBER_OR_NONE, TEXT, Group
from .page import Pictures, Table, number

MOST = 30  # lines of a table of sensitivities

CONVERGENCE = [Group({"quantity": TEXT, "coarse": NUMBER, "middle": NUMBER, "fine": NUMBER,
                      "observed order": NUMBER_OR_NONE, "extrapolated": NUMBER_OR_NONE,
                      "band about the fine one": NUMBER_OR_NONE, "verdict": TEXT})]
FRAGILITY = Group({"intensity": TEXT, "criterion": TEXT, "confidence": NUMBER, "levels": [
    Group({"intensity": NUMBER, "runs": NUMBER, "criterion met": NUMBER, "verdict": TEXT,
           **{f"{name}{end}": NUMBER_OR_NONE for name in ("median", "dispersion")
              for end in ("", " from", " to")}})]})
SENSITIVITY = Group({"change": NUMBER, "numbers": [
    Group({"number": TEXT, "value": NUMBER, "quantity": TEXT, "as given": NUMBER,
           "largest change [%]": NUMBER, "change over that of the number": NUMBER})]})
CALIBRATION = Group({"error": NUMBER, "lines": [
    Group({"number": TEXT, "in the file": NUMBER, "found": NUMBER, "standard error [%]": NUMBER, "quantity": TEXT,
           "measured": NUMBER, "with the file": NUMBER, "with what was found": NUMBER, "off by [%]": NUMBER,
           "change over that of the number": NUMBER, "verdict": TEXT})]})


def others(line):
    """Values of the entries of a study to which a line belongs."""
    return ", ".join(f"{name.rsplit('/', 1)[-1]} {value}" for name, value in line.items() if "/" in name)


def convergence_table(lines):
    rows = []
    for line in lines:
        band = line["band about the fine one"]
        rows.append([line["quantity"], others(line) or "–",
                     *(number(line[size]) for size in ("coarse", "middle", "fine")),
                     number(line["observed order"]), number(line["extrapolated"]),
                     "–" if band is None else f"± {number(band)}", line["verdict"]])
    return Table(["quantity", "of", "coarse", "middle", "fine", "observed order", "extrapolated",
                  "band about the fine one", "verdict"], rows,
                 "Three sizes of cells or steps: Richardson's extrapolation, and 1.25 times its correction as a band")


def curves_of(levels):
    """Lines of each curve, by its label."""
    found = {}
    for level in levels:
        found.setdefault(others(level), []).append(level)
    return found


def within(level, name):
    """Text of a number and its bounds."""
    if level[name] is None:
        return "–"
    return f"{number(level[name])} ({number(level[name + ' from'])} to {number(level[name + ' to'])})"


def fragility_parts(fragility):
    rows, drawn = [], {}
    for label, levels in curves_of(fragility["levels"]).items():
        counts = "; ".join(f"{number(level['intensity'])}: {level['criterion met']:.0f} of {level['runs']:.0f}"
                           for level in levels)
        rows.append([label or "all runs", counts, within(levels[0], "median"), within(levels[0], "dispersion"),
                     levels[0]["verdict"]])
        if levels[0]["median"] is not None:
            drawn[label] = levels
    parts = [Table(["curve", "runs that meet the criterion", "median", "dispersion", "verdict"], rows,
                   f"Probability that “{fragility['criterion']}” over {fragility['intensity']}; in brackets bounds "
                   f"with a confidence of {100 * fragility['confidence']:.0f} %, asymptotic for many runs")]
    if drawn:
        figure, axes = charts.new_figure()
        charts.cycle_colours(axes, len(drawn))
        for label, levels in drawn.items():
            median, dispersion = levels[0]["median"], levels[0]["dispersion"]
            deviations = np.linspace(-3., 3., 61)
            curve, = axes.plot(median * np.exp(np.clip(dispersion * deviations, -300., 300.)),
                               [0.5 * math.erfc(-z / math.sqrt(2.)) for z in deviations], label=label or None)
            axes.plot([level["intensity"] for level in levels],
                      [level["criterion met"] / max(level["runs"], 1) for level in levels], "o",
                      color=curve.get_color(), markersize=4.)
        charts.finish(axes, "", fragility["intensity"].rsplit("/", 1)[-1], "probability", False)
        parts.append(Pictures([charts.picture(figure, "Share of the runs that meet the criterion, and the lognormal curve",
                                              "study_fragility")]))
    return parts


def sensitivity_table(sensitivity):
    lines = sensitivity["numbers"]
    rows = [[line["number"], number(line["value"]), line["quantity"], number(line["as given"]),
             number(line["largest change [%]"]), number(line["change over that of the number"])]
            for line in lines[:MOST]]
    return Table(["number", "value", "quantity", "as given", "largest change [%]", "change over that of the number"],
                 rows, f"Each number varied by {number(100 * sensitivity['change'])} % down and up"
                 + (f"; {MOST} of {len(lines)} lines, the rest in study_sensitivity.csv" if len(lines) > MOST else ""))


def calibration_table(calibration):
    rows = [[line["number"], others(line) or "–", number(line["in the file"]), number(line["found"]),
             number(line["standard error [%]"]), line["quantity"], number(line["measured"]),
             number(line["with the file"]), number(line["with what was found"]), number(line["off by [%]"]),
             number(line["change over that of the number"]), line["verdict"]] for line in calibration["lines"]]
    return Table(["number", "of", "in the file", "found", "standard error [%]", "quantity", "measured", "with the file",
                  "with what was found", "off by [%]", "change over that of the number", "verdict"], rows,
                 "Numbers fitted to measurements; standard errors for errors of measurement of "
                 f"{number(100 * calibration['error'])} %")


def evaluations(data):
    """Parts of a report, for the evaluations in study.json."""
    parts = []
    if data.get("convergence"):
        parts.append(convergence_table(data["convergence"]))
    if data.get("fragility"):
        parts.extend(fragility_parts(data["fragility"]))
    if data.get("sensitivity"):
        parts.append(sensitivity_table(data["sensitivity"]))
    if data.get("calibration"):
        parts.append(calibration_table(data["calibration"]))
    return parts
