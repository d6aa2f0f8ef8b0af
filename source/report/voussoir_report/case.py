"""The case in words, the main results, and the effort of the run."""

import re

import numpy as np

from . import grid as grids, verdict
from .motion import GRAVITY, peak
from .page import Block, Digest, Section, Table, Verdicts, comparison, number

DIRECTIONS = {"x": "across the valley", "y": "along the river", "z": "vertical"}
SIGNS = ("Axes: +x points to the left bank, +y upstream, +z up. Tension is positive, "
         "compression negative; an opening is positive where a joint opens. Units stand "
         "beside the numbers; g is 9.81 m/s².")


# dimensions of a generated dam by its drawings, from the log; the mesh replaces arcs by chords
DRAWN = re.compile(r"^Dam: (\S+) m high, crest (\S+) m long; at the crown (\S+) to (\S+) m thick; "
                   r"volume (\S+) m3; slenderness (\S+)", re.MULTILINE)


def listed(words):
    """Words as "a, b and c"."""
    words = list(words)
    return " and ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else "".join(words)


def dam_in_words(run):
    dam = grids.dam_of(run)
    if dam is None:
        return None
    drawn = DRAWN.search(run.log)
    if drawn:
        height, crest, top, bottom, volume, slenderness = map(float, drawn.groups())
        return (f"A dam {number(height)} m high and {number(crest)} m long along its crest, at the crown {number(top)} to "
                f"{number(bottom)} m thick, of {number(volume)} m³: {number(crest / height)} times as long as high, "
                f"Lombardi's slenderness F²/(V·H) = {number(slenderness)}, with F the area of the middle surface.")
    volume = f"{number(dam.volume)} m³"
    if dam.is_slice:
        thickness = np.ptp(dam.points[:, 0])
        return (f"A slice of a dam, {number(thickness)} m along the axis, "
                f"{number(dam.height)} m high, of {volume}.")
    return (f"A dam {number(dam.height)} m high and {number(dam.crest_length)} m long along its "
            f"crest, which is {number(dam.crest_width)} m wide, of {volume}: "
            f"{number(dam.crest_length / dam.height)} times as long as high, Lombardi's "
            f"slenderness F²/(V·H) = {number(dam.slenderness)}, with F the area of the middle "
            "surface.")


def materials_table(run):
    shown = {"Class": ("class", 1.), "Cell sets": ("in", 1.),
             "Young's modulus": ("E [GPa]", 1e-9), "Poisson's ratio": ("ν [-]", 1.),
             "Density": ("density [kg/m³]", 1.), "Static factor": ("static over dynamic E [-]", 1.),
             "Tensile strength": ("tensile strength [MPa]", 1e-6),
             "Compressive strength": ("compressive strength [MPa]", 1e-6),
             "Tension law": ("tension law", 1.),
             "Fracture energy": ("fracture energy [N/m]", 1.),
             "Cohesion": ("cohesion [MPa]", 1e-6), "Friction angle": ("friction angle [°]", 1.)}
    materials = dict(run.objects("Materials"))
    for values in materials.values():
        if values.get("Tension law") == "table":
            values.pop("Fracture energy", None)  # the table has its own
        for strength in ("Tensile strength", "Compressive strength"):
            if values.get(strength) == "0":
                values.pop(strength)  # none is given
    used = [entry for entry in shown if any(entry in values for values in materials.values())]

    def cell(entry, value):
        try:
            return f"{float(value) * shown[entry][1]:g}"
        except ValueError:
            return value

    rows = [[name, *(cell(entry, values[entry]) if entry in values else "–" for entry in used)]
            for name, values in materials.items()]
    over_stress = run.number("Output/over-stress/Tensile strength")
    if "over-stress" in run.summary and over_stress:
        used.append("over-stress")
        for row in rows:
            row.append("–")
        rows.append(["faces (over-stress)", *("–" for _ in used[:-1]), number(1e-6 * over_stress)])
    heads = [shown[entry][0] if entry in shown else "compared with tension [MPa]" for entry in used]
    return Table(["material", *heads], rows, "Materials and strengths.")


def load_in_words(run, name):
    """The name of a load with its class and level."""
    entries = dict(run.objects("Loads")).get(name, {})
    facts = [entries.get("Class", "")] if entries.get("Class", name) != name else []
    if entries.get("Level") not in (None, "", "0"):
        facts.append(f"to {entries['Level']} m")
    return name + (f" ({', '.join(facts)})" if facts else "")


