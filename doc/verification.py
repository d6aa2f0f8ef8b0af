#!/usr/bin/env python3
"""Writes verification.md beside this file: what the tests compare with closed
forms, published values and conservation laws, and how far off it was.

usage: doc/verification.py [--check]    (--check: fails if the page is not as
                                         this would write it)

The figures are those of the reference outputs, tests/*/*.output, which a test
must reproduce to four digits, or come nearer to the reference. What the
reference is, a line "// Reference: KIND" says above where tests/checks/*.cc
registers the check, or "# Reference: KIND" at the head of a parameter file.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "doc" / "verification.md"
NUMBER = r"([-+.\deE]+|nan|inf)"
COMPARED = re.compile(
    rf"^(?P<what>.*) = {NUMBER}(?: (?P<unit>.*?))?  "
    rf"\(reference {NUMBER}, allowed {NUMBER} %\)  ok$"
)
REGISTERED = re.compile(
    r"// Reference: (.*)\n\s*const Registry<Check>::Add<\w+>\s*\w+\(\s*\"([^\"]+)\""
)
KINDS = {
    "closed form": "a closed form, a conservation law, or geometry by hand",
    "published": "a published figure",
    "other program": "another program's result, or another way of computing the "
    "same that is written for the test alone and shares nothing with Voussoir",
    "Voussoir": "the program itself: two ways to the same result, a balance by its "
    "own account, or a bound that it sets itself",
}
BOUNDED = re.compile(rf"^(?P<what>.*) below {NUMBER}  ok$")


def subject(case):
    """The sentences at the head of a parameter file."""
    words = []
    for line in case.read_text().splitlines():
        if not line.startswith("#"):
            break
        if not line.startswith("# Reference: "):
            words.append(line.lstrip("# ").rstrip())
    return " ".join(words)


def text_of(case):
    """A parameter file with what it includes."""
    return re.sub(
        r"^include (\S+)$",
        lambda line: text_of(case.parent / line[1]),
        case.read_text(),
        flags=re.M,
    )


def kind_of_reference(case, kinds_of_checks):
    said = re.search(r"^# Reference: (.*)$", case.read_text(), re.M)
    if said:
        kind = said[1]
    else:
        name = re.search(r"^subsection Check\s+set Name *= *(.*?)\s*$", text_of(case), re.M)
        kind = kinds_of_checks.get(name[1]) if name else None
    if kind not in KINDS:
        sys.exit(
            f"{case.relative_to(ROOT)}: with what does it compare? Say it by a line "
            f'"// Reference: KIND" in tests/checks, one of: {", ".join(KINDS)}.'
        )
    return kind


def counts(rows):
    """Of a list of kinds."""
    return ", ".join(f"{kind} {rows.count(kind)}" for kind in KINDS)


def last_digit(number):
    """A unit of the last digit of a number as it is written."""
    mantissa, _, exponent = number.lower().partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def worst_comparison(lines):
    """Number of comparisons, and the one that uses most of what is allowed."""
    count, worst = 0, None
    for line in lines:
        match = COMPARED.match(line)
        if not match or float(match[5]) == 0:
            continue
        count += 1
        value, reference, allowed = (float(match[i]) for i in (2, 4, 5))
        scale = 100 / abs(reference) if reference else 0.0
        error = abs(value - reference) * scale
        off = f"{error:.2g} %"
        if error > allowed:
            # both are rounded, the test compares all digits
            rounding = 0.5 * (last_digit(match[2]) + last_digit(match[4])) * scale
            if error - rounding > allowed:
                sys.exit(f"{line}\nis off by more than is allowed.")
            error, off = allowed, f"≤ {allowed:g} %"
        if worst is None or error / allowed > worst[0]:
            unit = " " + match["unit"] if match["unit"] else ""
            worst = (
                error / allowed,
                f"{match['what'].strip()}: {match[2]}{unit}",
                f"{match[4]}{unit}",
                off,
                f"{allowed:g} %",
            )
    return count, worst


def smallest_bound(lines):
    bounds = [BOUNDED.match(line) for line in lines]
    bounds = [(float(b[2]), b["what"].strip()) for b in bounds if b]
    return len(bounds), min(bounds, default=None)


def page():
    compared, bounded, kinds_compared, kinds_bounded = [], [], [], []
    kinds_of_checks = {}
    for source in ROOT.glob("tests/checks/*.cc"):
        for kind, name in REGISTERED.findall(source.read_text()):
            kinds_of_checks[name] = kind
    for output in sorted(ROOT.glob("tests/*/*.output")):
        if ".mpirun=" in output.name:
            continue
        case = output.with_suffix(".prm")
        if not case.exists():
            continue
        name = f"{output.parent.name}/{output.stem}"
        lines = output.read_text(errors="replace").splitlines()
        count, worst = worst_comparison(lines)
        if worst:
            kinds_compared.append(kind_of_reference(case, kinds_of_checks))
            compared.append(
                f"| `{name}` | {subject(case)} | {kinds_compared[-1]} | {count} "
                f"| {worst[1]} | {worst[2]} | {worst[3]} | {worst[4]} |"
            )
        else:
            count, bound = smallest_bound(lines)
            if bound:
                kinds_bounded.append(kind_of_reference(case, kinds_of_checks))
                bounded.append(
                    f"| `{name}` | {subject(case)} | {kinds_bounded[-1]} | {count} "
                    f"| {bound[1]} | {bound[0]:g} |"
                )
    return "\n".join(
        [
            "# What is checked against what",
            "",
            "Written by `doc/verification.py` from the reference outputs of the tests; "
            "`./bootstrap test -R NAME` runs one of them again. The tests' sources, "
            "`tests/checks`, say where each reference comes from. It is one of:",
            "",
            *(f"- {kind}: {meaning};" for kind, meaning in list(KINDS.items())[:-1]),
            *(f"- {kind}: {meaning}." for kind, meaning in list(KINDS.items())[-1:]),
            "",
            f"{len(compared) + len(bounded)} tests: {counts(kinds_compared + kinds_bounded)}. "
            "Tests of files, messages and refusals compare texts and are not listed.",
            "",
            "## Numbers against references",
            "",
            "Of each test the comparison that uses most of what is allowed. A "
            "difference of 0 means: none in the digits printed; with ≤, these digits do "
            "not distinguish it from what is allowed, which the test holds in full "
            "precision. By reference: "
            f"{counts(kinds_compared)}.",
            "",
            "| test | subject | reference is | comparisons | measured | reference | off by | allowed |",
            "|---|---|---|---|---|---|---|---|",
            *compared,
            "",
            "## Errors against bounds",
            "",
            "Tests of differences only: to an exact solution, to another way "
            "of computing the same, of a balance. Of each the narrowest bound. By "
            f"reference: {counts(kinds_bounded)}.",
            "",
            "| test | subject | reference is | bounds | what | below |",
            "|---|---|---|---|---|---|",
            *bounded,
            "",
        ]
    )


def main():
    text = page()
    if "--check" in sys.argv[1:]:
        if not PAGE.exists() or PAGE.read_text() != text:
            sys.exit("doc/verification.md is not what doc/verification.py writes; run it.")
    else:
        PAGE.write_text(text)


if __name__ == "__main__":
    main()
