"""Sphinx configuration of the manual: ./bootstrap manual. Entries and classes of
the reference come from the program itself, and files that the pages name must exist; missing ones give a warning, which ./bootstrap manual makes an error.
"""
import json
import os
import pathlib
import re
import subprocess

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from pygments.lexer import RegexLexer, bygroups
from pygments.lexers import CppLexer
from pygments.token import Comment, Keyword, Name, Number, Operator, String, Text
from sphinx.util import logging

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("VOUSSOIR", ROOT / "build" / "voussoir")
warn = logging.getLogger(__name__).warning

project = "Voussoir"
html_title = "Voussoir"
html_theme = "furo"
html_static_path = ["manual.css"]
html_css_files = ["manual.css"]
html_show_copyright = False
highlight_language = "none"
html_math_renderer = "mathml"
extensions = ["myst_parser"]
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # an included page begins at its own level
nitpicky = True
smartquotes = False  # texts in quotation marks are often typed


# ------------------------------------------------------ entries of the program


def ask(*arguments):
    return subprocess.run(
        [PROGRAM, *arguments], check=True, capture_output=True, text=True
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
    """Text that Markdown leaves as it is."""
    return re.sub(r"([\\`*_<>\[\]|$~^])", r"\\\1", text)


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
        warn("the entry %s/%s has no description", place, name)
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
    """The entries of a section with an inner one for each class: those that all
    classes share first, each class with its own ones."""
    listed = classes(kind)
    for name in listed.keys() - section.keys():
        warn("%s has no section for its class %s", place, name)
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


# -------------------------------------------------------- files of the checkout


def heading(case):
    """The comment at the head of a parameter file: its first sentence, and what
    follows the words Purpose, Cost and so on."""
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
            warn("%s does not begin with its purpose, cost and expected result", case)
        text += f"## `{case.relative_to(ROOT)}`\n\n{plain(title)}\n\n"
        text += "".join(f"{name}\n: {plain(what.strip())}\n\n" for name, what in parts)
    return text


def fill(app, page, source):
    """Puts what is generated into a page, and looks for the files it names."""
    made = {"reference": reference, "cases": cases}
    if page in made:
        source[0] += "\n" + made[page]()
    new = re.findall(r"(?:Put this into|called) `(\S+)`", source[0])
    for name in re.findall(r"\b(?:source|include|tests|prm|report|doc)/[a-z\d_./]+\w", source[0]):
        if "." in name.rsplit("/", 1)[1] and name not in new and not (ROOT / name).exists():
            warn("%s is named, but there is no such file", name, location=page)


def look_around(app, environment):
    """The pages tell where each of the shipped cases comes in, links of the README
    lead somewhere, and messages that are explained are those of the program."""
    for target in re.findall(r"\]\(([^):#]+)[#)]", (ROOT / "README.md").read_text()):
        if not (ROOT / target).exists():
            warn("README.md has a link to %s, which is not there", target)
    pages = "".join(path.read_text() for path in (ROOT / "doc").glob("*.md"))
    for case in (ROOT / "prm").rglob("*.prm"):
        if str(case.relative_to(ROOT)) not in pages:
            warn("no page names %s", case.relative_to(ROOT))
    said = re.sub(
        r'"\s*"', "", "".join(path.read_text() for path in (ROOT / "source").rglob("*.cc"))
    ).replace('\\"', '"')
    page = (ROOT / "doc" / "troubleshooting.md").read_text()
    for message in re.findall(r"^`.*`$", page, re.M):
        for part in re.split(r"` and `| \.\.\. | \.\.\.|^`|`$", message):
            if part not in said:
                warn("troubleshooting.md explains a message that no source has: %s", part)


# ------------------------------------------------------------------ appearance


class ParameterFileLexer(RegexLexer):
    """deal.II's parameter files."""

    name = "prm"
    tokens = {
        "root": [
            (r"#.*", Comment),
            (r"(subsection)([^\S\n]+)([^#\n]+)", bygroups(Keyword, Text, Name.Class)),
            (r"(set)([^\S\n]+)([^=#\n]+)(=)", bygroups(Keyword, Text, Name.Attribute, Operator)),
            (r"end\b|include\b", Keyword),
            (r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?", Number),
            (r"[^\s#\d-]+", String),
            (r"\s+|.", Text),
        ]
    }


def mathml(tex, block):
    try:
        return tex2mathml(tex, as_block=block)
    except TypeError:  # docutils before 0.20
        return tex2mathml(tex, inline=not block)


def write_inline(writer, node):
    writer.body.append(mathml(node.astext(), False))
    raise nodes.SkipNode


def write_display(writer, node):
    writer.body.append(f'<div class="math">{mathml(node.astext(), True)}</div>')
    raise nodes.SkipNode


def setup(app):
    app.add_lexer("prm", ParameterFileLexer)
    app.add_lexer("geo", CppLexer)  # Gmsh's scripts look alike
    app.add_html_math_renderer("mathml", (write_inline, None), (write_display, None))
    app.connect("source-read", fill)
    app.connect("env-updated", look_around)