def loads_table(run):
    """Load cases in order: the static stages with their sums, and the earthquake."""
    stages = run.list("Static state/Stages", ";")
    found = run.summary.get("static state", {}).get("stages", [])
    rows = []

    def force(values):
        return "; ".join(number(1e-6 * value if abs(value) >= 500. else 0., 4) for value in values) if values else "–"

    for n, stage in enumerate(stages):
        result = found[n] if n < len(found) else {}
        combination, _, loads = stage.rpartition(":")
        names = [name.strip() for name in loads.split(",")]
        rows.append([combination.strip() or ", ".join(names), listed(load_in_words(run, name) for name in names),
                     force(result.get("sum of loads so far [N]")), force(result.get("sum of reactions [N]")),
                     number(100. * result["largest displacement [m]"]) if "largest displacement [m]" in result else "–"])
    if run.entry("Ground motion/Type", "none") != "none":
        rows.append([f"{rows[-1][0]} + earthquake" if stages else "earthquake",
                     earthquake_in_words(run), "–", "–", "–"])
    heads = ["load case", "loads", "sum of loads so far x; y; z [MN]", "sum of reactions x; y; z [MN]",
             "largest displacement so far [cm]"]
    if not stages:
        heads, rows = heads[:2], [row[:2] for row in rows]
    return Table(heads, rows, "Load cases.") if rows else None


def water_in_words(run):
    model = run.entry("Reservoir/Model", "none")
    if model == "none":
        return "No interaction with the water."
    if model == "added mass":
        return ("The water moves with the dam as Westergaard's added mass, to "
                f"{run.entry('Reservoir/added mass/Level')} m.")
    return f"Reservoir: {model}."


def interfaces_in_words(run):
    words = []
    for name, entries in run.objects("Interfaces"):
        facts = [f"law {entries.get('Law', 'friction')}"]
        for entry, text, factor in (("Friction coefficient", "friction {}", 1.),
                                    ("Cohesion", "cohesion {} MPa", 1e-6),
                                    ("Tensile strength", "tensile strength {} MPa", 1e-6),
                                    ("Key depth", "keys {} m deep", 1.)):
            if (value := run.number(f"Interfaces/{name}/{entry}")) > 0.:
                facts.append(text.format(f"{value * factor:g}"))
        if entries.get("Grouted after"):
            facts.append(f"grouted after {entries['Grouted after']}")
        words.append(f"{name} ({entries.get('Face sets', '')}): {', '.join(facts)}")
    return "Joints and planes: " + "; ".join(words) + "." if words else None


def earthquake_in_words(run):
    kind = run.entry("Ground motion/Type", "none")
    factor = run.number("Ground motion/Overload factor", 1.)
    peaks = []
    for d, where in DIRECTIONS.items():
        peak = run.entry(f"Ground motion/Peak acceleration {d}", "0")
        if peak != "as recorded":
            if float(peak) > 0.:
                peaks.append(f"{factor * float(peak):g} g {where}")
        elif kind == "record" and run.entry(f"Ground motion/Record/File {d}"):
            peaks.append(f"{factor:g} times that recorded {where}")
    files = dict.fromkeys(run.entry(f"Ground motion/Record/File {d}") for d in DIRECTIONS)
    source = f" ({', '.join(filter(None, files))})" if kind == "record" else ""
    return (f"{kind}{source}, given at the {run.entry('Ground motion/Given at')}"
            + (f", peaks of {listed(peaks)}" if peaks else "")
            + f"; it enters through the {run.entry('Wave field/Enters through')}")


def damping_in_words(run):
    model = run.entry("Damping/Model")
    if not model or model == "none":
        return "No damping."
    moduli = run.summary.get("damping", {})
    words = f"Damping: {model}, {100. * run.number('Damping/Ratio'):g} % of critical"
    if "moduli hold at [Hz]" in moduli and "relaxed modulus over the given one" in moduli:
        words += (f"; the moduli hold at {number(moduli['moduli hold at [Hz]'])} Hz; relaxed moduli are "
                  f"{number(moduli['relaxed modulus over the given one'])} times as large")
    return words + "."


