"""Sphinx configuration of the manual, ./bootstrap manual, with checks of its pages: a
failed check is a warning, which ./bootstrap manual turns into an error.
"""
import pathlib
import re
import sys

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from pygments.lexer import RegexLexer, bygroups
from pygments.lexers import CppLexer
from pygments.token import Comment, Keyword, Name, Number, Operator, String, Text
from sphinx.util import logging

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "doc"))
import reference  # noqa: E402

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
smartquotes = False  # quoted texts are often to be typed


# -------------------------------------------------------- files of the checkout


def check_generated(app, page, source):
    """Warns of a page whose generated part differs from the entries of the program or
    the heads of the cases."""
    if page in reference.GENERATED:
        written = reference.written(page)
        if (ROOT / "doc" / f"{page}.md").read_text() != written:
            warn("%s.md is out of date; run doc/reference.py", page)
        for problem in reference.problems:
            warn("%s", problem)
        reference.problems.clear()


def check_names(app, page, source):
    """Warns of missing files that a page names."""
    new = re.findall(r"(?:Put this into|called) `(\S+)`", source[0])
    for name in re.findall(r"\b(?:source|include|tests|prm|report|doc)/[a-z\d_./]+\w", source[0]):
        if "." in name.rsplit("/", 1)[1] and name not in new and not (ROOT / name).exists():
            warn("%s is named, but there is no such file", name, location=page)


def check_pages(app, environment):
    """Warns of shipped cases that no page names, of links of the README without a
    target, and of explained messages that the program does not have."""
    for target in re.findall(r"\]\(([^):#]+)[#)]", (ROOT / "README.md").read_text()):
        if not (ROOT / target).exists():
            warn("README.md has a link to %s, which does not exist", target)
    pages = "".join(
        path.read_text().split(reference.MARK)[0] for path in (ROOT / "doc").glob("*.md")
    )
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
    app.connect("source-read", check_generated)
    app.connect("source-read", check_names)
    app.connect("env-updated", check_pages)
