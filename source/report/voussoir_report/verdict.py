"""Numerical checks, engineering results and the acceptance table, from summary.json."""

import dataclasses
import fnmatch
import math
import re

from . import grid as grids
from .page import number

# judgements of a line, from good to bad, as the page has them
MET, NOT_ASSESSED, TO_JUDGE, NOT_MET = "met", "not assessed", "to be judged", "not met"
RANK = {MET: 0, NOT_ASSESSED: 1, TO_JUDGE: 2, NOT_MET: 3}
COLOURS = {MET: "good", NOT_ASSESSED: "open", TO_JUDGE: "doubt", NOT_MET: "bad"}

VISIBLE = 0.1  # smaller openings are those of an elastic mesh [mm]
CRUSHED = 0.01  # damage in compression of concrete that has reached its strength

CHECKS, RESULTS, ACCEPTANCE = "numerical checks", "engineering results", "acceptance table"


@dataclasses.dataclass
class Line:
    """A criterion: the result with place and time, its limit, and the judgement."""

    what: str
    found: str
    limit: str
    judged: str
    place: str = ""

    @property
    def colour(self):
        return COLOURS[self.judged]


@dataclasses.dataclass
class Verdict:
    """A title, criteria and remarks."""

    kind: str
    title: str
    lines: list
    remarks: list
    judged: str

    @property
    def colour(self):
        return COLOURS[self.judged]


def worst(lines):
    return max((line.judged for line in lines), key=RANK.get, default=NOT_ASSESSED)


def at(time, place=None):
    """A time [s] and a place [m] in words."""
    words = [] if time is None else [f"at {number(time)} s"]
    if place and len(place) == 3:
        words.append(f"x = {number(place[0])}, y = {number(place[1])}, z = {number(place[2])} m")
    return ", ".join(words)


def unit_of(quantity):
    found = re.search(r" \[([^\[\]]+)\]$", quantity)
    return f" {found[1]}" if found else ""


def lines_of(run, name):
    """The lines of a table of summary.json; criteria of the case in the order of the case."""
    table = run.summary.get(name, {})
    order = [wanted for wanted in run.list("Acceptance/Names") if wanted in table] if name == ACCEPTANCE else table
    for entry in order:
        line = table[entry]
        value = line.get("demand", line.get("value"))
        unit = unit_of(line.get("quantity", ""))  # lines of other tables have the unit in their names
        limit = next((f"{sense} {number(line[sense])}{unit}" for sense in ("at most", "at least") if sense in line),
                     "no limit in the case")
        if name == ACCEPTANCE:
            limit += f" ({line['source']})"
            what = f"{entry}, {line['load case']}" + (f": {line['clause']}" if line.get("clause") else "")
        else:
            what = entry
        missing = NOT_ASSESSED if value is None else TO_JUDGE
        judged = {True: MET, False: NOT_MET, None: missing}.get(line.get("met"), NOT_MET)
        what_of = line.get("of", line.get("quantity", ""))
        place = ", ".join(part for part in (what_of, at(line.get("at the time [s]"), line.get("at [m]"))) if part)
        yield Line(what, "no number" if value is None else number(clean(value)) + unit, limit, judged, place)


def numerical_checks(run):
    """Whether equations were solved, contact constraints met and files written."""
    lines = list(lines_of(run, CHECKS))
    judged = worst(lines)
    if run.summary.get("verdict", "").startswith(("stopped: ", "failed: ")):
        title, judged = run.verdict, NOT_MET
    elif not lines:
        title, judged = "Not known: the results are of a version that did not write its checks", TO_JUDGE
    elif judged == NOT_MET:
        title = "A check is not met"
    elif run.warnings:
        title, judged = "To be examined before the results are used", TO_JUDGE
    else:
        title = "All checks are met"
    remedies = [f"{name}: {line['remedy']}" for name, line in run.summary.get(CHECKS, {}).items() if "remedy" in line]
    return Verdict("Numerical checks", title, lines, [*run.warnings, *remedies], judged)


def engineering_results(run):
    """Results for the dam, from the summary."""
    lines = [line for line in (*lines_of(run, RESULTS), tension_line(run), pressure_line(run), crushing_line(run),
                               *opening_lines(run), bond_line(run)) if line]
    judged = worst(lines)
    title = {MET: "All assessed criteria are met", NOT_MET: "Not all criteria are met",
             TO_JUDGE: "To be judged: results without a limit",
             NOT_ASSESSED: "Not assessed: no strength and no limit is given"}[judged]
    return Verdict("Engineering results", title, lines, [], judged)


def acceptance_table(run):
    """The criteria of the case; None if it has none."""
    lines = list(lines_of(run, ACCEPTANCE))
    if not lines:
        return None
    judged = worst(lines)
    title = {MET: "All criteria are met", NOT_MET: "Not all criteria are met"}.get(
        judged, "Some criteria are not assessed, as their numbers are missing")
    return Verdict("Acceptance table", title, lines, [], judged)


def has_strength(run):
    """Whether a tensile strength is given for the concrete of the dam."""
    dam = grids.dam_of(run)
    names = grids.dam_materials(run, dam.grid.names("material")) if dam else []
    return any(run.number(f"Materials/{name}/Tensile strength") for name in names)


