"""Over-stress of the faces after a linear analysis."""

from . import charts
from .faces import face_panels, maps
from .files import refuse
from .grid import dam_of
from .page import Pictures, Section, Table, number

FILE, CURVES = "over_stress.vtu", "over_stress.csv"


def table_of(run):
    """Time above each ratio, or None."""
    table = run.table(CURVES, "ratio")
    ratios = run.list("Output/over-stress/Ratios")
    if table and len(ratios) not in (0, len(table.values)):
        refuse(table.file, f"is cut, as it has lines for {len(table.values)} of {len(ratios)} ratios")
    return table


def faces_of(run):
    """Summary of each face set, by name."""
    return {name: face for name, face in run.summary["over-stress"].items() if name != "verdict"}


def over_stress_section(runs):
    runs = [run for run in runs if "over-stress" in run.summary and table_of(run)]
    if not runs:
        return None
    verdicts = Table(["", "verdict"], [[run.prefix or "This run",
                                        run.summary["over-stress"]["verdict"]] for run in runs])
    text = ("The demand-capacity ratio is the tension on a face over the static tensile strength. A "
            "linear analysis suffices while the ratio, the share of the face above one, and the time that "
            "any point spends above each ratio stay within their limits; the dashed line is the time "
            "allowed.")
    parts = [text, verdicts, figures_table(runs)]
    runs = [run for run in runs if run.summary.get("steps", 1)]  # without steps no time passes
    if runs:
        parts.append(Pictures([curves(run) for run in runs]))
    drawn = [run for run in runs if run.has(FILE) and dam_of(run)
             and face_panels(run, "time_above_1_s", FILE)]
    if drawn:
        parts.append(Pictures(maps(drawn, [face_panels(run, "time_above_1_s", FILE) for run in drawn],
                                   "time above the strength [s]", "Accumulated time above the strength",
                                   "over_stress_time", colours="viridis")))
    return Section("Over-stress of the faces", parts)


def figures_table(runs):
    rows = [[f"{run.prefix}{name}", number(face["largest ratio"]), number(face["at the time [s]"]),
             number(face["above 1"]["share at any time [%]"]),
             number(face["above 1"]["largest share at once [%]"]),
             number(face["above 1"]["accumulated time [s]"])]
            for run in runs for name, face in faces_of(run).items()]
    return Table(["", "largest ratio [-]", "at the time [s]", "share above 1 at any time [%]",
                  "at once [%]", "longest time above 1 [s]"], rows)


def curves(run):
    """A picture of the accumulated time over the ratio, with its limit."""
    table = table_of(run)
    figure, axes = charts.new_figure()
    axes.plot(table["ratio"], table["allowed time [s]"], color="0.3", linestyle="--", label="allowed")
    charts.lines(axes, [(name, table["ratio"], table[f"{name} accumulated time [s]"])
                        for name in faces_of(run)],
                 f"{run.prefix}accumulated time above a ratio", "demand-capacity ratio [-]", "time [s]")
    axes.set_ylim(bottom=0.)
    return charts.picture(figure, f"{run.prefix}Accumulated time above each ratio",
                          f"over_stress_{run.label}")
