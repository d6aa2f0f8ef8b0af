#!/usr/bin/python3
"""Makes reports of a small run and of folders that are no run, and compares the numbers
in the page with closed forms.

usage: check_report.py PROGRAM FOLDER_OF_THE_REPORT CASE.prm
"""

import functools
import html.parser
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

program, report, case = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
sys.dont_write_bytecode = True
sys.path.insert(0, str(report))
import needed  # noqa: E402, F401
import numpy as np  # noqa: E402
import verdicts  # noqa: E402
from verdicts import is_true  # noqa: E402
from voussoir_report import grid, motion  # noqa: E402

GRAVITY = 9.81
AMPLITUDE, FREQUENCY, CYCLES = 0.1 * GRAVITY, 2., 5  # of the case [m/s2], [Hz]
compare = functools.partial(verdicts.compare, round_off=1e-12)


class Page(html.parser.HTMLParser):
    """Headings, pictures and rows of tables of a page."""

    def __init__(self, text):
        super().__init__()
        self.headings, self.pictures, self.rows, self.within = [], [], [], ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.within = tag
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")
        elif tag == "h2":
            self.headings.append("")
        elif tag == "img":
            self.pictures.append(dict(attributes)["src"])

    def handle_endtag(self, tag):
        self.within = ""

    def handle_data(self, data):
        if self.within in ("td", "th"):
            self.rows[-1][-1] += data.strip()
        elif self.within == "h2":
            self.headings[-1] += data

    def number(self, row, column):
        """The number in a column, by its title, of the first row of this name after that."""
        titles = None
        for cells in self.rows:
            if column in cells:
                titles = cells
            elif titles and cells[0] == row:
                return value_of(cells[titles.index(column)])
        raise KeyError(f"{row}, {column}")

    def judged(self, criterion):
        """The judgement of the first criterion of this name."""
        return next(cells[1] for cells in self.rows if cells[0] == criterion)

    def of(self, row):
        """The first number of the row of this name."""
        return value_of(next(cells[1] for cells in self.rows if cells[0] == row))


def value_of(text):
    text = text.replace("\u202f", "").replace("−", "-")
    return float(re.search(r"-?[\d.]+", text)[0])


def run_report(*arguments):
    return subprocess.run([report / "voussoir-report", *map(str, arguments)], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)


def oscillator(period, damping):
    """Pseudo-acceleration of an oscillator under the cycles of the sine and after them."""
    w, drive = 2. * np.pi / period, 2. * np.pi * FREQUENCY
    wd = w * np.sqrt(1. - damping**2)

    def free(u, v, t):
        return np.exp(-damping * w * t) * (u * np.cos(wd * t)
                                           + (v + damping * w * u) / wd * np.sin(wd * t))

    # u'' + 2 damping w u' + w^2 u = -A sin(drive t)
    below = (w**2 - drive**2)**2 + (2. * damping * w * drive)**2
    in_phase = -AMPLITUDE * (w**2 - drive**2) / below
    behind = 2. * AMPLITUDE * damping * w * drive / below

    def forced(t):
        return (in_phase * np.sin(drive * t) + behind * np.cos(drive * t)
                + free(-behind, -in_phase * drive, t))

    end, small = CYCLES / FREQUENCY, 1e-6
    times = np.linspace(0., end, 100001)
    velocity = (forced(end + small) - forced(end - small)) / (2. * small)
    after = free(forced(end), velocity, np.linspace(0., 2. * period, 100001))
    return w**2 * max(np.abs(forced(times)).max(), np.abs(after).max())


