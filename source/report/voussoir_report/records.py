"""Sources of the input motion: files, hashes, durations, correlation of components."""

import hashlib
import pathlib
import re

import numpy as np

from .files import is_number
from .motion import significant_duration
from .page import Digest, Table, number

CASE_FOLDERS = []  # further folders to search for files that a parameter file names


def sha256(file):
    return hashlib.sha256(pathlib.Path(file).read_bytes()).hexdigest()


def found(run, name):
    """A file that the parameter file names relative to its own folder, which is not
    stored with the results; None where the file is not found."""
    here = pathlib.Path.cwd()
    own = pathlib.Path(__file__).resolve().parents
    # the folders of the shipped cases come last, in the sources or as installed
    for folder in (*CASE_FOLDERS, here, here / "prm", *run.folder.resolve().parents,
                   own[3] / "prm", own[1] / "prm"):
        if (file := pathlib.Path(folder) / name).is_file():
            return file
    return None


def duration_of(file):
    """Length [s] of a record: an AT2 file, or a table whose first column is time; None
    for other files."""
    lines = file.read_text(errors="replace").splitlines()
    head = re.search(r"NPTS\s*=\s*(\d+)\s*,?\s*DT\s*=\s*([\d.]+)", "\n".join(lines[:6]), re.IGNORECASE)
    if head:
        return (int(head[1]) - 1) * float(head[2])
    rows = [re.split(r"[\s,;]+", line.strip()) for line in lines if line.strip() and line.strip()[0] not in "#%"]
    rows = [row for row in rows if all(map(is_number, row))]
    if len(rows) < 2 or len(rows[0]) < 2:
        return None
    return float(rows[-1][0]) - float(rows[0][0])


def sources_table(runs):
    """A table with a row for each file of accelerations; None without files."""
    rows = []
    for run in runs:
        if run.entry("Ground motion/Type") != "record":
            continue
        start, length = (run.number(f"Ground motion/Record/{entry}") for entry in ("Start time", "Duration"))
        used = f"{number(start)} s to " + (f"{number(start + length)} s" if length else "the end")
        names = {}
        for direction in "xyz":
            if name := run.entry(f"Ground motion/Record/File {direction}"):
                column = run.entry(f"Ground motion/Record/Column {direction}", "1")
                names.setdefault(name, []).append(direction + (f" (column {column})" if column != "1" else ""))
        for name, directions in names.items():
            file = found(run, name)
            duration = duration_of(file) if file else None
            rows.append([f"{run.prefix}{name}", ", ".join(directions), remark_of(file) if file else "–",
                         f"{number(duration)} s" if duration else "–", used,
                         run.entry("Ground motion/Record/Baseline correction"),
                         Digest(sha256(file)) if file else "file not found; name its folder with --case-folder"])
    return Table(["record", "directions", "its own heading", "whole record", "part used", "baseline",
                  "SHA-256 of the file as it is now"], rows, "Sources of the records.") if rows else None


def remark_of(file, longest=160):
    """The first sentence of a record's heading."""
    with open(file, errors="replace") as stream:
        lines = [stream.readline().strip() for _ in range(4)]
    text = " ".join(line.lstrip("#% ") for line in lines if not is_number(line.split()[0] if line.split() else "0"))
    return text if len(text) <= longest else text[:longest].rsplit(" ", 1)[0] + " …"


def correlation(one, other):
    """Correlation coefficient of two components; None where one is zero."""
    if not np.any(one) or not np.any(other):
        return None
    return float(np.corrcoef(one, other)[0, 1])


def correlation_table(runs, motion_of):
    """A table of correlation coefficients of components over the union of their significant
    durations; None if no run has two components."""
    rows, alike = [], False
    pairs = (("x", "y"), ("x", "z"), ("y", "z"))
    for run in runs:
        motion = motion_of(run)
        moving = {d: a for d, a in motion.acceleration.items() if np.any(a)}
        if len(moving) < 2:
            continue
        spans = [significant_duration(a, motion.interval) for a in moving.values()]
        within = ((motion.time - motion.time[0] >= min(s[0] for s in spans))
                  & (motion.time - motion.time[0] <= max(s[1] for s in spans)))
        values = [correlation(moving[a][within], moving[b][within]) if a in moving and b in moving else None
                  for a, b in pairs]
        alike |= any(value is not None and abs(value) > 0.99 for value in values)
        rows.append([run.prefix or "correlation coefficient [-]", *map(number, values)])
    if not rows:
        return None
    return Table(["", *(f"{a} and {b}" for a, b in pairs)], rows,
                 "Correlation of the components over the strong part. " + (
                     "Components with ±1 are one scaled record: they are always in phase, unlike those of "
                     "an earthquake." if alike else ""))
