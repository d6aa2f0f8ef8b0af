"""The parts of a page, and their conversion to HTML or PDF."""

import base64
import dataclasses
import datetime
import gzip
import importlib.util
import os
import pathlib
import re

import jinja2
import numpy as np

from .files import ReportError


RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class Digest(str):
    """A hash, which must be broken to fit into a table."""


class Judged(str):
    """A result with the colour of its judgement."""

    def __new__(cls, text, colour=""):
        judged = super().__new__(cls, text)
        judged.colour = colour
        return judged


@dataclasses.dataclass
class Table:
    """Rows of texts under a heading; the first column names the row. On a screen a table is @p folded behind a title,
    if it has one."""

    head: list
    rows: list
    caption: str = ""
    folded: str = ""


@dataclasses.dataclass
class Pictures:
    """Pictures in rows of a number of columns."""

    pictures: list
    columns: int = 2
    title: str = ""


@dataclasses.dataclass
class Scene:
    """A scene that turns in the browser, as JSON, and the picture that replaces the scene
    on paper and where it cannot be drawn."""

    data: str
    picture: object
    factor: float = 0.  # largest magnification of the motion
    time: str = ""
    bar: object = None  # picture of the colour bar
    left_out: str = ""  # of the motion

    @property
    def caption(self):
        return self.picture.caption

    @property
    def pictures(self):
        return [self.picture]


@dataclasses.dataclass
class Verdicts:
    """The verdicts of a run."""

    label: str
    verdicts: list
    notes: list


@dataclasses.dataclass
class Block:
    """Preformatted text, such as an input file; @p folded behind its title on a screen."""

    title: str
    text: str
    folded: bool = False


@dataclasses.dataclass
class Section:
    """A part of the page: paragraphs, tables and pictures in turn."""

    title: str
    parts: list

    @property
    def anchor(self):
        return self.title.lower().replace(" ", "-").replace(",", "")

    @property
    def pictures(self):
        return [picture for part in self.parts if isinstance(part, (Pictures, Scene))
                for picture in part.pictures]


def number(value, digits=3):
    """Text of a number with this many significant digits and thousands set apart; integers
    with all digits."""
    if isinstance(value, (int, np.integer)):
        return f"{value:,}".replace(",", "\u202f")
    if value is None or value != value or value in (float("inf"), float("-inf")):
        return "–"
    if abs(value) < 1e-9:
        return "0"
    size = f"{abs(value):.{digits - 1}e}"
    exponent = int(size.split("e")[1])
    if not -4 < exponent < 12:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{mantissa}·10".replace("-", "−") + str(int(exponent)).translate(RAISED)
    decimals = max(digits - 1 - exponent, 0)
    rounded = round(value, digits - 1 - exponent)
    return f"{rounded:,.{decimals}f}".replace(",", "\u202f").replace("-", "−")


def comparison(runs, rows, caption=""):
    """A table with a column for each run and rows (heading, function of the run), where a
    function returns None if there is no value; rows without any value are left out."""
    table = Table(["", *(run.label for run in runs if len(runs) > 1)], [], caption)
    for what, function in rows:
        answers = [function(run) for run in runs]
        if any(answer is not None for answer in answers):
            table.rows.append([what, *("–" if answer is None else answer for answer in answers)])
    return table if table.rows else None


def to_html(runs, sections):
    loader = jinja2.FileSystemLoader(pathlib.Path(__file__).parent)
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True)
    for name, kind in (("table", Table), ("pictures", Pictures), ("verdicts", Verdicts), ("block", Block),
                       ("scene", Scene), ("digest", Digest), ("judged", Judged)):
        environment.tests[name] = lambda part, kind=kind: isinstance(part, kind)
    return environment.get_template("page.html").render(
        runs=runs, sections=sections, folders=folders_of(runs), date=datetime.date.today().isoformat(),
        program=scene_program(sections))


def folders_of(runs):
    """The folders of the results; a common parent is named once."""
    parents = {str(pathlib.Path(run.folder).parent) for run in runs}
    if len(runs) > 1 and len(parents) == 1:
        return f"{parents.pop()}: {', '.join(pathlib.Path(run.folder).name for run in runs)}"
    return ", ".join(str(run.folder) for run in runs)


def scene_program(sections):
    """The program that turns the scenes of a page, packed; None without scenes or vtk.js."""
    file = vtk_js()
    if file is None or not any(isinstance(part, Scene) for section in sections for part in section.parts):
        return None
    script = pathlib.Path(__file__).with_name("scene.js").read_text(encoding="utf-8")
    licence = file.with_name("LICENSE")
    return {"licence": licence.read_text(encoding="utf-8") if licence.is_file() else "BSD 3-Clause, Kitware Inc.",
            "library": base64.b64encode(gzip.compress(file.read_bytes(), 9, mtime=0)).decode(),
            "script": script}


def vtk_js():
    """The file of VTK for browsers, or None where it is not installed."""
    own = os.environ.get("VOUSSOIR_VTK_JS")
    here = pathlib.Path(__file__).resolve()
    # in the sources, as installed, or by a package of its own
    places = [pathlib.Path(own)] if own else [
        here.parents[3] / "build" / "vtk.js" / "package" / "vtk.js",
        here.parents[1] / "vtk.js" / "vtk.js",
        *(pathlib.Path(prefix) / "vtk.js" / "vtk.js" for prefix in (
            "/usr/share/nodejs", "/usr/local/lib/node_modules", "/usr/lib/node_modules"))]
    return next((file for file in places if file.is_file()), None)


def check(file):
    """Refuses a page that cannot be written; its name ends in .html or .pdf."""
    if not os.access(file if file.exists() else file.parent, os.W_OK) or file.is_dir():
        raise ReportError(f'"{file}" cannot be written; choose another file with --output.')
    if file.suffix == ".pdf" and importlib.util.find_spec("weasyprint") is None:
        raise ReportError("A PDF needs the package weasyprint; install it, or write HTML "
                          "and print the page from a browser.")


def write(runs, sections, file):
    """Writes the page; its name ends in .html or .pdf."""
    text = to_html(runs, sections)
    try:
        if file.suffix == ".pdf":
            import weasyprint
            weasyprint.HTML(string=text).write_pdf(file)
        else:
            file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise ReportError(f'"{file}" cannot be written: {error.strerror}; '
                          "choose another file with --output.") from None


def write_pictures(sections, folder):
    """Writes each picture as a file."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for section in sections:
            for picture in section.pictures:
                name = re.sub(r"[^\w.-]+", "_", picture.name)
                (folder / f"{name}.{picture.kind}").write_bytes(picture.data)
    except OSError as error:
        raise ReportError(f'The pictures cannot be written to "{folder}": {error.strerror}; '
                          "choose another folder.") from None
