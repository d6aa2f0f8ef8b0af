"""The result folder of a run."""

import functools
import hashlib
import pathlib
import re

import numpy as np

from .files import NUMBER, NUMBER_OR_NONE, TEXT, Group, ReportError, Table, is_number, read_bytes, read_json, refuse

# values of summary.json that sections use; values that are not finite are null there
SUMMARY = Group(
    {"verdict": TEXT},
    {"version": TEXT, "warnings": [TEXT], "files not written": Group(), "end time [s]": NUMBER,
     **dict.fromkeys(("cells", "unknowns", "degree", "time step [s]", "largest stable step [s]", "steps",
                      "ranks", "SIMD bits", "loop time [s]", "contact share of the loop",
                      "time of cells, largest over mean of the ranks", "MDOF-steps/s",
                      "peak memory of a rank [MB]"), NUMBER),
     "static state": Group(optional={"seconds": NUMBER, "stages": [Group(
         optional={"sum of loads so far [N]": [NUMBER], "sum of reactions [N]": [NUMBER],
                   "largest displacement [m]": NUMBER, "names": [TEXT],
                   "interfaces": Group(others=Group(optional=dict.fromkeys(
                       ("largest opening [mm]", "largest slip [mm]"), NUMBER_OR_NONE)))})]}),
     "refined where cracks are expected": Group(
         {"chosen": TEXT, **dict.fromkeys(("cells before", "cells chosen", "cells after"), NUMBER)},
         {"longest edge asked for [m]": Group(others=NUMBER),
          **dict.fromkeys(("chosen from [m]", "chosen to [m]"), [NUMBER]),
          **dict.fromkeys(("cells in their place", "longest edge there [m]", "cells that stay longer"), NUMBER)}),
     "damping": Group(optional={"moduli hold at [Hz]": NUMBER, "relaxed modulus over the given one": NUMBER}),
     "through cracks": Group(optional=dict.fromkeys(
         ("largest opening from face to face at one moment [mm]", "at the time [s]",
          "opening from face to face at the end [mm]"), NUMBER)),
     "materials": Group(others=Group(optional=dict.fromkeys(
         ("largest crack opening [mm]", "share of the volume that left the elastic range",
          "cells at tips of cracks and notches"), NUMBER))),
     "histories": Group(others=Group(
         dict.fromkeys(("largest displacement [m]", "filtered at [Hz]"), NUMBER),
         {"largest filtered acceleration [m/s2]": NUMBER})),
     "face stresses": Group(optional=dict.fromkeys(
         ("largest arch stress [MPa]", "largest cantilever stress [MPa]", "largest principal stress [MPa]",
          "smallest principal stress [MPa]"), NUMBER)),
     "interfaces": Group(
         {"surfaces": Group(others=Group(dict.fromkeys(
             ("area [m2]", "largest opening [mm]", "largest slip [mm]", "residual slip [mm]",
              "smallest sliding safety", "time at safety one or below [s]"), NUMBER_OR_NONE),
             dict.fromkeys(("slip rate at the end [mm/s]", "time of the largest opening [s]", "largest open share [%]"),
                           NUMBER_OR_NONE)))},
         {"effort": Group(optional={"unsolved clusters": NUMBER}),
          "blocks": Group(others=Group(
             {"time at safety one or below [s]": NUMBER},
             {"mass [kg]": NUMBER, "forces at the smallest safety [N]": Group(
                 optional={"contact": Group(others=[NUMBER]), "driving, with inertia": [NUMBER]}),
              **dict.fromkeys(("safety at the start", "smallest safety", "time of the smallest safety [s]",
                               "largest mobilised ratio", "slip at the end [mm]", "slip rate at the end [mm/s]"),
                              NUMBER_OR_NONE)}))}),
     "modes": Group(optional={"modes": [Group(
         {"frequency [Hz]": NUMBER, "period [s]": NUMBER, "effective mass [-]": [NUMBER],
          "cumulative effective mass [-]": [NUMBER]})]}),
     "energy balance": Group(optional=dict.fromkeys(
         ("largest energy-balance error", "energy-balance error, share of the losses"), NUMBER_OR_NONE)),
     "target spectrum": Group({"periods [s]": [NUMBER], "damping ratio": NUMBER},
                              dict.fromkeys(("x [m/s2]", "y [m/s2]", "z [m/s2]"), [NUMBER])),
     "over-stress": Group({"verdict": TEXT}, others=Group(
         {"largest ratio": NUMBER, "at the time [s]": NUMBER,
          "above 1": Group(dict.fromkeys(("share at any time [%]", "largest share at once [%]",
                                          "accumulated time [s]"), NUMBER))},
         {"at [m]": [NUMBER]}))})