def check_wall(page):
    """The wall of 60 m, 8 m and 20 m, and its shaking."""
    compare("Arias intensity [m/s]", page.number("y, along the river", "Arias intensity [m/s]"),
            np.pi / (2. * GRAVITY) * AMPLITUDE**2 * CYCLES / FREQUENCY / 2., 0.5)
    # a twentieth of five cycles is a quarter of a cycle, where the oscillating part is
    # zero
    compare("significant duration [s]",
            page.number("y, along the river", "significant duration 5–95 % [s]"),
            0.9 * CYCLES / FREQUENCY, 0.3)
    compare("peak velocity [cm/s]", page.number("y, along the river", "peak velocity [cm/s]"),
            100. * 2. * AMPLITUDE / (2. * np.pi * FREQUENCY), 0.5)
    for period in (0.1, 0.2, 0.5, 1., 2.):
        compare(f"pseudo-acceleration at {period:g} s, 5 % damping [g]",
                page.number("y, along the river", f"{period:g} s"),
                oscillator(period, 0.05) / GRAVITY, 0.6)
    base = page.number("base", "y, along the river")
    compare("peak acceleration of the base, which is rigid [g]", base, 0.1, 0.5)
    compare("cells of the dam", page.of("dam: cells, as drawn"), 120., 0.)
    compare("scaled Jacobian of bricks", page.of("dam: worst scaled Jacobian [-]"), 1., 0.)
    compare("time covered [s]", page.of("time covered [s]"), 3., 0.)

    is_true("no joints, no modes, no damage", not any(
        word in heading for heading in page.headings for word in ("Joint", "modes", "Damage")))
    is_true("motion and energies are there", {"Input motion", "Energy balance"} <= set(page.headings))
    compare("time above a strength that is never reached [s]",
            page.number("back", "longest time above 1 [s]"), 0., 0.)
    is_true("a linear analysis suffices", ["This run", "linear analysis suffices"] in page.rows)
    is_true("all pictures are in the page",
            len(page.pictures) > 6 and all(p.startswith(("data:image/png", "data:image/svg+xml"))
                                     for p in page.pictures))
    is_true("both verdicts are there", {"Conclusions", "Complete input"} <= set(page.headings)
            and page.judged("energy-balance error") == "met"
            and page.judged("demand over tensile strength") == "met")
    is_true("places to sign", all([role, "", "", ""] in page.rows for role in ("prepared by", "checked by")))
    compare("extent of the wall along x [m]",
            value_of(next(cells[1] for cells in page.rows if cells[0].startswith("extent of the model")).split(" to ")[1]),
            60., 0.)
    compare("cells through the thickness of the wall",
            page.of("cells through the thickness at the crown: top / middle / bottom"), 2., 0.)


def check_words(text):
    words = re.search(r"A dam ([\d.]+) m high and ([\d.]+) m long along its crest, which is ([\d.]+) m wide,"
                      r" of ([\d\u202f]+) m³.*?= ([\d.]+),", text)
    for what, value, reference in zip(("height [m]", "crest length [m]", "crest width [m]", "volume [m3]",
                                       "slenderness F2/VH"), words.groups(),
                                      (20., 60., 8., 9600., 1200.**2 / (9600. * 20.))):
        compare(what, value_of(value), reference, 0.3)


def check_resonance():
    """Without damping, an oscillator in resonance keeps the amplitude n pi A / w^2 after
    n cycles."""
    step = 1e-3
    times = np.arange(0., 3., step)
    a = AMPLITUDE * np.sin(2. * np.pi * FREQUENCY * times) * (times < CYCLES / FREQUENCY)
    periods = np.array([0.25, 1. / FREQUENCY, 1.25])
    resonant = np.pi * CYCLES * AMPLITUDE
    values = motion.response_spectrum(a, step, periods, 0.)
    compare("undamped resonance [m/s2]", values[1], resonant, 0.1)
    for period, value in zip(periods[[0, 2]], values[[0, 2]]):
        compare(f"undamped pseudo-acceleration at {period:g} s [m/s2]", value, oscillator(period, 0.), 0.1)


