"""Two verdicts: whether the computation can be trusted, and what it means for the dam."""

import dataclasses
import math
import re

from . import grid as grids
from .page import number

# how a line is judged, from good to bad, and what stands in the page
MET, NOT_ASSESSED, TO_JUDGE, NOT_MET = "met", "not assessed", "to be judged", "not met"
RANK = {MET: 0, NOT_ASSESSED: 1, TO_JUDGE: 2, NOT_MET: 3}
COLOURS = {MET: "good", NOT_ASSESSED: "open", TO_JUDGE: "doubt", NOT_MET: "bad"}

LOOSE = 5.  # opening at which no softening law of concrete has any strength left [mm]
VISIBLE = 0.1  # openings and slips below it are those of an elastic mesh [mm]
SLIDING = 1.05  # ratio of resistance to contact forces up to which waves hide that a block slides [-]
MOVING = 1.  # rate above which a surface still slides [mm/s]
ENERGY_LIMIT, ENERGY_TEXT = 0.01, "1 %"  # from there on the program warns

# warnings of the program on the state of the dam; all others are on the computation
ENGINEERING = (r'"over-stress": ', r".* a crack is open by ", r'.*" has slipped by ',
               r"a twentieth of the volume of ")
LOWERED = re.compile(r"their (\w+ ?\w*) is lowered by up to ([\d.]+) %")


@dataclasses.dataclass
class Line:
    """A criterion: what was found, where and when, its limit, and how that is judged."""

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


def is_engineering(warning):
    return any(re.match(pattern, warning) for pattern in ENGINEERING)


def numerical_checks(run):
    """Whether equations, contact and files are as they should be."""
    warnings = [text for text in run.warnings if not is_engineering(text)]
    lines = [line for line in (energy_line(run), losses_line(run), contact_line(run), step_line(run),
                               *strength_lines(run)) if line]
    stopped = not run.verdict.startswith(("No objection", "With warnings"))
    if stopped:
        title, judged = run.verdict, NOT_MET
    elif any(line.judged == NOT_MET for line in lines):
        title, judged = "A check is not met", NOT_MET
    elif warnings or any(line.judged == TO_JUDGE for line in lines):
        title, judged = "To be looked at before the results are used", TO_JUDGE
    else:
        title, judged = "No objection to the computation", MET
    return Verdict("Numerical checks", title, lines, warnings, judged)


def energy_line(run):
    balance, key = run.summary.get("energy balance", {}), "largest energy-balance error"
    if key not in balance:
        return None
    share = balance[key]
    if share is None:
        return Line("energy-balance error, of what came in", "no number", ENERGY_TEXT, NOT_MET)
    return Line("energy-balance error, of what came in", percent(share), ENERGY_TEXT,
                MET if share <= ENERGY_LIMIT else NOT_MET)


def losses_line(run):
    share = run.summary.get("energy balance", {}).get("energy-balance error, share of the losses")
    if share is None:
        return None
    return Line("energy-balance error at the end, of the losses", percent(abs(share)), "3 %",
                MET if abs(share) <= 0.03 else TO_JUDGE)


def contact_line(run):
    unsolved = run.summary.get("interfaces", {}).get("effort", {}).get("unsolved clusters")
    if unsolved is None:
        return None
    return Line("clusters of contact nodes without a solution", number(unsolved), "0",
                MET if unsolved == 0 else NOT_MET)


def step_line(run):
    step, stable = (run.summary.get(key) for key in ("time step [s]", "largest stable step [s]"))
    if not step or not stable:
        return None
    return Line("time step over the largest stable one", number(step / stable), "1",
                MET if step <= stable else NOT_MET)


def strength_lines(run):
    """Strengths that the program lowers where cells are too long for the fracture energy."""
    most = {}
    for what, share in LOWERED.findall("\n".join(run.notes)):
        most[what] = max(float(share), most.get(what, 0.))
    return [Line(f"{what} lowered, as cells are too long for the fracture energy, by up to", f"{share:g} %", "0",
                 TO_JUDGE) for what, share in most.items()]


def percent(share):
    return f"{number(100. * share)} %" if abs(share) > 1e-8 else "below 10⁻⁶ %"


def engineering_results(run):
    """What the run says of the dam, by what its summary has."""
    lines = [line for line in (*over_stress_lines(run), tension_line(run), pressure_line(run), *crack_lines(run),
                               opening_line(run), *slip_lines(run), *block_lines(run)) if line]
    remarks = [text for text in run.warnings if is_engineering(text)]
    judged = worst(lines)
    if remarks and RANK[judged] < RANK[TO_JUDGE]:
        judged = TO_JUDGE
    title = {MET: "The criteria looked at are met", NOT_MET: "Not all criteria are met",
             TO_JUDGE: "To be judged: results without a limit in the case",
             NOT_ASSESSED: "Not assessed: no strength and no limit is known to compare with"}[judged]
    return Verdict("Engineering results", title, lines, remarks, judged)


def over_stress_lines(run):
    over = run.summary.get("over-stress")
    if not over:
        return
    faces = [(name, face) for name, face in over.items() if name != "verdict"]
    if faces:
        name, face = max(faces, key=lambda item: item[1]["largest ratio"])
        ratio = face["largest ratio"]
        yield Line("demand over static tensile strength", number(ratio), "1", MET if ratio <= 1. else NOT_MET,
                   f"{name}, {at(face['at the time [s]'], face.get('at [m]'))}")
        share, name = max((face["above 1"]["share at any time [%]"], name) for name, face in faces)
        limit = run.number("Output/over-stress/Largest share")
        if limit > 0.:
            yield Line("share of a face above its strength at any time", f"{number(share)} %", f"{limit:g} %",
                       MET if share <= limit else NOT_MET, name if share > 0. else "")
    suffices = over["verdict"].startswith("linear analysis suffices")
    yield Line("linear analysis", "suffices" if suffices else "does not suffice",
               "duration and extent of over-stress", MET if suffices else NOT_MET)