# a table of the verdict: lines by their names
LINES = Group(others=Group(
    {}, {**dict.fromkeys(("value", "demand"), NUMBER_OR_NONE), **dict.fromkeys(("at most", "at least"), NUMBER),
         **dict.fromkeys(("of", "load case", "source", "quantity", "remedy"), TEXT),
         "at the time [s]": NUMBER_OR_NONE, "at [m]": [NUMBER]}))
SUMMARY.optional.update(dict.fromkeys(("numerical checks", "engineering results", "acceptance table"), LINES))

# files that belong to a part of the summary
FILES = {"histories": ("histories.csv",), "energy balance": ("energy.csv",), "envelopes": ("envelopes.vtu",),
         "interfaces": ("interfaces.csv", "interface_envelopes.vtu"),
         "face stresses": ("face_stress_envelopes.vtu",), "over-stress": ("over_stress.csv", "over_stress.vtu")}

# tables over time, and the entries with their intervals
INTERVALS = {"histories.csv": "Output/histories/Interval", "interfaces.csv": "Output/interfaces/Interval",
             "energy.csv": "Output/Energy interval", "ground_motion.csv": ""}


def is_quantity(value):
    """Whether a value of the summary is a number, null, or a list of numbers."""
    if isinstance(value, list):
        return bool(value) and all(is_quantity(part) and not isinstance(part, list) for part in value)
    return value is None or isinstance(value, (int, float)) and not isinstance(value, bool)


