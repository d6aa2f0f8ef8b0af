"""A result folder, as the program has left it."""

import csv
import json
import pathlib
import re

import numpy as np


LOOSE = 5.  # opening at which no softening law of concrete has any strength left [mm]


class ReportError(Exception):
    """Something of the user's that makes a report impossible, in one sentence."""


class Table:
    """A file of comma-separated values over time."""

    def __init__(self, file):
        with open(file, newline="") as lines:
            rows = list(csv.reader(lines))
        self.titles = rows[0]
        # a run that was cut off may have left half a line; no number is an empty cell
        whole = [row for row in rows[1:] if len(row) == len(self.titles)]
        self.values = np.array([[float(cell or "inf") for cell in row] for row in whole])
        self.values = self.values.reshape(-1, len(self.titles))

    def __contains__(self, title):
        return title in self.titles

    def __getitem__(self, title):
        return self.values[:, self.titles.index(title)]

    @property
    def time(self):
        """[s]"""
        return self.values[:, 0]

    def matching(self, pattern):
        """Match and column of each title that is like a regular expression as a whole."""
        found = [(re.fullmatch(pattern, title), i) for i, title in enumerate(self.titles)]
        return [(match, self.values[:, i]) for match, i in found if match]


def read_parameters(text):
    """Entries of a parameter file by path, as in "Mesh/arch dam/Cell size", and the
    paths of those that are not the default."""
    entries, changed, path = {}, [], []
    for line in text.splitlines():
        line, _, remark = (part.strip() for part in line.partition("#"))
        if line.startswith("subsection "):
            path.append(line[len("subsection "):].strip())
        elif line == "end" and path:
            path.pop()
        elif line.startswith("set ") and "=" in line:
            name, value = line[len("set "):].split("=", 1)
            entries["/".join([*path, name.strip()])] = value.strip()
            if remark.startswith("default:"):
                changed.append("/".join([*path, name.strip()]))
    return entries, changed


class Run:
    """Parameters, summary, tables and pictures of a run."""

    def __init__(self, folder, label=None):
        self.folder = pathlib.Path(folder)
        if not self.folder.exists():
            raise ReportError(f'There is no folder "{folder}"; name the output folder of a run.')
        if not (self.folder / "parameters.prm").is_file():
            raise ReportError(f'"{folder}" is not the output folder of a run, as it holds no '
                              "parameters.prm; name the folder that holds summary.json.")
        self.label = label or self.folder.resolve().name
        # said where there are several runs
        self.prefix = self.title_in_chart = ""
        self.place = 0
        self.parameters, self.changed = read_parameters(self.read("parameters.prm"))
        self.summary = self._read_summary()
        self.log = self.read("log.txt") if self.has("log.txt") else ""
        self._tables = {}

    def __eq__(self, other):
        return self.folder == other.folder

    def __hash__(self):
        return hash(self.folder)

    def _read_summary(self):
        if not self.has("summary.json"):
            raise ReportError(f'The run in "{self.folder}" has not ended, as there is no '
                              "summary.json yet; wait for its end, or let it go on with --restart.")
        try:
            return json.loads(self.read("summary.json"))
        except ValueError as error:
            raise ReportError(f'"{self.folder}/summary.json" cannot be read ({error}); '
                              "let the run go on with --restart, which writes it again.") from None

    @property
    def title(self):
        return self.entry("Title") or self.label

    @property
    def verdict(self):
        verdict = self.summary.get("verdict", "no verdict")
        return verdict[0].upper() + verdict[1:]

    @property
    def colour(self):
        """How the verdict is shown: good, doubt or bad."""
        if self.verdict.startswith("Stopped"):
            return "bad"
        doubtful = self.warnings or [*self.remarks] or self.verdict != "No objection"
        return "doubt" if doubtful else "good"

    @property
    def warnings(self):
        """Warnings, and results that are missing."""
        missing = self.summary.get("files not written", {})
        return [*self.summary.get("warnings", []), *(f"not written: {file}" for file in missing)]

    @property
    def remarks(self):
        """What the program computes as it is asked to, but an engineer must look at."""
        opening = max((material.get("largest crack opening [mm]", 0.)
                       for material in self.summary.get("materials", {}).values()), default=0.)
        if opening > LOOSE:
            yield (f"Cracks open by up to {opening:.0f} mm in a cell. There nothing holds them together any "
                   "more, and parts of the dam may be loose; see the damage before using other figures.")
        for name, block in self.summary.get("interfaces", {}).get("blocks", {}).items():
            if block["time at safety one or below [s]"] > 0.:
                yield (f"The safety of {name} against sliding is at one or below for "
                       f"{block['time at safety one or below [s]']:.3g} s; see the slip that is left.")

    @property
    def notes(self):
        """What the log notes, less than a warning."""
        return re.findall(r"^\s*note: (.*)$", self.log, re.MULTILINE)

    @property
    def own_entries(self):
        """What is not the default, as --set takes it."""
        return "\n".join(f"{path} = {self.parameters[path]}" for path in self.changed
                         if path != "Output/Folder")

    def has(self, name):
        return (self.folder / name).is_file()

    def read(self, name):
        return (self.folder / name).read_text(errors="replace")

    def table(self, name):
        """A table of this name with at least two lines, or None."""
        if name not in self._tables:
            table = Table(self.folder / name) if self.has(name) else None
            self._tables[name] = table if table and len(table.values) > 1 else None
        return self._tables[name]

    def entry(self, path, default=""):
        return self.parameters.get(path, default)

    def number(self, path, default=0.):
        return float(self.entry(path) or default)

    def list(self, path, separator=","):
        return [item.strip() for item in self.entry(path).split(separator) if item.strip()]

    def objects(self, section):
        """Names and entries of the materials, loads and so on of a section."""
        for name in self.list(f"{section}/Names"):
            start = f"{section}/{name}/"
            yield name, {path[len(start):]: value for path, value in self.parameters.items()
                         if path.startswith(start)}

    def pictures(self, name):
        """Time [s] and file, in the folder, of each picture of a series, as "fields"."""
        if not self.has(f"{name}.txt"):
            return []
        lines = [line.split(maxsplit=1) for line in self.read(f"{name}.txt").splitlines()]
        return [(float(line[0]), line[1].strip()) for line in lines
                if len(line) == 2 and self.has(line[1].strip())]


def read_runs(arguments):
    """Runs of arguments FOLDER or LABEL=FOLDER, with labels that differ."""
    runs = []
    for argument in arguments:
        label, equals, folder = argument.rpartition("=")
        if equals and not pathlib.Path(argument).exists():
            runs.append(Run(folder, label))
        else:
            runs.append(Run(argument))
    if len(runs) > 1:
        labels = [run.label for run in runs]
        for number, run in enumerate(runs):
            if labels.count(run.label) > 1:
                run.label = str(run.folder)
            run.prefix, run.title_in_chart, run.place = f"{run.label}: ", run.label, number
    return runs
