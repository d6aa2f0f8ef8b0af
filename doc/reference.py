#!/usr/bin/env python3
"""Writes the generated parts of reference.md, all entries of the program, and of
cases.md, the heads of the shipped cases, so that both are readable without
building.

usage: doc/reference.py [cases]     (cases: cases.md alone, without the program)

The program is build/voussoir, or $VOUSSOIR. The manual (conf.py) is not built
while a page is out of date.
"""
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MARK = "\n<!-- From here on written by doc/reference.py. -->\n"

problems = []  # of the entries and cases, for the manual


# ------------------------------------------------------ entries of the program


def ask(*arguments):
    program = os.environ.get("VOUSSOIR", ROOT / "build" / "voussoir")
    return subprocess.run(
        [program, *arguments], check=True, capture_output=True, text=True
    ).stdout


def classes(kind):
    """Name and description of each class of a kind, as the program lists them."""
    return dict(line.split(": ", 1) for line in ask("--list", kind).splitlines())


def is_entry(node):
    return isinstance(node.get("value"), str)


def without_case(node):
    """A node without members that depend on the printed case."""
    if is_entry(node):
        node = {**node, "value": node["default_value"], "pattern": ""}
    return node


def plain(text):
    """Text with the special characters of Markdown escaped."""
    return re.sub(r"([\\`*<>\[\]|$~^]|(?<!\w)_|_(?!\w))", r"\\\1", text)


def allowed(pattern):
    """Allowed values of an entry, from deal.II's description of its pattern."""
    number = re.match(r"\[(Double|Integer)(?: range)? (\S+?)\.\.\.(\S+)", pattern)
    if number:
        word = {"Double": "number", "Integer": "whole number"}[number[1]]
        low, high = (re.sub(r"^-?(MAX_DOUBLE|214748364\d)$", "", number[i]) for i in (2, 3))
        return word + (f" from {low}" if low else "") + (f" to {high}" if high else "")
    choice = re.match(r"\[(Multiple)?Selection (.*?) ?\]$", pattern)
    if choice:
        words = ", ".join(f"`{word.strip()}`" for word in choice[2].split("|"))
        return ("any of " if choice[1] else "one of ") + words
    length = re.search(r"\[List of .* of length (\d+)\.\.\.(\d+)", pattern)
    if length:
        return f"{length[1]} values" if length[1] == length[2] else "list"
    if "[Bool" in pattern:
        return "`true` or `false`"
    return "whole number" if "[Integer" in pattern else "number" if "[Double" in pattern else "text"


def entry(name, node, place):
    """A line of a definition list."""
    if not node["documentation"]:
        problems.append("the entry %s/%s has no description" % (place, name))
    default = f"`{node['default_value']}`" if node["default_value"].strip() else "empty"
    return (
        f"**{plain(name)}** ({allowed(node['pattern_description'])}; default: {default})\n"
        f": {plain(node['documentation'])}\n\n"
    )


def entries(section, place, depth):
    """The entries of a section and of those in it."""
    text = "".join(entry(n, e, place) for n, e in section.items() if is_entry(e))
    for name, inner in section.items():
        if not is_entry(inner):
            text += f"{'#' * depth} {name}\n\n" + entries(inner, f"{place}/{name}", depth + 1)
    return text


def by_class(section, place, kind, chosen_by):
    """The entries of a section with an inner one for each class: first those that
    all classes share, then those of each class."""
    listed = classes(kind)
    for name in listed.keys() - section.keys():
        problems.append("%s has no section for its class %s" % (place, name))
    inner = {name: section[name] for name in listed if name in section}
    common = {}
    if chosen_by and len(inner) > 1:
        common = {
            name: node
            for name, node in next(iter(inner.values())).items()
            if all(other.get(name) == node for other in inner.values())
        }
    text = "".join(entry(n, e, place) for n, e in section.items() if is_entry(e))
    if common:
        text += f"### Entries of every section {place}/NAME\n\n" + entries(common, place, 4)
    for name, node in section.items():
        if is_entry(node):
            continue
        own = {n: e for n, e in node.items() if n not in common}
        title = f"{chosen_by} = {name}" if chosen_by else name
        text += f"### {title}\n\n"
        if name in listed:
            text += plain(listed[name]) + "\n\n"
        text += entries(own, f"{place}/{name}", 4)
    return text


# the kind of the classes in a section, and the entry that chooses one
KINDS = {
    "Mesh": ("meshes", None),
    "Interfaces": ("interfaces", "Law"),
    "Materials": ("materials", "Class"),
    "Loads": ("loads", "Class"),
    "Constraints": ("constraints", "Class"),
    "Output": ("observers", None),
}


def reference():
    """All entries of the program, section by section in alphabetical order."""
    tree = json.loads(ask("--defaults", "json"), object_hook=without_case)
    text = "## At the top level\n\n"
    text += "".join(entry(n, e, "") for n, e in tree.items() if is_entry(e))
    for name, section in sorted(tree.items()):
        if is_entry(section):
            continue
        text += f"## {name}\n\n"
        if name in KINDS:
            text += by_class(section, name, *KINDS[name])
        else:
            text += entries(section, name, 3)
    return text


# ------------------------------------------------------------- the shipped cases


def heading(case):
    """The comment at the head of a parameter file: its first sentence, and the texts
    after the words Purpose, Cost and so on."""
    lines = []
    for line in case.read_text().splitlines():
        if not line.startswith("#"):
            break
        lines.append(line[1:].strip())
    text, *parts = re.split(r"\b(Purpose|Shows|Cost|Takes|Source|Expected):", " ".join(lines))
    return text, list(zip(parts[::2], parts[1::2]))


def cases():
    """Title and head of each shipped case."""
    text = ""
    for case in sorted((ROOT / "prm").rglob("*.prm")):
        title, parts = heading(case)
        if len(parts) < 3:
            problems.append("%s does not begin with its purpose, cost and expected result" % (case,))
        text += f"## `{case.relative_to(ROOT)}`\n\n{plain(title.strip())}\n\n"
        text += "".join(f"{name}\n: {plain(what.strip())}\n\n" for name, what in parts)
    return text


# ------------------------------------------------------------------- the pages

GENERATED = {"reference": reference, "cases": cases}


def written(page):
    """A page with its generated part made anew."""
    text = (ROOT / "doc" / f"{page}.md").read_text()
    return text.split(MARK)[0].rstrip() + "\n" + MARK + "\n" + GENERATED[page]().rstrip() + "\n"


def main():
    for page in sys.argv[1:] or GENERATED:
        (ROOT / "doc" / f"{page}.md").write_text(written(page))
    sys.exit("\n".join(problems) if problems else 0)


if __name__ == "__main__":
    main()