def tension_line(run):
    """The largest tension, where no strength is given for comparison."""
    stresses = run.summary.get("face stresses", {})
    key = "largest principal stress [MPa]"
    if "over-stress" in run.summary or key not in stresses or has_strength(run):
        return None
    return Line("largest principal tension on the faces", f"{number(stresses[key])} MPa",
                "no strength given (observer over-stress)", NOT_ASSESSED)


def crushing(run):
    """The largest damage in compression of any material."""
    return max((values.get("largest compression damage") or 0. for values in run.summary.get("materials", {}).values()),
               default=0.)


def crushing_line(run):
    """The damage of crushed concrete, whose stress has fallen and tells nothing of its strength."""
    if crushing(run) <= CRUSHED:
        return None
    return Line("crushed concrete: largest damage in compression", number(crushing(run)), "0, not crushed", NOT_MET)


def kept_strength(run, material):
    """The share of the compressive strength of a material that its longest cells keep, by the log."""
    notes = re.search(rf"^Material {re.escape(material)}: .*\n((?: .*\n)*)", run.log, re.MULTILINE)
    lowered = re.findall(r"compressive strength is lowered by up to (\d+\.?\d*) %", notes[1]) if notes else []
    return 1. - 0.01 * max(map(float, lowered), default=0.)


def pressure_line(run):
    """Largest compression on the faces over the least compressive strength of the dam, as long cells lower it."""
    smallest = run.summary.get("face stresses", {}).get("smallest principal stress [MPa]")
    dam = grids.dam_of(run)
    if smallest is None or dam is None:
        return None
    given = {name: 1e-6 * run.number(f"Materials/{name}/Compressive strength")
             for name in grids.dam_materials(run, dam.grid.names("material"))}
    strength, name = min(((value * kept_strength(run, name), name) for name, value in given.items() if value > 0.),
                         default=(0., None))
    if not strength:
        return None
    ratio = max(-smallest, 0.) / strength
    lowered = f", lowered from {number(given[name])} MPa in the longest cells" if strength < given[name] else ""
    return Line("compression on the faces over compressive strength", number(ratio), "1",
                MET if ratio <= 1. and crushing(run) <= CRUSHED else NOT_MET,
                f"{number(-smallest)} of {number(strength)} MPa{lowered}")


def clean(value):
    """A value without round-off of openings and slips [mm]."""
    return value if abs(value) > 1e-6 else 0.


def surfaces_of(run):
    return run.summary.get("interfaces", {}).get("surfaces", {})


def section_of(run, surface):
    """The section of the interface to which a surface belongs; one between two cell sets has the name of the interface."""
    return next((f"Interfaces/{name}" for name, _ in run.objects("Interfaces")
                 if any(fnmatch.fnmatch(surface, pattern) for pattern in run.list(f"Interfaces/{name}/Face sets") or [name])),
                "")


def key_depth(run, surface):
    """Depth of the keys of a surface [mm]; 0 without keys."""
    return 1e3 * run.number(f"{section_of(run, surface)}/Key depth")


def opening_lines(run):
    """The largest opening of surfaces without keys, and of joints over the depth of their keys."""
    openings = {name: math.inf if surface["largest opening [mm]"] is None else surface["largest opening [mm]"]
                for name, surface in surfaces_of(run).items() if "largest opening [mm]" in surface}
    keyed = {name: key_depth(run, name) for name in openings if key_depth(run, name)}
    if keyed:
        name = max(keyed, key=lambda joint: openings[joint] / keyed[joint])
        yield Line("largest opening of a joint with keys", f"{number(clean(openings[name]))} mm",
                   f"{number(keyed[name])} mm, depth of the keys", MET if openings[name] < keyed[name] else NOT_MET, name)
    others = {name: opening for name, opening in openings.items() if name not in keyed}
    if others:
        name = max(others, key=others.get)
        closed = others[name] < VISIBLE
        yield Line("largest opening of a joint or plane" + (" without keys" if keyed else ""),
                   f"{number(clean(others[name]))} mm", "closed" if closed else "no limit in the case",
                   MET if closed else TO_JUDGE, "" if closed else name)


def bond_line(run):
    """How many of the interfaces with a bond cracked, by an opening or a slip in the run or in a static stage, and the
    most open one of them."""
    sections = {name: section_of(run, name) for name in surfaces_of(run)}
    bonded = [name for name, section in sections.items()
              if run.entry(f"{section}/Law").endswith("bond") and not run.number(f"{section}/Initial gap")]
    if not bonded:
        return None
    states = [surfaces_of(run), *(stage.get("interfaces", {}) for stage in run.summary.get("static state", {}).get("stages", []))]

    def extent(name):
        found = ([state.get(name, {}).get(key, 0.) for state in states]
                 for key in ("largest open share [%]", "largest opening [mm]", "largest slip [mm]"))
        return [max(math.inf if value is None else clean(value) for value in values) for values in found]

    cracked = [name for name in bonded if any(extent(name))]
    place = ""
    if cracked:
        name = max(cracked, key=extent)
        share, opening, slip = extent(name)
        place = (f"{name}: opening {number(opening)} mm, slip {number(slip)} mm, {number(share)} % of its area open at once "
                 "during the run")
    return Line("bonded interfaces that cracked", f"{len(cracked)} of {len(bonded)}",
                "no limit in the case" if cracked else "none", TO_JUDGE if cracked else MET, place)


def verdicts_of(run):
    return [verdict for verdict in (acceptance_table(run), numerical_checks(run), engineering_results(run)) if verdict]
