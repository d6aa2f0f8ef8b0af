#!/usr/bin/env python3
"""Writes verification.md beside this file: what the tests compare with closed
forms, published values and conservation laws, and how far off it was.

usage: doc/verification.py [--check]    (--check: fails if the page is not as
                                         this would write it)

The figures are those of the reference outputs, tests/*/*.output, which a test
must reproduce to four digits.
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
BOUNDED = re.compile(rf"^(?P<what>.*) below {NUMBER}  ok$")


def subject(case):
    """The sentences at the head of a parameter file."""
    words = []
    for line in case.read_text().splitlines():
        if not line.startswith("#"):
            break
        words.append(line.lstrip("# ").rstrip())
    return " ".join(words)


def worst_comparison(lines):
    """Number of comparisons, and the one that uses most of what is allowed."""
    count, worst = 0, None
    for line in lines:
        match = COMPARED.match(line)
        if not match or float(match[5]) == 0:
            continue
        count += 1
        value, reference, allowed = (float(match[i]) for i in (2, 4, 5))
        error = abs(value - reference) / abs(reference) * 100 if reference else 0.0
        if worst is None or error / allowed > worst[0]:
            unit = " " + match["unit"] if match["unit"] else ""
            worst = (
                error / allowed,
                f"{match['what'].strip()}: {match[2]}{unit}",
                f"{match[4]}{unit}",
                f"{error:.2g} %",
                f"{allowed:g} %",
            )
    return count, worst


def smallest_bound(lines):
    bounds = [BOUNDED.match(line) for line in lines]
    bounds = [(float(b[2]), b["what"].strip()) for b in bounds if b]
    return len(bounds), min(bounds, default=None)


def page():
    compared, bounded = [], []
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
            compared.append(
                f"| `{name}` | {subject(case)} | {count} | {worst[1]} "
                f"| {worst[2]} | {worst[3]} | {worst[4]} |"
            )
        else:
            count, bound = smallest_bound(lines)
            if bound:
                bounded.append(
                    f"| `{name}` | {subject(case)} | {count} | {bound[1]} "
                    f"| {bound[0]:g} |"
                )
    return "\n".join(
        [
            "# What is checked against what",
            "",
            "Written by `doc/verification.py` from the reference outputs of the tests; "
            "`./bootstrap test -R NAME` runs one of them again. The tests' sources, "
            "`tests/checks`, say where each reference comes from.",
            "",
            "## Numbers against references",
            "",
            "Of each test the comparison that uses most of what is allowed. A "
            "difference of 0 means: none in four digits.",
            "",
            "| test | subject | comparisons | measured | reference | off by | allowed |",
            "|---|---|---|---|---|---|---|",
            *compared,
            "",
            "## Errors against bounds",
            "",
            "Tests that look at differences only: to an exact solution, to another way "
            "of computing the same, of a balance. Of each the narrowest bound.",
            "",
            "| test | subject | bounds | what | below |",
            "|---|---|---|---|---|",
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
