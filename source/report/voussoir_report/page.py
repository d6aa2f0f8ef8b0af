"""The parts of a page, and how they become HTML or PDF."""

import dataclasses
import datetime
import importlib.util
import os
import pathlib
import re

import jinja2
import numpy as np

from .files import ReportError


RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclasses.dataclass
class Table:
    """Rows of texts under a heading; the first column says what stands in the others."""

    head: list
    rows: list
    caption: str = ""


@dataclasses.dataclass
class Pictures:
    """Pictures in rows of so many."""

    pictures: list
    columns: int = 2
    title: str = ""


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
        return [picture for part in self.parts if isinstance(part, Pictures)
                for picture in part.pictures]


def number(value, digits=3):
    """With so many significant digits, thousands apart, as people write it; whole
    numbers with all of theirs."""
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
    """A table with a column for each run of rows (what, function of the run), where a
    function that has no answer returns None; rows without any answer are left out."""
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
    environment.tests["table"] = lambda part: isinstance(part, Table)
    environment.tests["pictures"] = lambda part: isinstance(part, Pictures)
    return environment.get_template("page.html").render(
        runs=runs, sections=sections, date=datetime.date.today().isoformat())


def check(file):
    """Refuses a page, whose name ends in .html or .pdf, that cannot be written."""
    if not os.access(file if file.exists() else file.parent, os.W_OK) or file.is_dir():
        raise ReportError(f'"{file}" cannot be written; choose another file with --output.')
    if file.suffix == ".pdf" and importlib.util.find_spec("weasyprint") is None:
        raise ReportError("A PDF needs the package weasyprint; install it, or write HTML "
                          "and print that from a browser.")


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
    """Each picture as a file."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for section in sections:
            for picture in section.pictures:
                name = re.sub(r"[^\w.-]+", "_", picture.name)
                (folder / f"{name}.png").write_bytes(picture.png)
    except OSError as error:
        raise ReportError(f'The pictures cannot be written to "{folder}": {error.strerror}; '
                          "choose another folder.") from None
