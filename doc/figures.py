#!/usr/bin/env python3
"""Compares the figures that the texts quote with the summaries they come from.

usage: doc/figures.py --check            fails where text and summary differ
       doc/figures.py --keep FOLDER...   keeps the summary of a run or a study with
                                         this output folder as doc/studies/NAME.json

doc/figures.json lists the quotes: for each file of text and each source of
figures a pattern of the text and, for each number in it, marked by {}, a path in
the source. A source is a kept summary (doc/studies/*.json) or the reference output
of a test (tests/*/*.output), where the path is the text before "=". A quoted number
must be the rounded one, to as many digits as the text writes; behind "about" it may
be off by 5 %. A path may end with "* FACTOR"; a star within it takes the largest of
several; "[VALUE]" is the run of a study whose varied entry has this value.
"""
import csv
import fnmatch
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
KEPT = ROOT / "doc" / "studies"
QUOTES = ROOT / "doc" / "figures.json"
NUMBER = r"([-+]?\d+(?:\.\d+)?(?: \d{3})*)"
ABOUT = 0.05
LEFT_OUT = "names", "target spectrum", "mesh quality", "stress samples"


# ------------------------------------------------------------- kept summaries


def rounded(value):
    """The value with six digits, which is more than any text quotes."""
    if isinstance(value, float):
        return float(f"{value:.6g}")
    if isinstance(value, dict):
        return {key: rounded(inner) for key, inner in value.items()}
    return [rounded(inner) for inner in value] if isinstance(value, list) else value


def columns(table):
    """First, smallest, largest and last value of each displacement and filtered
    acceleration of histories.csv."""
    result = {}
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    for name in rows[0] if rows else ():
        if "displacement" in name or "filtered" in name:
            values = [float(row[name]) for row in rows]
            result[name] = {
                "first": values[0],
                "smallest": min(values),
                "largest": max(values),
                "last": values[-1],
            }
    return result


def logged(log):
    """Numbers of the mesh that only the log has."""
    found = {}
    for name, pattern in {
        "shortest edge [m]": r"^ +edges (\S+) to ",
        "longest edge [m]": r"^ +edges \S+ to (\S+) m",
        "crest length [m]": r"^Dam: .*crest (\S+) m long",
        "volume of the dam [m3]": r"^Dam: .*volume (\S+) m3",
    }.items():
        match = re.search(pattern, log.read_text(), re.M)
        if match:
            found[name] = float(match[1])
    return found


def with_runs(folder):
    """A study with the version, acceptance table and blocks of each of its runs."""
    study = json.loads((folder / "study.json").read_text())
    for run in study["runs"]:
        summary = json.loads((folder / run["folder"] / "summary.json").read_text())
        run["folder"] = pathlib.Path(run["folder"]).name
        run["version"], run["unknowns"] = summary["version"], summary["unknowns"]
        run["acceptance table"] = summary.get("acceptance table", {})
        run["blocks"] = summary.get("interfaces", {}).get("blocks", {})
    return study


def keep(folder):
    if (folder / "study.json").exists():
        text = json.dumps(rounded(with_runs(folder)), indent=1, sort_keys=True)
        (KEPT / f"{folder.name}.json").write_text(text + "\n")
        return
    summary = json.loads((folder / "summary.json").read_text())
    for key in LEFT_OUT:
        summary.pop(key, None)
    if (folder / "histories.csv").exists():
        summary["histories.csv"] = columns(folder / "histories.csv")
    summary["log"] = logged(folder / "log.txt")
    text = json.dumps(rounded(summary), indent=1, sort_keys=True)
    (KEPT / f"{folder.name}.json").write_text(text + "\n")


# --------------------------------------------------------------------- quotes


def inner(node, key):
    """The values that a part of a path names."""
    if isinstance(node, list):
        if key.startswith("["):
            return [run for run in node if key[1:-1] in run["values"].values()]
        return [node[int(key)]]
    return [node[name] for name in fnmatch.filter(node, key.replace("[", "[[]"))]


def value_of(source, path):
    """The number at a path of a source, and how far it may be off by rounding;
    None if there is none."""
    path, factor = re.fullmatch(r"(.*?)(?: \* ([-\d.e]+))?", path).groups()
    factor = float(factor or 1)
    if source.suffix == ".output":
        line = re.search(
            rf"^{re.escape(path)} = ([-+.\deE]+)", source.read_text(), re.M
        )
        if not line:
            return None
        value, half = written(line[1])
        return value * factor, half * abs(factor)
    found = [json.loads(source.read_text())]
    for key in path.split(" > "):
        found = [value for node in found for value in inner(node, key)]
    return (max(found) * factor, 0.0) if found else None


def written(text):
    """A number as the text has it, and half a unit of its last digit."""
    mantissa, _, exponent = text.replace(" ", "").lower().partition("e")
    digit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    return float(text.replace(" ", "")), 0.5 * digit


def plain(file):
    """The text of a file in one line, without the marks of comments."""
    text = file.read_text()
    if file.suffix == ".prm":
        text = re.sub(r"^# ?", "", text, flags=re.M)
    return re.sub(r"\s+", " ", text)


def complaints(file, source, pattern, paths):
    """What is wrong with a quote."""
    place = f'{file}: "{pattern}"'
    regex = re.escape(pattern).replace(r"\{\}", NUMBER)
    found = list(re.finditer(regex, plain(ROOT / file)))
    if len(found) != 1:
        yield f"{place} occurs {len(found)} times"
        return
    if len(paths) != len(found[0].groups()):
        yield f"{place} has another number of figures than of paths"
        return
    for number, path in zip(found[0].groups(), paths):
        found_value = value_of(ROOT / source, path)
        if found_value is None:
            yield f"{place}: {source} has no {path}"
            continue
        (value, off), (quoted, half) = found_value, written(number)
        if "about {}" in pattern:
            half = max(half, ABOUT * abs(value))
        if not abs(quoted - value) <= (half + off) * (1 + 1e-9):  # also of NaN
            yield f"{place}: {number} where {source} has {value:.6g} ({path})"


def check():
    count, wrong = 0, []
    for file, sources in json.loads(QUOTES.read_text()).items():
        for source, quotes in sources.items():
            for pattern, paths in quotes.items():
                paths = [paths] if isinstance(paths, str) else paths
                count += len(paths)
                wrong += complaints(file, source, pattern, paths)
    for complaint in wrong:
        print(complaint)
    print(f"{count} figures quoted, {len(wrong)} that differ or are not found")
    return 1 if wrong else 0


def main():
    if sys.argv[1:] == ["--check"]:
        sys.exit(check())
    if sys.argv[1:2] == ["--keep"] and sys.argv[2:]:
        for folder in sys.argv[2:]:
            keep(pathlib.Path(folder).resolve())
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