def check_arch(folder):
    """An arch of uniform thickness, 100 m in radius, over two radians."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
    from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, vtkUnstructuredGrid
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    radius, angle, thickness, height, n = 100., 2., 10., 30., 60
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1),
                        (0, 1, 1)], float)
    mesh, points = vtkUnstructuredGrid(), []
    for i in range(n):
        for k in range(3):
            at = angle * ((i + corners[:, 0]) / n - 0.5)
            r = radius + thickness * (corners[:, 1] - 0.5)
            points.append(np.stack([r * np.sin(at), r * np.cos(at), (k + corners[:, 2]) * height / 3.], 1))
    places = vtkPoints()
    places.SetData(numpy_to_vtk(np.concatenate(points), deep=True))
    mesh.SetPoints(places)
    for cell in range(3 * n):
        mesh.InsertNextCell(VTK_HEXAHEDRON, 8, list(range(8 * cell, 8 * cell + 8)))
    material = numpy_to_vtk(np.zeros(24 * n), deep=True)
    material.SetName("material")
    mesh.GetPointData().AddArray(material)
    names = vtkStringArray()
    names.SetName("material_names")
    names.InsertNextValue('"concrete"')
    mesh.GetFieldData().AddArray(names)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(folder / "arch.vtu"))
    writer.SetInputData(mesh)
    writer.Write()

    dam = grid.Dam(grid.Grid(folder / "arch.vtu"), ["concrete"])
    compare("length of the crest of an arch [m]", dam.crest_length, radius * angle, 0.1)
    compare("its width [m]", dam.crest_width, thickness, 0.1)
    compare("its volume [m3]", dam.volume, radius * angle * thickness * height, 0.1)
    outer = radius + 0.5 * thickness
    compare("length of half the unrolled upstream face [m]",
            dam.developed(outer * np.sin(0.5 * angle)), 0.5 * angle * outer, 0.1)
    compare("faces upstream", len(dam.side("upstream")), 3 * n, 0.)
    polygons, _ = dam.crown
    area = sum(0.5 * abs(np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)))
               for p in polygons)
    compare("area of the section in the middle [m2]", area, thickness * height, 0.1)


def check_refusals(scratch, wall):
    """A folder that is no run gives one sentence and the exit code 1."""
    (scratch / "empty").mkdir()
    half = scratch / "half"
    half.mkdir()
    shutil.copy(wall / "parameters.prm", half)
    broken = scratch / "broken"
    shutil.copytree(wall, broken)
    (broken / "summary.json").write_text((wall / "summary.json").read_text()[:300])
    for folder, words, options in (
            (scratch / "none", "There is no folder", ()),
            (scratch / "empty", "is not the output folder of a run or a study", ()),
            (half, "has not ended", ()), (broken, "cannot be read", ()),
            (wall, "cannot be written", ("-o", scratch / "none" / "page.html"))):
        answer = run_report(folder, *options)
        is_true(f"{folder.name}: {words}", answer.returncode == 1 and words in answer.stdout
                and len(answer.stdout.strip().splitlines()) == 1)
    table = (wall / "histories.csv").read_text()
    lines = table.splitlines(keepends=True)
    middle = len(lines) // 2
    for name, text, words in (
            ("cut in a line", table[:len(table) // 2], "is cut"),
            ("cut between lines", "".join(lines[:middle]), "is cut, as it ends at"),
            ("with NUL bytes", "\0" * 5000 + "".join(lines[middle:]), "NUL bytes"),
            ("without its heading", "".join(lines[1:]), "no heading"),
            ("empty", "", "is empty"),
            ("with unequal lines", table.replace(lines[2], lines[2].replace("\n", ",1\n")), "in line 3 under"),
            ("of words", "There is\nno table.\n", 'begins with the column "There is"'),
            ("with a word", table.replace(lines[5].split(",")[2], "none", 1), "is no number")):
        damaged = scratch / "damaged"
        shutil.copytree(wall, damaged)
        (damaged / "histories.csv").write_text(text)
        answer = run_report(damaged)
        is_true(f"a table {name} is refused by name", answer.returncode == 1 and words in answer.stdout
                and "histories.csv" in answer.stdout and len(answer.stdout.strip().splitlines()) == 1)
        shutil.rmtree(damaged)


def check_study(folder):
    """A study of an elastic wall under the factors 1 and 2 on the motion."""
    subprocess.run([program, case, "--set", f"Output/Folder={folder}", "Time/End time=1",
                    "Study/Vary=Ground motion/Overload factor = 1, 2",
                    "Study/Quantities=histories/crest/largest displacement [m]"], check=True,
                   stdout=subprocess.DEVNULL)
    answer = run_report(folder)
    is_true("a report of a study is made", answer.returncode == 0)
    page = Page((folder / "report.html").read_text(encoding="utf-8"))
    column = "crest: largest displacement [m]"
    compare("displacement at twice the motion over that at once", page.number("2", column) /
            page.number("1", column), 2., 0.5)
    is_true("it has a chapter of its own, and those of the runs",
            "Study" in page.headings and "Energy balance" in page.headings)


def main():
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        wall = scratch / "wall"
        subprocess.run([program, case, "--set", f"Output/Folder={wall}"], check=True,
                       stdout=subprocess.DEVNULL)
        answer = run_report(wall)
        is_true("a report is made", answer.returncode == 0)
        print(answer.stdout.strip().replace(name, "") if answer.returncode else "", end="")
        text = (wall / "report.html").read_text(encoding="utf-8")
        check_wall(Page(text))
        check_words(text)
        check_resonance()
        check_arch(scratch)
        check_refusals(scratch, wall)
        check_study(scratch / "study")

        ranks = scratch / "ranks"  # its pictures have a piece of each rank
        subprocess.run(["mpirun", "-n", "2", program, case, "--set", f"Output/Folder={ranks}"],
                       check=True, stdout=subprocess.DEVNULL)
        is_true("a report of a run on two ranks", run_report(ranks).returncode == 0)

        both = scratch / "both.html"
        answer = run_report(f"first={wall}", f"second={wall}", "-o", both)
        is_true("two runs in one page", answer.returncode == 0 and
                {"first", "second"} <= set(cell for row in Page(both.read_text()).rows for cell in row))
    verdicts.end()


if __name__ == "__main__":
    main()
