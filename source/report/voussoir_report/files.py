"""Reads the files of a result folder, and refuses damaged ones."""

import base64
import csv
import dataclasses
import io
import json
import math
import pathlib
import re
import xml.parsers.expat

import numpy as np


class ReportError(Exception):
    """A mistake in arguments or files that makes a report impossible, in one sentence."""


def refuse(file, what, remedy="run the case again, or remove the file for a report without it"):
    raise ReportError(f'"{file}" {what}; {remedy}.')


def read_bytes(file):
    try:
        return pathlib.Path(file).read_bytes()
    except OSError as error:
        refuse(file, f"cannot be read: {error.strerror}")


def is_number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True


def csv_rows(file):
    """The heading and the lines of a file of comma-separated values, as texts."""
    data = read_bytes(file)
    if b"\0" in data:
        refuse(file, f"has NUL bytes from byte {data.index(0)} on, as if it had been removed or "
                     "replaced while the run wrote to it")
    if not data.strip():
        refuse(file, "is empty")
    try:
        rows = list(csv.reader(io.StringIO(data.decode(), newline=""), strict=True))
    except UnicodeDecodeError:
        refuse(file, "is no text")
    except csv.Error as error:
        refuse(file, f"is no table of comma-separated values ({error})")
    if not data.endswith(b"\n"):
        refuse(file, "is cut, as its last line has no end")
    heading = rows[0]
    if not heading or any(is_number(title) for title in heading):
        refuse(file, "has no heading in its first line")
    for number, row in enumerate(rows[1:], 2):
        if len(row) != len(heading):
            refuse(file, f"has {len(row)} values in line {number} under {len(heading)} headings")
    # the apostrophe keeps spreadsheets from taking a title for a formula
    return [re.sub(r"^'(?=[=+@\t\r-])", "", title) for title in heading], rows[1:]


class Table:
    """A file of comma-separated numbers whose first column increases."""

    def __init__(self, file, first):
        self.file = file
        self.titles, rows = csv_rows(file)
        if not rows:
            refuse(file, "has no lines below its heading")
        if self.titles[0] != first:
            refuse(file, f'begins with the column "{self.titles[0][:40]}" where "{first}" should be')
        try:
            # an empty cell stands for no number
            self.values = np.array([[float(cell or "inf") for cell in row] for row in rows])
        except ValueError:
            line, word = next((line, cell) for line, row in enumerate(rows, 2) for cell in row
                              if cell and not is_number(cell))
            refuse(file, f'has "{word[:40]}" in line {line}, which is no number')
        if not np.isfinite(self.time).all() or (np.diff(self.time) <= 0.).any():
            refuse(file, f'has numbers in its column "{first}" that do not increase')

    def __contains__(self, title):
        return title in self.titles

    def __getitem__(self, title):
        if title not in self.titles:
            refuse(self.file, f'has no column "{title}"')
        return self.values[:, self.titles.index(title)]

    @property
    def time(self):
        """[s]"""
        return self.values[:, 0]

    def matching(self, pattern):
        """Match and column of each title that a regular expression matches as a whole."""
        found = [(re.fullmatch(pattern, title), i) for i, title in enumerate(self.titles)]
        return [(match, self.values[:, i]) for match, i in found if match]


@dataclasses.dataclass
class Group:
    """Schema of an object of a JSON file: the kinds of its entries, by name, and
    the kind of all others; None for entries that a report does not read."""

    required: dict = dataclasses.field(default_factory=dict)
    optional: dict = dataclasses.field(default_factory=dict)
    others: object = None


TEXT, NUMBER, NUMBER_OR_NONE = "a text", "a number", "a number or null"


def as_kind(value, kind, refuse_at, place=""):
    """A value of JSON, in which null for a number becomes NaN; calls
    refuse_at(place, expected kind) for a value of another kind."""
    if isinstance(kind, Group):
        if not isinstance(value, dict):
            refuse_at(place, "an object")
        for name in kind.required:
            if name not in value:
                refuse_at(f"{place}/{name}".lstrip("/"), "something")
        known = {**kind.required, **kind.optional}
        return {name: as_kind(part, known.get(name, kind.others), refuse_at, f"{place}/{name}".lstrip("/"))
                for name, part in value.items()}
    if isinstance(kind, list):
        if not isinstance(value, list):
            refuse_at(place, "a list")
        return [as_kind(part, kind[0], refuse_at, f"{place}/{i}") for i, part in enumerate(value)]
    if kind is TEXT:
        if not isinstance(value, str) or not value.strip():
            refuse_at(place, kind)
    elif kind is not None:
        if value is None:
            return math.nan if kind is NUMBER else None
        # a larger value is no physical quantity, and may exceed floating-point numbers
        if not isinstance(value, (int, float)) or isinstance(value, bool) or abs(value) > 1e300:
            refuse_at(place, kind)
    return value