def read_parameters(text):
    """Entries of a parameter file by path, as in "Mesh/arch dam/Cell size", and the
    paths of entries that differ from their default values."""
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
            raise ReportError(f'"{folder}" is not the output folder of a run or a study, as it holds neither '
                              "parameters.prm nor study.json; name the folder that holds summary.json.")
        self.label = label or self.folder.resolve().name
        # names of the run, used where there are several runs
        self.prefix = self.title_in_chart = ""
        self.place = 0
        self.parameters, self.changed = read_parameters(self.read("parameters.prm"))
        if not self.parameters:
            refuse(self.folder / "parameters.prm", "holds no entries", "run the case again")
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
                              "summary.json yet; wait for its end, or continue it with --restart.")
        return read_json(self.folder / "summary.json", SUMMARY, "run the case again, which writes it anew")

    @property
    def title(self):
        return self.entry("Title") or self.label

    @property
    def verdict(self):
        verdict = self.summary.get("verdict", "no verdict")
        return verdict[0].upper() + verdict[1:]

    @property
    def warnings(self):
        """Warnings, and results that are missing."""
        unwritten = self.summary.get("files not written", {})
        expected = [file for part, files in FILES.items() if part in self.summary for file in files]
        if "steps" in self.summary and self.entry("Ground motion/Type", "none") != "none":
            expected.append("ground_motion.csv")
        missing = [file for file in expected
                   if not self.has(file) and not any(name.endswith(file) for name in unwritten)]
        return [*self.summary.get("warnings", []), *(f"not written: {file}" for file in unwritten),
                *(f"{file} is missing in the folder, so that this report lacks its results"
                  for file in missing)]

    @property
    def notes(self):
        """The notes of the log, which are no warnings."""
        return re.findall(r"^\s*note: (.*)$", self.log, re.MULTILINE)

    @property
    def own_entries(self):
        """Entries in use that differ from their default values, as arguments of --set."""
        return [f"{path} = {self.parameters[path]}" for path in self.changed
                if path != "Output/Folder" and self.is_used(path)]

    def is_used(self, path):
        """Whether an entry belongs to a mesh, motion, reservoir, observer or object that
        the case uses."""
        parts = path.split("/")
        section, name = parts[0], parts[1] if len(parts) > 2 else None
        chosen = {"Mesh": "Mesh/Type", "Reservoir": "Reservoir/Model"}
        if name is None:
            return True
        if section in chosen:
            return name == self.entry(chosen[section])
        if section == "Output":
            return name in self.list("Output/Observers")
        if section == "Ground motion":
            motion = self.entry("Ground motion/Type", "none")
            return motion != "none" and (name not in ("Record", "Ricker", "Sine", "Pulse", "Spectrum")
                                         or name.lower() == motion.lower())
        if section in ("Materials", "Loads", "Interfaces", "Constraints"):
            return name in self.list(f"{section}/Names")
        return True

    @functools.cached_property
    def digests(self):
        """Names and SHA-256 of the files of input and summary."""
        return [(name, hashlib.sha256(read_bytes(self.folder / name)).hexdigest())
                for name in ("parameters.prm", "summary.json")]

    def has(self, name):
        return (self.folder / name).is_file()

    def read(self, name):
        return read_bytes(self.folder / name).decode(errors="replace")

    def table(self, name, first="time [s]"):
        """The table of this name, with this first column and at least two lines, or None."""
        if name not in self._tables:
            table = Table(self.folder / name, first) if self.has(name) else None
            if table and first == "time [s]":
                self._check_end(table, name)
            self._tables[name] = table if table and len(table.values) > 1 else None
        return self._tables[name]

    def _check_end(self, table, name):
        """Refuses a table that ends before the run, or after it."""
        end = self.summary.get("end time [s]")
        if end is None or len(table.time) < 2 or any(file.endswith(name) for file in
                                                     self.summary.get("files not written", {})):
            return
        last, between = table.time[-1], np.diff(table.time).max()
        # tables of a stopped run may have been planned for a longer motion
        planned = self.number("Time/End time")
        if last > 1.01 * max(end, planned) + between:
            refuse(table.file, f"continues to {last:g} s, but the run ended at {end:g} s")
        if name in INTERVALS and last < min(end, planned) - 1.01 * max(between, self.number(INTERVALS[name])):
            refuse(table.file, f"is cut, as it ends at {last:g} s and the run at {end:g} s")

    def entry(self, path, default=""):
        return self.parameters.get(path, default)

    def number(self, path, default=0.):
        value = self.entry(path) or default
        if not is_number(value):
            refuse(self.folder / "parameters.prm", f'has "{value}" for "{path}", which is no number',
                   "run the case again")
        return float(value)

    def list(self, path, separator=","):
        return [item.strip() for item in self.entry(path).split(separator) if item.strip()]

    def objects(self, section):
        """Names and entries of the materials, loads and so on of a section."""
        for name in self.list(f"{section}/Names"):
            start = f"{section}/{name}/"
            yield name, {path[len(start):]: value for path, value in self.parameters.items()
                         if path.startswith(start)}

    def pictures(self, name):
        """Time [s] and file name of each picture of a series, such as "fields"."""
        if not self.has(f"{name}.txt"):
            return []
        lines = [line.split(maxsplit=1) for line in self.read(f"{name}.txt").splitlines()]
        if not all(len(line) == 2 and is_number(line[0]) for line in lines):
            refuse(self.folder / f"{name}.txt", "is no list of times and pictures")
        return [(float(time), file.strip()) for time, file in lines if self.has(file.strip())]


def read_runs(arguments):
    """Runs of arguments FOLDER or LABEL=FOLDER, with different labels."""
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
