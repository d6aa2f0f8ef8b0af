"""A study: a table of its runs and curves over the varied entry."""

import pathlib

from . import charts, verdict
from .files import NUMBER, TEXT, Group, csv_rows, is_number, read_json, refuse
from .page import Judged, Pictures, Section, Table, number
from .run import Run
from .study_evaluations import CALIBRATION, CONVERGENCE, FRAGILITY, SENSITIVITY, evaluations

MOST = 6  # runs of a study that are shown in detail

VALUES = Group(others=TEXT)
STUDY = Group(
    {"runs": [Group({"folder": TEXT, "verdict": TEXT, "values": VALUES},
                    {"quantities": Group(others=NUMBER), "criterion met": TEXT})]},
    {"limits": [Group({"of": TEXT, "criterion": TEXT, "not met at": NUMBER, "met at": NUMBER,
                       "values": VALUES})],
     "convergence": CONVERGENCE, "fragility": FRAGILITY, "sensitivity": SENSITIVITY,
     "calibration": CALIBRATION})


class Study:
    """The result folder of a study."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        data = read_json(self.folder / "study.json", STUDY, "start the study again, which writes it anew")
        self.runs, self.limits = data["runs"], data.get("limits", [])
        self.evaluations = {name: data.get(name) for name in
                            ("convergence", "fragility", "sensitivity", "calibration")}
        if not self.in_detail:
            refuse(self.folder / "study.json", "names no run that has a summary.json beside it",
                   "do the study again with --overwrite")

    def folder_of(self, run):
        return self.folder / pathlib.Path(run["folder"]).name

    def lacks(self, run):
        """Files that are needed to show a run and missing in its folder."""
        return [name for name in ("summary.json", "parameters.prm")
                if not (self.folder_of(run) / name).is_file()]

    def label_of(self, run):
        return ", ".join(f"{short(entry)} {value}" for entry, value in run["values"].items())

    @property
    def entries(self):
        """The varied entries, in the order of the first run."""
        return list(self.runs[0]["values"]) if self.runs else []

    @property
    def quantities(self):
        found = {}
        for run in self.runs:
            found.update(dict.fromkeys(run.get("quantities", {})))
        return list(found)

    @property
    def in_detail(self):
        """Runs with results, at most MOST, evenly chosen."""
        there = [run for run in self.runs if not self.lacks(run)]
        if len(there) <= MOST:
            return there
        step = (len(there) - 1) / (MOST - 1)
        return [there[round(i * step)] for i in range(MOST)]


def is_study(folder):
    return (pathlib.Path(folder) / "study.json").is_file()


def short(path):
    """Last name of a path; a slash in brackets is part of a unit."""
    name, bracket, unit = path.partition(" [")
    return name.rsplit("/", 1)[-1] + bracket + unit


def titled(path):
    """The last name with that of its object, as "left wedge: smallest safety", or "mode 1: frequency"."""
    names = ("", "", *path.rsplit(short(path), 1)[0].strip("/").split("/"))
    above, place = names[-2:]
    numbered = [f"{kind.removesuffix('s')} {int(n) + 1}" for kind, n in zip(names, names[1:]) if n.isdigit()]
    named = [] if place.isdigit() else [f"{above} *" if place == "*" else place]
    of = ", ".join((*numbered[-1:], *named))
    return f"{of}: {short(path)}" if of else short(path)


def criterion_in_words(text):
    """Criteria with the names of tables, as "left wedge: slip [mm] > 100"."""
    return "; ".join(titled(part.strip()) for part in text.split(";"))


def numeric(text):
    return float(text) if is_number(text) else None


def abscissa(study):
    """The entry with the most numeric values, over which curves are drawn; None without one."""
    counts = {}
    for entry in study.entries:
        values = [numeric(run["values"].get(entry, "")) for run in study.runs]
        if None not in values and len(set(values)) > 1:
            counts[entry] = len(set(values))
    # a random seed is a number, but not a quantity
    amounts = {entry: n for entry, n in counts.items() if short(entry) != "Seed"}
    return max(amounts, key=amounts.get) if amounts else None


def curves(study, over, quantity):
    """Points of a quantity for each combination of the other entries."""
    found = {}
    for run in study.runs:
        if quantity in run.get("quantities", {}):
            others = ", ".join(f"{short(entry)} {value}" for entry, value in run["values"].items()
                               if entry != over)
            found.setdefault(others, []).append((float(run["values"][over]), run["quantities"][quantity]))
    return {label: sorted(points) for label, points in found.items()}


def spread(study, over, quantity):
    """Value, 16 %, median and 84 % of the statistics over other entries, if the study has them."""
    file = study.folder / "study_statistics.csv"
    if not file.is_file():
        return []
    heading, rows = csv_rows(file)
    lines = [dict(zip(heading, row)) for row in rows]
    wanted = (over, "16 %", "median", "84 %")
    if "quantity" not in heading or not set(wanted[1:]) <= set(heading):
        refuse(file, "is not the table of statistics that the program writes")
    found = [[line[title] for title in wanted] for line in lines
             if line["quantity"] == quantity and over in line]
    found = [values for values in found if all(values)]
    if not all(is_number(value) for values in found for value in values):
        refuse(file, f'has texts instead of numbers for "{quantity}"')
    return sorted([float(value) for value in values] for values in found)


def curve_picture(study, over, quantity):
    figure, axes = charts.new_figure()
    drawn = curves(study, over, quantity)
    charts.cycle_colours(axes, len(drawn))
    for label, points in drawn.items():
        axes.plot(*zip(*points), marker="o", markersize=3.5, label=label or None)
    if bands := spread(study, over, quantity):
        xs, low, middle, high = zip(*bands)
        axes.fill_between(xs, low, high, color="0.6", alpha=0.3, label="16 to 84 %")
        axes.plot(xs, middle, color="black", linewidth=2., label="median")
    for limit in study.limits:
        if limit["of"] == over:
            axes.axvspan(limit["not met at"], limit["met at"], color="C3", alpha=0.25)
    axes.set_ylim(bottom=min(0., axes.get_ylim()[0]))
    charts.finish(axes, "", short(over), short(quantity), False)
    return charts.picture(figure, f"{titled(quantity)} over {short(over)}",
                          f"study_{quantity}")


def judged_runs(study, table):
    """The judgement of each run of a study in a table of the verdict; None where no run has the table."""
    lines = [(run, {line.what: line for line in verdict.lines_of(Run(study.folder_of(run)), table)})
             for run in study.runs if not study.lacks(run)]
    heads = dict.fromkeys(what for _, found in lines for what in found)
    rows = [[*(run["values"].get(entry, "–") for entry in study.entries),
             *(Judged(f"{found[what].judged}: {found[what].found}", found[what].colour) if what in found else "–"
               for what in heads)] for run, found in lines]
    return Table([*map(short, study.entries), *heads], rows,
                 f"{table[0].upper() + table[1:]} of the runs of {study.folder.name}.") if heads else None


def study_section(_, studies):
    """Tables and curves of all studies; None without any."""
    parts = []
    for study in studies:
        met = ["criterion met"] if study.limits else []
        head = [*map(short, study.entries), *map(titled, study.quantities), *met, "verdict"]
        rows = [[*(run["values"].get(entry, "–") for entry in study.entries),
                 *(number(run["quantities"][q]) if q in run.get("quantities", {}) else "–"
                   for q in study.quantities), *(criterion_in_words(run.get(key, "–")) for key in met),
                 run["verdict"].split(". ")[0]] for run in study.runs]
        tables = [judged_runs(study, verdict.ACCEPTANCE), Table(
            head, rows, f"The runs of {study.folder.name}; numbers as in study.csv."),
                  judged_runs(study, verdict.RESULTS)]
        parts += [table for table in tables if table]
        for limit in study.limits:
            others = ", ".join(f"{short(entry)} {value}" for entry, value in limit["values"].items())
            parts.append(f"{others + ': the' if others else 'The'} limit of {short(limit['of'])} lies between "
                         f"{limit['not met at']:g} and {limit['met at']:g} "
                         f"(criterion: {criterion_in_words(limit['criterion'])}).")
        parts.extend(evaluations(study.evaluations))
        over = abscissa(study)
        if over:
            parts.append(Pictures([curve_picture(study, over, quantity) for quantity in study.quantities]))
        for run in study.runs:
            if study.lacks(run) and not run["verdict"].startswith("failed: "):
                parts.append(f"Not in detail: {study.label_of(run)}, as there is no "
                             f"{' and no '.join(study.lacks(run))} in its folder.")
        if len(study.in_detail) < len(study.runs):
            parts.append(f"{len(study.in_detail)} of the {len(study.runs)} runs follow in detail.")
    return Section("Study", parts) if parts else None