def read_json(file, kind, remedy):
    """The value in a JSON file, checked against its kind."""
    try:
        value = json.loads(read_bytes(file).decode())
    except UnicodeDecodeError:
        refuse(file, "is no text", remedy)
    except (ValueError, RecursionError) as error:
        refuse(file, f"cannot be read ({error})", remedy)

    def refuse_at(place, what):
        part = f'its "{place}"' if place else "it"
        refuse(file, f'has no "{place}"' if what == "something"
               else f"is not what the program writes, as {part} should be {what}", remedy)
    return as_kind(value, kind, refuse_at)


SIZES = {"Int8": 1, "UInt8": 1, "Int32": 4, "UInt32": 4, "Int64": 8, "UInt64": 8, "Float32": 4, "Float64": 8}


class PictureCheck:
    """Checks a VTU file before VTK reads it, as VTK does not check sizes."""

    def __init__(self, file):
        self.file = file
        self.points = self.cells = None
        self.within, self.array, self.text = [], None, []
        parser = xml.parsers.expat.ParserCreate()
        parser.buffer_text = True
        parser.StartElementHandler = self.start
        parser.EndElementHandler = self.end
        parser.CharacterDataHandler = self.data
        try:
            parser.Parse(read_bytes(file), True)
        except (xml.parsers.expat.ExpatError, ValueError) as error:
            self.refuse(error)
        if self.points is None:
            self.refuse("it has no cells")

    def refuse(self, why):
        refuse(self.file, f"is no VTU file, or is cut or damaged ({why})")

    def start(self, name, attributes):
        self.within.append(name)
        if len(self.within) == 1 and (name != "VTKFile" or attributes.get("type") != "UnstructuredGrid"):
            self.refuse("it has no unstructured grid")
        if name == "Piece":
            sizes = [attributes.get(f"NumberOf{what}", "") for what in ("Points", "Cells")]
            if not all(size.isdecimal() for size in sizes):
                self.refuse("the numbers of its points and cells are missing")
            self.points, self.cells = map(int, sizes)
        elif name == "DataArray":
            self.array, self.text = attributes, []

    def data(self, text):
        if self.array is not None:
            self.text.append(text)

    def end(self, name):
        self.within.pop()
        if name == "DataArray":
            if self.array.get("format") == "binary":
                self.check_array("".join("".join(self.text).split()))
            self.array, self.text = None, []

    def check_array(self, text):
        """Checks compressed blocks in base 64, preceded by their number and sizes [byte]."""
        name, kind = self.array.get("Name") or self.within[-1], self.array.get("type")
        if kind not in SIZES:
            self.refuse(f'the type of "{name}" is unknown')
        n_blocks, size, last = np.frombuffer(self.decoded(text[:16], name), "<u4", 3).tolist()
        length = 4 * -(-4 * (3 + n_blocks) // 3)
        if len(text) < length:
            self.refuse(f'"{name}" is too short')
        sizes = np.frombuffer(self.decoded(text[:length], name), "<u4", 3 + n_blocks)[3:]
        if len(text) != length + 4 * -(-int(sizes.sum(dtype=np.int64)) // 3):
            self.refuse(f'the length of "{name}" differs from its header')
        full = (n_blocks - 1) * size + last if last else n_blocks * size
        parent = self.within[-1]
        rows = self.points if parent in ("Points", "PointData") else self.cells
        components = self.array.get("NumberOfComponents", "1")
        if not components.isdecimal() or (parent == "Points" and components != "3"):
            self.refuse(f'"{name}" cannot have {components or "no"} components')
        expected = rows * int(components) * SIZES[kind] if n_blocks else 0
        if name != "connectivity" and full != expected:
            self.refuse(f'"{name}" has another size than the points or cells')

    def decoded(self, text, name):
        try:
            data = base64.b64decode(text, validate=True)
        except ValueError:
            data = b""
        if len(data) < 12:
            self.refuse(f'"{name}" cannot be decoded')
        return data