def boundary_in_words(run):
    absorbing, fixed = run.entry("Boundaries/Absorbing"), run.entry("Boundaries/Fixed")
    return " ".join(text for text in (
        f"Waves leave through {absorbing} ({run.entry('Boundaries/Absorbing type')})."
        if absorbing else "", f"Fixed: {fixed}." if fixed else "") if text) or None


def differences(runs):
    """A table of the entries that differ between the runs."""
    paths = dict.fromkeys(path for run in runs for path in run.parameters)
    rows = [[path, *(run.entry(path, "–") or "empty" for run in runs)] for path in paths
            if len({run.entry(path, "–") for run in runs}) > 1
            and path not in ("Title", "Output/Folder")]
    if not rows:
        return "The runs have the same parameters."
    return Table(["entry", *(run.label for run in runs)], rows, "Entries that differ between the runs.")


def case_section(runs):
    first = runs[0]
    parts = [dam_in_words(first), SIGNS, materials_table(first), interfaces_in_words(first),
             loads_table(first), water_in_words(first), boundary_in_words(first), damping_in_words(first)]
    if len(runs) > 1:
        parts.insert(0, f"The first of the runs, {first.label}, in words:")
        parts.append(differences(runs))
    return Section("The case", [part for part in parts if part])


def moved(run):
    """Name and values of the point with the largest relative displacement."""
    points = {name: values for name, values in run.summary.get("histories", {}).items()
              if values["largest displacement [m]"] > 0.}
    relative = {name: values for name, values in points.items() if "relative to" in values}
    if not points:
        return None
    return max((relative or points).items(), key=lambda item: item[1]["largest displacement [m]"])


def largest_of(run, part, key, smallest=False):
    """Text of an extreme over the surfaces or blocks of the summary, with the name of the
    surface or block."""
    found = [(values[key], name) for name, values
             in run.summary.get("interfaces", {}).get(part, {}).items()
             if values.get(key) is not None]
    if not found:
        return None
    value, name = min(found) if smallest else max(found)
    return f"{number(value)} ({name})" if value > 1e-6 else "0"


def ground_peaks(run):
    table = run.table("ground_motion.csv")
    if table is None:
        return None
    return ", ".join(f"{match[1]} {number(abs(peak(table.time, values)[0]) / GRAVITY)}"
                     for match, values in table.matching(r"acceleration ([xyz]) \[m/s2\]"))


def of_moved(key, factor):
    def text(run):
        point = moved(run)
        return f"{number(point[1][key] * factor)} ({point[0]})" if point and key in point[1] else None
    return text


def moved_anywhere(run):
    """Text of the largest displacement of the dam in its envelopes [cm]."""
    dam = grids.dam_of(run)
    values = dam.grid.values.get("largest_displacement_m") if dam else None
    return None if values is None else number(100. * float(values[dam.grid.cells[dam.cells]].max()))


def of_summary(path, factor=1.):
    def text(run):
        value = run.summary
        for key in path.split("/"):
            if not isinstance(value, dict) or key not in value:
                return None
            value = value[key]
        return number(value if factor == 1. else value * factor)
    return text


def of_materials(key, factor=1.):
    def text(run):
        values = [entries[key] for entries in run.summary.get("materials", {}).values()
                  if key in entries]
        return number(max(values) * factor) if values else None
    return text


def first_frequency(run):
    modes = run.summary.get("modes", {}).get("modes")
    return number(modes[0]["frequency [Hz]"]) if modes else None


def energy_balance_error(run):
    share = run.summary.get("energy balance", {}).get("largest energy-balance error")
    return None if share is None else number(100. * share) if share > 1e-8 else "below 10⁻⁶"


def demand_over_strength(run):
    faces = {name: face for name, face in run.summary.get("over-stress", {}).items() if name != "verdict"}
    if not faces:
        return None
    name = max(faces, key=lambda name: faces[name]["largest ratio"])
    return f"{number(faces[name]['largest ratio'])} ({name})"