def is_linear(run):
    """Whether the concrete of the dam has a law without strength."""
    dam = grids.dam_of(run)
    names = grids.dam_materials(run, dam.grid.names("material")) if dam else []
    entries = dict(run.objects("Materials"))
    return all("Tensile strength" not in entries.get(name, {}) for name in names)


def tension_line(run):
    """Tension that nothing is compared with."""
    stresses = run.summary.get("face stresses", {})
    key = "largest principal stress [MPa]"
    if "over-stress" in run.summary or key not in stresses or not is_linear(run):
        return None
    return Line("largest principal tension on the faces", f"{number(stresses[key])} MPa",
                "no strength given (observer over-stress)", NOT_ASSESSED)


def pressure_line(run):
    """Largest pressure on the faces over the least compressive strength of the dam."""
    smallest = run.summary.get("face stresses", {}).get("smallest principal stress [MPa]")
    dam = grids.dam_of(run)
    if smallest is None or dam is None:
        return None
    strengths = [run.number(f"Materials/{name}/Compressive strength")
                 for name in grids.dam_materials(run, dam.grid.names("material"))]
    strength = 1e-6 * min((value for value in strengths if value > 0.), default=0.)
    if not strength:
        return None
    ratio = max(-smallest, 0.) / strength
    return Line("pressure on the faces over compressive strength", number(ratio), "1",
                MET if ratio <= 1. else NOT_MET, f"{number(-smallest)} of {number(strength)} MPa")


def crack_lines(run):
    materials = run.summary.get("materials", {})
    widest = max(((values.get("largest crack opening [mm]", 0.), name) for name, values in materials.items()),
                 default=(0., ""))
    if widest[0] > VISIBLE:
        yield Line("largest crack opening in a cell", f"{number(widest[0])} mm",
                   f"{number(LOOSE)} mm: no strength left", NOT_MET if widest[0] > LOOSE else TO_JUDGE, widest[1])
    through = run.summary.get("through cracks", {})
    key = "largest opening from face to face at one moment [mm]"
    if key in through:
        opening = through[key]
        yield Line("dam open from face to face at one moment", f"{number(clean(opening))} mm", "closed",
                   NOT_MET if opening > VISIBLE else MET,
                   at(through.get("at the time [s]")) if opening > VISIBLE else "")
        still = through.get("opening from face to face at the end [mm]", 0.)
        if still > VISIBLE:
            yield Line("dam open from face to face at the end", f"{number(still)} mm", "closed", NOT_MET)
    elif widest[0] > VISIBLE:
        yield Line("dam open from face to face", "not looked at", "closed (observer through cracks)", NOT_ASSESSED)


def clean(value):
    """Round-off of openings and slips [mm] is zero."""
    return value if abs(value) > 1e-6 else 0.


def surfaces_of(run):
    return run.summary.get("interfaces", {}).get("surfaces", {})


def largest_of(run, key):
    """The largest number of a surface, and its name; infinity where there is none."""
    values = [(math.inf if surface[key] is None else surface[key], name)
              for name, surface in surfaces_of(run).items() if key in surface]
    return max(values, default=(None, ""))


def key_depth(run):
    """The least depth of the keys of joints [mm]; 0 without keys."""
    depths = [1e3 * run.number(f"Interfaces/{name}/Key depth") for name, _ in run.objects("Interfaces")]
    return min((depth for depth in depths if depth > 0.), default=0.)


def opening_line(run):
    opening, name = largest_of(run, "largest opening [mm]")
    if opening is None:
        return None
    if opening < VISIBLE:
        return Line("largest opening of a joint or plane", f"{number(clean(opening))} mm", "closed", MET)
    depth = key_depth(run)
    if depth:
        return Line("largest opening of a joint or plane", f"{number(opening)} mm",
                    f"{number(depth)} mm, depth of the keys", MET if opening < depth else NOT_MET, name)
    return Line("largest opening of a joint or plane", f"{number(opening)} mm", "no limit in the case",
                TO_JUDGE, name)


def slip_lines(run):
    for key, what, unit, threshold, judged in (
            ("residual slip [mm]", "slip at the end", "mm", VISIBLE, TO_JUDGE),
            ("slip rate at the end [mm/s]", "slip rate at the end", "mm/s", MOVING, NOT_MET)):
        value, name = largest_of(run, key)
        if value is None:
            continue
        if value > threshold:
            limit = f"at rest ({MOVING:g} mm/s)" if unit == "mm/s" else "no limit in the case"
            yield Line(what, f"{number(value)} {unit}", limit, judged, name)
        else:
            yield Line(what, f"{number(clean(value))} {unit}", f"none ({threshold:g} {unit})", MET)


def block_lines(run):
    for name, block in run.summary.get("interfaces", {}).get("blocks", {}).items():
        safety = block.get("smallest safety")
        if safety is None:
            yield Line(f"{name}: resistance over contact forces", "nothing drives it", "1", MET)
            continue
        time = block["time at safety one or below [s]"]
        # friction caps the contact forces, so that a block that slides shows just one
        # and one above it proves no safety
        slides = safety < SLIDING or time > 0.
        yield Line(f"{name}: resistance over contact forces, smallest", number(safety), "1, at which it slides",
                   NOT_MET if slides else TO_JUDGE,
                   ", ".join(part for part in (at(block.get("time of the smallest safety [s]")),
                                               f"{number(time)} s at one or below" if time > 0. else "") if part))


def verdicts_of(run):
    return [numerical_checks(run), engineering_results(run)]