def headline_section(runs):
    table = comparison(runs, [
        ("first natural frequency [Hz]", first_frequency),
        ("peak of the input motion [g]", ground_peaks),
        ("largest displacement of a recorded point relative to the base, static one included [cm]",
         of_moved("largest displacement [m]", 100.)),
        ("largest displacement of any point of the dam, with the ground, static one included [cm]", moved_anywhere),
        ("largest acceleration of a recorded point relative to the base, filtered [g]",
         of_moved("largest filtered acceleration [m/s2]", 1. / GRAVITY)),
        ("largest arch tension on the faces [MPa]", of_summary("face stresses/largest arch stress [MPa]")),
        ("largest cantilever tension [MPa]", of_summary("face stresses/largest cantilever stress [MPa]")),
        ("largest principal tension [MPa]", of_summary("face stresses/largest principal stress [MPa]")),
        ("largest compression (smallest principal stress) [MPa]",
         of_summary("face stresses/smallest principal stress [MPa]")),
        ("largest opening of a joint or plane [mm]",
         lambda run: largest_of(run, "surfaces", "largest opening [mm]")),
        ("largest slip [mm]", lambda run: largest_of(run, "surfaces", "largest slip [mm]")),
        ("largest slip at the end [mm]", lambda run: largest_of(run, "surfaces", "residual slip [mm]")),
        ("largest slip rate at the end [mm/s]",
         lambda run: largest_of(run, "surfaces", "slip rate at the end [mm/s]")),
        ("dam open from face to face at one moment [mm]",
         of_summary("through cracks/largest opening from face to face at one moment [mm]")),
        ("largest demand over strength on the faces [-]", demand_over_strength),
        ("smallest safety of a block, resistance over driving forces [-]",
         lambda run: largest_of(run, "blocks", "smallest safety", smallest=True)),
        ("longest time of a block at one or below [s]",
         lambda run: largest_of(run, "blocks", "time at safety one or below [s]")),
        ("share of the concrete that left the elastic range [%]",
         of_materials("share of the volume that left the elastic range", 100.)),
        ("largest opening of cracks in a cell [mm]", of_materials("largest crack opening [mm]")),
        ("cells that had the lower strength at tips of cracks and notches", of_materials("cells at tips of cracks and notches")),
        ("energy-balance error, share of the input [%]", energy_balance_error),
    ])
    return Section("Main results", [table]) if table else None


def conclusions_section(runs):
    """The verdicts of each run."""
    return Section("Conclusions", [
        *(Verdicts(run.label if len(runs) > 1 else "", verdict.verdicts_of(run),
                   run.notes) for run in runs),
        "The acceptance table judges the criteria of the case, the numerical checks judge the solution of the "
        "equations, and the engineering results judge the response of the dam by the program's own criteria. Results "
        "without a limit are to be judged by the reader. None of the tables shows that the model is right."])


def input_entries_section(runs):
    """The input to repeat a run: the entries that are not default values, and the whole file."""
    parts = ["Entries of the parts that the case uses, where they differ from the default values of this version; with "
             "these entries the run can be repeated. All other entries have their default values."]
    for run in runs:
        parts.append(Block(f"{run.prefix}{len(run.own_entries)} entries", "\n".join(run.own_entries)))
        parts.append(Block(f"{run.prefix}all of parameters.prm", run.read("parameters.prm").strip(), folded=True))
    return Section("Complete input", parts)


def files_section(runs):
    """The files from which the report was made."""
    return Section("Files of this report", [Table(["file", "SHA-256"], [
        [f"{run.folder}/{name}", Digest(digest)] for run in runs for name, digest in run.digests])])


def statistics_section(runs):
    table = comparison(runs, [
        ("program", lambda run: run.summary.get("version")),
        ("built with", lambda run: next(iter(re.findall(r"^Voussoir .* with (.+)$", run.log, re.MULTILINE)), None)),
        ("cells", of_summary("cells")), ("unknowns", of_summary("unknowns")),
        ("degree of the elements", of_summary("degree")),
        ("time step [ms]", of_summary("time step [s]", 1e3)),
        ("largest stable step [ms]", of_summary("largest stable step [s]", 1e3)),
        ("steps", of_summary("steps")), ("time covered [s]", of_summary("end time [s]")),
        ("ranks", of_summary("ranks")), ("SIMD [bit]", of_summary("SIMD bits")),
        ("static state [s]", of_summary("static state/seconds")),
        ("time loop [s]", of_summary("loop time [s]")),
        ("share of contact [%]", of_summary("contact share of the loop", 100.)),
        ("time of the cells, largest over mean of the ranks",
         of_summary("time of cells, largest over mean of the ranks")),
        ("speed [million unknowns · steps / s]", of_summary("MDOF-steps/s")),
        ("memory of the largest rank [MB]", of_summary("peak memory of a rank [MB]")),
    ])
    return Section("Version and effort of the run", [table])
