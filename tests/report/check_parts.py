#!/usr/bin/python3
"""Parts of a report against known made-up results: a wall of two blocks with a joint
that is open wider upstream, and summaries with evident verdicts.

usage: check_parts.py FOLDER_OF_THE_REPORT
"""

import base64
import functools
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

report = pathlib.Path(sys.argv[1]).resolve()
sys.dont_write_bytecode = True
sys.path.insert(0, str(report))
import needed  # noqa: E402, F401
import numpy as np  # noqa: E402
import verdicts  # noqa: E402
from verdicts import is_true  # noqa: E402
from vtkmodules.util.numpy_support import numpy_to_vtk  # noqa: E402
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray  # noqa: E402
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_QUAD, vtkUnstructuredGrid  # noqa: E402
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter  # noqa: E402
from voussoir_report import case, charts, damage, faces, grid, interfaces, page, records, scenes, stages, structure  # noqa: E402
from voussoir_report import study, study_evaluations, verdict  # noqa: E402
from voussoir_report.run import Run  # noqa: E402

compare = functools.partial(verdicts.compare, round_off=1e-9)

LENGTH, THICKNESS, HEIGHT, LEVELS = 40., 8., 20., 4  # of the wall [m], and cells upwards
UPSTREAM, DOWNSTREAM = 1., 0.5  # opening of the joint over the elevation [mm/m]

UNIT_CELL = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], float)

PARAMETERS = """set Title = A wall of two blocks
subsection Ground motion
  set Type = none
  subsection Sine
    set Frequency = 3 # default: 2
  end
end
subsection Interfaces
  set Names = joint # default:
  subsection joint
    set Key depth = 0 # default: 0.1
  end
end
subsection Materials
  set Names = concrete # default:
  subsection concrete
    set Class = linear elastic
    set Tensile strength = 0
  end
end
subsection Mesh
  set Type = box
  subsection arch dam
    set Cell size = 9 # default: 16
  end
  subsection box
    set Cells = 2, 1, 4 # default: 1, 1, 1
  end
end
"""
LOG = """Dam: 20 m high, crest 41.5 m long; at the crown 7 to 9 m thick; volume 6400 m3; slenderness 15.2 (Lombardi: ...)
Material concrete: mass 1.5e+07 kg, P wave 4015 m/s, S wave 2532 m/s; its largest cells carry waves up to 6.4 Hz with 8 nodes per wavelength
Damping: Maxwell, asked 5 %, achieved
      1 Hz 4.0 %  4 Hz 5.0 %  16 Hz 5.0 %
"""
SUMMARY = {"verdict": "no objection", "version": "test", "warnings": [], "time step [s]": 1e-3,
           "largest stable step [s]": 1.2e-3,
           "energy balance": {"largest energy-balance error": 1e-3,
                              "energy-balance error, share of the losses": 1e-3}}


def write_grid(file, corners, kind, values, names, vectors={}):
    """Cells with separate corners (n, 4 or 8, 3), values and vectors at these, and
    lists of names."""
    mesh, points = vtkUnstructuredGrid(), vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(corners.reshape(-1, 3)), deep=True))
    mesh.SetPoints(points)
    n = corners.shape[1]
    for cell in range(len(corners)):
        mesh.InsertNextCell(kind, n, list(range(n * cell, n * cell + n)))
    for name, numbers in [*values.items(), *vectors.items()]:
        shape = (-1, 3) if name in vectors else -1
        array = numpy_to_vtk(np.ascontiguousarray(numbers, float).reshape(shape), deep=True)
        array.SetName(name)
        mesh.GetPointData().AddArray(array)
    for name, texts in names.items():
        array = vtkStringArray()
        array.SetName(name)
        for text in texts:
            array.InsertNextValue(f'"{text}"')
        mesh.GetFieldData().AddArray(array)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(file))
    writer.SetInputData(mesh)
    writer.Write()


def make_wall(folder, summary=SUMMARY, log=LOG):
    folder.mkdir()
    (folder / "parameters.prm").write_text(PARAMETERS)
    (folder / "summary.json").write_text(json.dumps(summary))
    (folder / "log.txt").write_text(log)
    size = np.array([0.5 * LENGTH, THICKNESS, HEIGHT / LEVELS])
    cells = np.array([(UNIT_CELL + (i, 0, k)) * size - (0.5 * LENGTH, 0.5 * THICKNESS, 0.)
                      for i in range(2) for k in range(LEVELS)])
    write_grid(folder / "envelopes.vtu", cells, VTK_HEXAHEDRON, {"material": np.zeros(cells.shape[:2])},
               {"material_names": ["concrete"]})
    quads = cells[LEVELS:, [0, 3, 7, 4]]  # the side x = 0 of the second block
    slope = np.where(quads[..., 1] > 0., UPSTREAM, DOWNSTREAM)
    write_grid(folder / "interface_envelopes.vtu", quads, VTK_QUAD,
               {"largest_opening_mm": slope * quads[..., 2], "interface": np.zeros(quads.shape[:2])},
               {"interface_names": ["joint"]})
    (folder / "energy.csv").write_text(
        "time [s],kinetic [J],strain [J],damping [J],material [J],closing cracks [J],constraints [J],input [J],"
        "boundary [J]\n0,0,0,0,0,0,0,0,0\n1,1,1,1,0,0,0,3,0\n")
    (folder / "interfaces.csv").write_text("time [s],joint largest opening [mm],joint largest slip [mm],"
                                           "joint sliding safety [-]\n0,0,0,2\n1,20,441,1\n")
    for name in ("over_stress.csv", "over_stress.vtu"):
        (folder / name).touch()
    return Run(folder)


def check_profiles(run):
    is_true("the joint is one of the dam", interfaces.contraction_joints(run) == ("joint",))
    edges = interfaces.edges_of(run, "joint")
    for side, slope in (("upstream", UPSTREAM), ("downstream", DOWNSTREAM)):
        levels, opening = edges[side]
        compare(f"levels of the profile {side}", len(levels), LEVELS + 1, 0.)
        compare(f"opening at the crest, {side} [mm]", opening[-1], slope * HEIGHT, 1e-3)
        compare(f"opening at half the height, {side} [mm]", opening[LEVELS // 2], slope * HEIGHT / 2., 1e-3)


def check_lifts(scratch):
    """Contraction joints are steep, lift joints are level: each kind has its own section and pictures."""
    names = ("joint", "lift 1", "lift 2")
    values = {**surface()["interfaces"]["surfaces"]["joint"], "smallest sliding safety": None}
    opened = {**values, "largest opening [mm]": 3.}
    run = make_wall(scratch / "lifts", {**SUMMARY, "interfaces": {"surfaces": dict(zip(names, (opened, values, opened)))}})
    cells = grid.dam_of(run).grid.points.reshape(2, LEVELS, 8, 3)
    quads = np.concatenate([cells[1, :, [0, 3, 7, 4]].transpose(1, 0, 2), *(cells[:, k, :4] for k in (1, 2))])
    number = np.repeat([0., 1., 2.], (LEVELS, 2, 2))[:, None] * np.ones(4)
    opening = np.where(number == 1., 0., 3. * (quads[..., 1] > 0.))  # upstream only
    write_grid(run.folder / "interface_envelopes.vtu", quads, VTK_QUAD,
               {"largest_opening_mm": opening, "interface": number}, {"interface_names": names})
    columns = [f"{name} largest {what} [mm]" for name in names for what in ("opening", "slip")]
    (run.folder / "interfaces.csv").write_text(
        f"time [s],{','.join(columns)}\n0{',0' * len(columns)}\n1,3,0,0,0,3,0\n")
    grid.grid_of.cache_clear()
    interfaces.surfaces_of.cache_clear()
    is_true("a steep joint", interfaces.contraction_joints(run) == ("joint",))
    is_true("level joints, from below", interfaces.lift_joints(run) == ("lift 1", "lift 2"))
    is_true("neither is a plane", interfaces.planes_of(run) == [])
    steep, level = (section([run]) for section in (interfaces.contraction_joints_section, interfaces.lift_joints_section))
    rows = [[row[0] for part in section.parts if isinstance(part, page.Table) for row in part.rows]
            for section in (steep, level)]
    is_true("each in the table of its kind, lift joints if they moved", rows == [["joint"], ["lift 2"]])
    is_true("  the others are counted", "1 of 2 lift joints opened or slipped: lift 2 at z = 10.0 m" in level.parts[0])
    is_true("  and all pictures have names of their own", len({picture.name for picture in steep.pictures + level.pictures})
            == len(steep.pictures) + len(level.pictures))
    upstream, downstream = interfaces.lifts_on_faces(run)
    compare("opening of lift joints on the upstream face [mm]", upstream.values.max(), 3., 0.)
    compare("  at the elevation [m]", upstream.places[upstream.values == 3., :, 1].mean(), HEIGHT / 2., 0.)
    compare("  on the downstream face [mm]", downstream.values.max() + 1., 1., 0.)


def check_wide_opening(scratch):
    """One face that opened by 2 m hides neither the openings of millimetres of a joint nor those of a lift joint."""
    for kind, corners, pictures in (("joint", [0, 3, 7, 4], interfaces.opening_sections),
                                    ("lift", [0, 1, 2, 3], interfaces.lift_pictures)):
        run = make_wall(scratch / f"wide_{kind}")
        cells = divided(divided(grid.dam_of(run).grid.points.reshape(-1, 8, 3)))
        write_grid(run.folder / "envelopes.vtu", cells, VTK_HEXAHEDRON, {"material": np.zeros(cells.shape[:2])},
                   {"material_names": ["concrete"]})
        quads = cells[:, corners]
        axis, at = {"joint": (0, 0.), "lift": (2, HEIGHT / 2.)}[kind]
        quads = quads[(quads[..., axis] == at).all(axis=1)]
        opening = np.linspace(0., 8., len(quads))[:, None] * np.ones(4)
        opening[-1] = 2000.
        write_grid(run.folder / "interface_envelopes.vtu", quads, VTK_QUAD,
                   {"largest_opening_mm": opening, "interface": np.zeros(quads.shape[:2])}, {"interface_names": [kind]})
        grid.dam_in.cache_clear()
        grid.grid_of.cache_clear()
        scale = interfaces.scale_of_openings([opening], "largest opening [mm]")
        is_true(f"openings of a {kind} are seen beside a wide one", 8. <= scale.levels[-1] <= 20. and scale.above)
        is_true("  and the widest is in the caption",
                f"; the largest value is {page.number(2000.)} mm" in pictures([run])[0].caption)


def check_refined(run, folder):
    """Dimensions of the wall with two cells refined, one at the crest and once more in a
    corner, are those of the wall: faces at hanging nodes are no faces of the dam."""
    cells = list(grid.dam_of(run).grid.points.reshape(-1, 8, 3))
    for cell in (LEVELS + 1, LEVELS - 1, -1):
        corners = cells.pop(cell)
        low, size = corners.min(axis=0), np.ptp(corners, axis=0)
        cells += [low + 0.5 * size * (UNIT_CELL + corner) for corner in UNIT_CELL]
    write_grid(folder / "refined.vtu", np.array(cells), VTK_HEXAHEDRON,
               {"material": np.zeros((len(cells), 8))}, {"material_names": ["concrete"]})
    dam = grid.Dam(grid.Grid(folder / "refined.vtu"), ["concrete"])
    for side in ("upstream", "downstream"):
        areas = np.linalg.norm(grid.area_vectors(dam.grid.points[dam.side(side)]), axis=1)
        compare(f"refined: area of the {side} face [m2]", areas.sum(), LENGTH * HEIGHT, 0.)
    outer = np.linalg.norm(grid.area_vectors(dam.grid.points[dam.exposed]), axis=1).sum()
    compare("refined: outer area [m2]", outer, 2. * (LENGTH * HEIGHT + LENGTH * THICKNESS + THICKNESS * HEIGHT), 0.)
    compare("refined: length of the crest [m]", dam.crest_length, LENGTH, 1e-9)
    compare("refined: length of the crest's upstream edge [m]", np.ptp(dam.crest_line[1]), LENGTH, 1e-9)
    compare("refined: slenderness", dam.slenderness, LENGTH**2 * HEIGHT / dam.volume, 1e-9)


def check_damage(scratch):
    """Without envelopes the damage at the end is that of the last picture of the fields,
    not of the first one, in the static state, nor of the modes."""
    run = make_wall(scratch / "damage")
    shape = grid.dam_of(run).grid.points.reshape(-1, 8, 3)
    (run.folder / "envelopes.vtu").rename(run.folder / "modes.vtu")
    openings = {"fields-0.vtu": 0.1, "fields-1.vtu": 5.}
    for file, opening in openings.items():
        write_grid(run.folder / file, shape, VTK_HEXAHEDRON,
                   {"material": np.zeros(shape.shape[:2]),
                    "largest_crack_opening_mm": np.full(shape.shape[:2], opening)},
                   {"material_names": ["concrete"]})
    (run.folder / "fields.txt").write_text("0 fields-0.vtu\n6 fields-1.vtu\n")
    grid.dam_in.cache_clear()
    grid.grid_of.cache_clear()
    is_true("cracks are shown", damage.damaged(run) == ["largest_crack_opening_mm"])
    compare("opening of cracks at the end [mm]",
            damage.of_cells(grid.dam_of(run), "largest_crack_opening_mm").max(), 5., 0.)


def check_abscissa(run):
    """The axis below a face is the x of the model, and +x is towards the left bank,
    looking downstream."""
    dam = grid.dam_of(run)
    for side, sign in (("upstream", -1.), ("downstream", 1.)):
        corners = dam.grid.points[dam.side(side)]
        panel = faces.panel_of(dam, side, corners, corners[..., 0])
        at = panel.places.reshape(-1, 2)[panel.values.argmax(), 0]  # of the largest x
        order = np.argsort(panel.ticks[0])
        shown = np.interp(0.5 * at, panel.ticks[0][order], panel.ticks[1][order])
        compare(f"x below half way to the left bank, {side} [m]", shown, LENGTH / 4., 0.1)
        axes = charts.place(charts.Figure(), 0., 0., 4., 2.)
        charts.draw_panel(axes, panel, charts.Scale([panel.values], ""))
        left, right = axes.transData.transform([(at, 0.), (-at, 0.)])[:, 0]
        is_true(f"left bank where it belongs, {side}", sign * (left - right) > 0.)
        is_true(f"labels say the same, {side}",
                [label.get_text().replace("−", "-") for label in axes.get_xticklabels()]
                == [f"{x:g}" for x in panel.ticks[1]])
        is_true(f"axes have names, {side}", axes.get_xlabel() and axes.get_ylabel())


def check_colours():
    for ends in ((-10., 4.), (-4., 10.)):
        scale = charts.Scale([np.array(ends)], "stress", 0.)
        compare("tension and pressure of the same amount, distances from white", scale.norm(3.) - 0.5,
                0.5 - scale.norm(-3.), 0.)
        compare("white is zero", scale.norm(0.), 0.5, 0.)
        compare("the bar goes as far to both sides", scale.levels[-1], -scale.levels[0], 0.)
    # a whole face at 4.4 MPa, where the range leaves out half a per cent of the values
    # above 4 MPa
    stress = np.concatenate([np.linspace(-10., 4., 2000), [4.4]])
    face = charts.Panel("", np.array([[(0., 0.), (1., 0.), (1., 1.), (0., 1.)]]), np.full((1, 4), 4.4))
    axes = charts.place(charts.Figure(), 0., 0., 4., 2.)
    scale = charts.Scale([stress], "stress")
    charts.draw_panel(axes, face, scale)
    drawn = next(colour for bands in axes.collections
                 for colour, path in zip(bands.get_facecolor(), bands.get_paths()) if len(path.vertices))
    is_true("what the range leaves out is not drawn as more than it is",
            np.abs(drawn - scale.colours(scale.norm(4.4))).max() < 0.05)
    pressure = charts.Scale([np.array([-5., -1.])], "stress")
    compare("a bar of pressure alone ends at zero", pressure.levels[-1], 0., 0.)
    more = charts.Scale([np.concatenate([np.linspace(0., 4., 2000), [9.]])], "stress")
    is_true("values beyond the colour bar are reported where there are some", more.above and not more.below and not scale.above)
    cracked = charts.Scale([np.concatenate([np.zeros(999), [3.]])], "opening [mm]", colours="inferno_r", low=0.)
    is_true("one cracked cell of a thousand is seen", cracked.levels[-1] >= 3. and "everywhere" not in cracked.label)
    for largest in (20e3, 12.5, 0.03):
        figure = charts.Figure(figsize=(charts.WIDTH, 0.65))
        charts.Scale([np.append(np.linspace(0., largest, 2000), 2. * largest)], "", colours="inferno_r").bar(figure)
        boxes = [label.get_window_extent() for label in figure.axes[0].get_xticklabels()]
        is_true(f"numbers of a bar to {largest:g} are apart", all(a.x1 < b.x0 for a, b in zip(boxes, boxes[1:])))
        is_true("  the last one is marked", figure.axes[0].get_xticklabels()[-1].get_text().startswith("≥"))
    noise = charts.Scale([np.array([0., 3e-14])], "opening [mm]", 0., "inferno_r", low=0.)
    compare("end of the bar of noise", noise.levels[-1], 1., 0.)
    is_true("noise is reported as zero", noise.label == "opening [mm]: 0 everywhere")


def surface(**changed):
    values = {"area [m2]": 10., "largest opening [mm]": 0., "largest slip [mm]": 0., "residual slip [mm]": 0.,
              "smallest sliding safety": 1., "time at safety one or below [s]": 0., "slip rate at the end [mm/s]": 0.}
    return {"interfaces": {"surfaces": {"joint": {**values, **changed}}}}


def line(value, met, **more):
    return {"value": value, "met": met, **more}


def check_verdicts(scratch):
    """Results that exclude a good verdict, and results that do not: the program's own
    tables."""
    good = {"numerical checks": {"energy-balance error": line(1e-3, True, **{"at most": 0.01})}}
    crest = {"quantity": "histories/*/largest displacement [m]", "clause": "4.2", "load case": "MCE", "source": "user's",
             "demand": 0.2, "at most": 0.15, "met": False, "of": "histories/crest/largest displacement [m]"}
    detached = "at t = 4 s a crack is open by 388 mm, 2 % of its cell: cracks have detached a block from the rest"
    for name, changed, colours, judged in (
            ("nothing assessed", good, ("good", "open"), {}),
            ("an earlier version", {}, ("doubt", "open"), {}),
            ("demand over strength of 3.7",
             {**good, "engineering results": {"demand over tensile strength": line(3.7, False, **{
                 "at most": 1., "of": "upstream face", "at the time [s]": 2., "at [m]": [59., 1., 20.]})}},
             ("good", "bad"), {"demand over tensile strength": "not met"}),
            ("demand below strength",
             {**good, "engineering results": {"demand over tensile strength": line(0.7, True, **{"at most": 1.})}},
             ("good", "good"), {"demand over tensile strength": "met"}),
            ("tension without a strength", {**good, "face stresses": {"largest principal stress [MPa]": 6.6}},
             ("doubt", "open"), {"largest principal tension on the faces": "not assessed"}),  # no pictures of it
            ("slipped and at rest", {**good, "engineering results": {"slip at the end [mm]": line(12., None)}},
             ("good", "doubt"), {"slip at the end [mm]": "to be judged"}),
            ("sliding on", {**surface(**{"residual slip [mm]": 441., "slip rate at the end [mm/s]": 92.}), **good,
                            "engineering results": {"slip at the end [mm]": line(441., None),
                                                    "slip rate at the end [mm/s]": line(92., False, **{"at most": 1.})}},
             ("good", "bad"), {"slip rate at the end [mm/s]": "not met"}),
            ("a number that is none", {**good, "engineering results": {"slip at the end [mm]": line(None, False)}},
             ("good", "bad"), {"slip at the end [mm]": "not met"}),
            ("strength lowered", {"numerical checks": {"strength lowered by long cells [%]": line(59., False, **{
                "at most": 10., "of": "concrete", "remedy": "cells of at most 2 m keep it"})}}, ("bad", "open"), {"strength lowered by long cells [%]": "not met"}),
            ("a warning", {**good, "warnings": [detached]}, ("doubt", "open"), {}),
            ("stopped", {**good, "verdict": "stopped: the motion grows without end"}, ("bad", "open"), {}),
            ("a criterion", {**good, "acceptance table": {"crest": crest}}, ("bad", "good", "open"),
             {"crest, MCE: 4.2": "not met"}),
            ("a criterion without its number",
             {**good, "acceptance table": {"crest": {**crest, "demand": None, "met": None}}}, ("open", "good", "open"),
             {"crest, MCE: 4.2": "not assessed"})):
        run = make_wall(scratch / name.replace(" ", "_"), {**SUMMARY, **changed}, LOG)
        run.parameters["Acceptance/Names"] = "crest"
        found = verdict.verdicts_of(run)
        lines = {one.what: one for verdict_of in found for one in verdict_of.lines}
        is_true(f"{name}: {', '.join(colours)}", tuple(one.colour for one in found) == colours)
        is_true(f"{name}: {judged}", all(what in lines and lines[what].judged == how for what, how in judged.items()))
        if name.startswith("demand over"):
            is_true("with its place and time", lines["demand over tensile strength"].place
                    == "upstream face, at 2.00 s, x = 59.0, y = 1.00, z = 20.0 m")
        if name == "strength lowered":
            is_true("with its remedy", found[0].remarks == ["strength lowered by long cells [%]: cells of at most 2 m keep it"])
        if name == "a criterion":
            is_true("with its limit, unit and source", lines["crest, MCE: 4.2"].limit == "at most 0.150 m (user's)"
                    and lines["crest, MCE: 4.2"].found == "0.200 m")


def check_compression(scratch):
    """Compression is compared with the strength of the longest cells, and crushed concrete has reached it."""
    note = "  note: cells are long; their compressive strength is lowered by up to 58 %; in the static state cells are " \
           "long; their compressive strength is lowered by up to 65.6 %.\nMaterial rock: mass 1 kg\n" \
           "  note: their compressive strength is lowered by up to 90 %.\nDamping"
    stress = {"face stresses": {"smallest principal stress [MPa]": -14.1}}
    for name, changed, log, found, judged in (
            ("strong", {}, LOG, "0.564", "met"), ("lowered", {}, LOG.replace("Damping", note), "1.64", "not met"),
            ("crushed", {"materials": {"concrete": {"largest compression damage": 0.99996}}}, LOG, "0.564", "not met")):
        run = make_wall(scratch / name, {**SUMMARY, **stress, **changed}, log)
        run.parameters["Materials/concrete/Compressive strength"] = "25e6"
        lines = {one.what: one for one in verdict.engineering_results(run).lines}
        one = lines["compression on the faces over compressive strength"]
        is_true(f"compression, {name}: {found} {judged}", (one.found, one.judged) == (found, judged))
        is_true("  crushed cells have a line", any("crushed" in what for what in lines) == (name == "crushed"))


def check_openings(scratch):
    """Joints are compared with the depth of their own keys; a plane has no keys."""
    run = make_wall(scratch / "openings", SUMMARY)
    run.parameters |= {"Interfaces/Names": "joints, planes", "Interfaces/joints/Face sets": "joint *",
                       "Interfaces/joints/Key depth": "0.2", "Interfaces/planes/Face sets": "wedge rear plane"}
    run.summary["interfaces"] = {"surfaces": {name: {"largest opening [mm]": opening} for name, opening in (
        ("joint 1", 250.), ("joint 2", 5.), ("wedge rear plane", 0.834))}}
    keyed, other = verdict.opening_lines(run)
    is_true("a joint wider than its keys", (keyed.found, keyed.judged, keyed.place) == ("250 mm", "not met", "joint 1"))
    is_true("a plane without keys", (other.found, other.limit, other.judged, other.place)
            == ("0.834 mm", "no limit in the case", "to be judged", "wedge rear plane"))


def check_bonds(scratch):
    """Bonds of interfaces crack where they open or slip; joints without bond do not."""
    run = make_wall(scratch / "bonds")
    run.parameters |= {"Interfaces/Names": "joints, lifts, contact", "Interfaces/joints/Face sets": "joint *",
                       "Interfaces/joints/Law": "friction", "Interfaces/lifts/Face sets": "lift *",
                       "Interfaces/lifts/Law": "softening bond", "Interfaces/contact/Face sets": "",
                       "Interfaces/contact/Between": "dam, rock", "Interfaces/contact/Law": "brittle bond"}
    surfaces = {name: {"largest opening [mm]": opening, "largest slip [mm]": slip, "largest open share [%]": share}
                for name, opening, slip, share in (("joint 1", 5., 0., 60.), ("lift 1", 1e-9, 1e-9, 0.), ("lift 2", 0.4, 0., 11.),
                                                   ("lift 3", 0.2, 0., 3.), ("contact", 0., 0.3, 0.))}
    for name, among, found, judged, place in (
            ("open", surfaces, "3 of 4", "to be judged",
             "lift 2: opening 0.400 mm, slip 0 mm, 11.0 % of its area open at once during the run"),
            ("slipped", {"contact": surfaces["contact"]}, "1 of 1", "to be judged",
             "contact: opening 0 mm, slip 0.300 mm, 0 % of its area open at once during the run"),
            ("intact", {"lift 1": surfaces["lift 1"]}, "0 of 1", "met", "")):
        run.summary["interfaces"] = {"surfaces": among}
        one = next(one for one in verdict.engineering_results(run).lines if one.what == "bonded interfaces that cracked")
        is_true(f"bonds, {name}: {found}, {judged}, {place}", (one.found, one.judged, one.place) == (found, judged, place))
    run.summary["static state"] = {"stages": [{"interfaces": {"lift 1": {"largest opening [mm]": 0.2}}}, {}]}
    is_true("  one that cracked in a static stage and closed", verdict.bond_line(run).place.startswith("lift 1: opening 0.200 mm"))
    run.summary["interfaces"] = {"surfaces": {"joint 1": surfaces["joint 1"]}}
    is_true("no line without bonds", not any("bond" in one.what for one in verdict.engineering_results(run).lines))


def limited(folder):
    """A study in this folder, with a limit."""
    found = study.Study(folder)
    found.limits = [{"of": "Ground motion/Overload factor", "values": {}, "not met at": 1.625, "met at": 1.6875,
                     "criterion": "interfaces/blocks/* wedge/slip [mm] > 100; stopped"}]
    return found


def check_study(scratch):
    """The acceptance table of each run precedes the numbers of the study."""
    folder = scratch / "study"
    folder.mkdir()
    for factor, demand in ((1, 0.1), (2, 0.2)):
        made = make_wall(folder / f"run_{factor}", {**SUMMARY, "acceptance table": {"crest": {
            "load case": "MCE", "source": "user's", "demand": demand, "at most": 0.15, "met": demand <= 0.15}}})
        with open(made.folder / "parameters.prm", "a") as file:
            file.write("subsection Acceptance\n  set Names = crest\nend\n")
    (folder / "study.json").write_text(json.dumps({"runs": [
        {"folder": f"run_{factor}", "verdict": "no objection", "values": {"Ground motion/Overload factor": str(factor)},
         "quantities": {"largest displacement [m]": 0.1 * factor}} for factor in (1, 2)]}))
    is_true("names of what is numbered", study.titled("modes/modes/0/frequency [Hz]") == "mode 1: frequency [Hz]"
            and study.titled("static state/stages/1/points/crest/displacement y [m]") == "stage 2, crest: displacement y [m]"
            and study.titled("interfaces/blocks/*/slip [mm]") == "blocks *: slip [mm]"
            and study.titled("end time [s]") == "end time [s]")
    table = next(part for part in study.study_section([], [study.Study(folder)]).parts if isinstance(part, page.Table))
    is_true("acceptance of the runs of a study", table.head == ["Overload factor", "crest, MCE"]
            and table.rows == [["1", "met: 0.100"], ["2", "not met: 0.200"]])
    is_true("a limit in all its digits, its criterion in the words of the tables", study.study_section(
        [], [limited(folder)]).parts[2] == "The limit of Overload factor lies between 1.625 and 1.6875 "
            "(criterion: * wedge: slip [mm] > 100; stopped).")
    is_true("in their colours", [row[1].colour for row in table.rows] == ["good", "bad"])
    text = make_page(folder, scratch / "study.html")
    is_true("before the conclusions of its runs", "<h2>Study" in text.split("<h2>Conclusions")[0])
    is_true("and in the page", '<td class="judged bad" data-of="crest, MCE">not met: 0.200</td>' in text)


def check_blocks(scratch):
    """Weight of a block and the forces on it when its safety is smallest."""
    run = make_wall(scratch / "blocks", {**SUMMARY, "interfaces": {"surfaces": {}, "blocks": {"wedge": {
        "mass [kg]": 1e6, "safety at the start": 2., "time at safety one or below [s]": 0.,
        "forces at the smallest safety [N]": {"contact": {"bottom": [0., 4e6, 8e6]},
                                              "driving, with inertia": [0., -4e6, -9.81e6]}}}}})
    is_true("weight of a block", interfaces.blocks_table([run]).rows[0][:3] == ["wedge", "9.81", "2.00"])
    is_true("forces on it", interfaces.forces_table([run]).rows
            == [["wedge", "contact force of bottom", "0", "4.00", "8.00"],
                ["wedge", "driving force, with its inertia", "0", "−4.00", "−9.81"]])


def check_input(run):
    is_true("entries of what the case does not use are left out",
            run.own_entries == ["Interfaces/Names = joint", "Interfaces/joint/Key depth = 0",
                                "Materials/Names = concrete", "Mesh/box/Cells = 2, 1, 4"])
    compare("damping achieved half way between 1 and 4 Hz [%]", float(structure.damping_at(run, 2.)), 4.5, 0.)
    is_true("none beyond what is known", structure.damping_at(run, 0.5) == "–")
    table = structure.waves_table([run])
    is_true("what the mesh carries", table.rows[0][:4] == ["concrete", page.number(4015.), page.number(2532.), "6.4"])
    compare("cells through the thickness", grid.dam_of(run).cells_through(0.5), 1., 0.)
    is_true("sizes of a generated dam as its log has them", case.dam_in_words(run).startswith(
        "A dam 20.0 m high and 41.5 m long along its crest, at the crown 7.00 to 9.00 m thick, of 6\u202f400 m³"))
    is_true("a strength of zero is none", "tensile strength [MPa]" not in case.materials_table(run).head)
    is_true("extent", structure.extents(run) == "−20.0 to 20.0; −4.00 to 4.00; 0 to 20.0")


def check_stages(scratch):
    """All results of a stage are in a table, with the stage, and round-off is zero."""
    def stage(name, size):
        return {"name": "usual" if name == "water" else name, "names": [name], "iterations": 12, "found by multigrid": True, "largest displacement [m]": 0.1 * size,
                "sum of loads so far [N]": [0., 0., -1.], "sum of reactions [N]": [0., 0., 1.],
                "interfaces": {"joint": {"normal force [MN]": 1e-12 if name == "weight" else 3.}},
                "points": {"crest": {"displacement y [m]": -0.05 * size, "position [m]": [0., 4., 20.]}},
                "face stresses": {"upstream face": {"largest arch stress [MPa]": size,
                                                    "place of the largest arch stress [m]": [3., 0., 5.],
                                                    "smallest": {"value [MPa]": None, "at [m]": [1e-15, 2., 3.]}}}}
    run = make_wall(scratch / "stages", {**SUMMARY, "static state": {"stages": [stage("weight", 1.), stage("water", 2.)]}})
    every = [part for part in stages.stages_section([run]).parts if isinstance(part, page.Table)]
    seen, folded = ({part.head[0]: part for part in every if bool(part.folded) == kind} for kind in (False, True))
    tables = {**seen, **folded}
    is_true("the last stage is seen at once", seen.keys() == tables.keys() and all(
        row[1] == "usual" for name in ("points", "face stresses", "interfaces") for row in seen[name].rows))
    is_true("  all stages are folded behind it", folded.keys() == {"points", "face stresses"}
            and folded["points"].folded == "points, after each stage")
    single = {**SUMMARY, "static state": {"stages": [stage("weight", 1.)]}}
    is_true("  nothing is folded after a single stage", not any(
        part.folded for part in stages.stages_section([make_wall(scratch / "one_stage", single)]).parts
        if isinstance(part, page.Table)))
    is_true("stages by themselves, without what the solver did", tables["after the stage"].rows
            == [["weight", "100"], ["usual", "200"]] and tables["after the stage"].head[1:] == ["largest displacement [mm]"])
    is_true("points over the stages, their position first", tables["points"].rows
            == [["crest", "weight", "0; 4.00; 20.0", "−50.0"], ["crest", "usual", "0; 4.00; 20.0", "−100"]])
    is_true("stresses over the stages, with their places", [row[:3] for row in tables["face stresses"].rows[:2]]
            == [["upstream face", "weight", "1.00 at 3.00; 0; 5.00"], ["upstream face", "usual", "2.00 at 3.00; 0; 5.00"]]
            and tables["face stresses"].head[2:4] == ["largest arch stress [MPa] at x; y; z [m]", "value [MPa]"])
    is_true("objects in objects, values that are not finite, round-off", tables["face stresses"].rows[2]
            == ["upstream face, smallest", "weight", "–", "–", "0; 2.00; 3.00"])
    is_true("a joint that is not there yet has no line", tables["interfaces"].rows == [["joint", "usual", "3.00"]])
    again = stages.stages_section([run, run])
    is_true("stages common to all runs are there once", again.parts[0] == "They are the same in all runs."
            and [part.rows for part in again.parts[2:]] == [part.rows for part in stages.stages_section([run]).parts[1:]])
    wall = grid.dam_of(run).grid
    settled = wall.points[wall.cells] * (0., 0., -1e-3)
    write_grid(run.folder / stages.FILE, wall.points[wall.cells], VTK_HEXAHEDRON,
               {"material": np.zeros(wall.cells.shape)}, {"material_names": ["concrete"]},
               vectors={"displacement after weight": settled, "displacement after usual": 2. * settled})
    scenes.open_display()
    pictures = stages.stages_section([run]).parts[-1].pictures
    is_true("a picture of each stage", ['stage "weight"' in pictures[0].caption, "up to 20.0 mm" in pictures[0].caption,
                                        'stage "usual"' in pictures[1].caption, "up to 40.0 mm" in pictures[1].caption]
            == 4 * [True] and len(pictures) == 2)
    run.parameters |= {"Static state/Stages": "weight; usual: water, silt", "Interfaces/joint/Grouted after": "water"}
    is_true("  with what grout has filled, from then on", ["after water, are filled and no openings" in picture.caption
                                                          for picture in stages.stage_pictures(run)] == [False, True])
    run.parameters["Ground motion/Type"] = "sine"
    is_true("load cases have the names of their stages", [row[0] for row in case.loads_table(run).rows]
            == ["weight", "usual", "usual + earthquake"])
    is_true("no stage, no section", stages.stages_section([make_wall(scratch / "no_stages")]) is None)


def divided(cells):
    """Cells (8 n, 8, 3) in place of n cells."""
    low, size = cells.min(axis=1)[:, None], np.ptp(cells, axis=1)[:, None]
    return np.concatenate([low + 0.5 * size * (UNIT_CELL + corner) for corner in UNIT_CELL])


def check_fragment(scratch):
    """Cells that were thrown by 20 m hide neither cracks of millimetres nor a motion of 2 cm."""
    summary = surface(**{"largest opening [mm]": 20.3, "time of the largest opening [s]": 0.99})
    crest = {"largest displacement [m]": 0.02, "filtered at [Hz]": 6., "largest filtered acceleration [m/s2]": 1.}
    run = make_wall(scratch / "fragment", {**SUMMARY, **summary, "histories": {"crest": crest}})
    wall = grid.Grid(run.folder / "envelopes.vtu")
    cells = divided(divided(wall.points[wall.cells]))
    thrown = np.zeros(cells.shape[:2])
    thrown[np.argsort(cells.mean(axis=1) @ (0., 0.1, 1.))[-4:]] = 1.  # at the crest, upstream
    moved = (1e-3 * cells[..., 2:] + 20. * thrown[..., None]) * (0., -1., 0.)
    cracks = np.where(thrown > 0., 20e3, np.linspace(0., 8., len(cells))[:, None])
    material = {"material": np.zeros(thrown.shape)}, {"material_names": ["concrete"]}
    write_grid(run.folder / "envelopes.vtu", cells, VTK_HEXAHEDRON, {
        **material[0], "largest_displacement_m": np.linalg.norm(moved, axis=2), "crack_opening_now_mm": cracks}, material[1])
    write_grid(run.folder / "fields.vtu", cells, VTK_HEXAHEDRON, *material, vectors={"displacement": moved})
    (run.folder / "fields.txt").write_text("1 fields.vtu\n")
    scale = damage.scale_of([run], "crack_opening_now_mm")
    is_true("cracks are seen beside it", 8. <= scale.levels[-1] <= 20. and scale.above)
    is_true("  and the largest is in the caption", damage.on_faces(run, "crack_opening_now_mm", scale).caption
            == f"On the faces; the largest value is {page.number(20e3)} mm")
    caption = structure.deformed(run).caption
    is_true("the motion of the dam is magnified", float(re.search(r"drawn (\S+) times", caption)[1]) > 50.)
    is_true("  and what is left out is in the caption", re.search(
        f"the largest value is {page.number(2002.)} cm, and what moved by more than \\S+ cm is left out", caption))
    turning = structure.scene_section([run]).parts[0]
    drawn = json.loads(turning.data)
    sizes = {name: len(base64.b64decode(drawn[name])) for name in ("dam", "motion")}
    is_true("it is not in the motion of the scene that turns", 0 < sizes["motion"] < sizes["dam"]
            and 32767. * drawn["motionUnit"] < 0.05)
    is_true("  and the page says so", re.fullmatch(r"what moved by more than \S+ cm is left out", turning.left_out))
    is_true("the widest opening is that of the summary", "by 20.3 mm when widest, at 0.990 s" in caption)
    rows = {what.split(",")[0]: value for what, value in case.headline_section([run]).parts[0].rows}
    is_true("displacements of points and of the dam", rows["largest displacement of any point of the dam"] == page.number(2002.)
            and rows["largest displacement of a recorded point relative to the base"] == "2.00 (crest)")


def check_motion(scratch):
    """The ground moves by 5 m, and the crest by 2 cm more."""
    run = make_wall(scratch / "moved")
    wall = grid.dam_of(run).grid
    corners = np.concatenate([wall.points[wall.cells], wall.points[wall.cells[:1]] - (0., 0., HEIGHT / LEVELS)])
    material = np.zeros(corners.shape[:2])
    material[-1] = 1.  # below the wall
    for time, amount in enumerate((0., 1.)):
        moved = amount * (np.maximum(1e-3 * corners[..., 2:], 0.) * (0., 1., 0.) + (5., 0., 0.))
        write_grid(run.folder / f"fields_{time}.vtu", corners, VTK_HEXAHEDRON, {"material": material},
                   {"material_names": ["concrete", "rock"]}, vectors={"displacement": moved})
    (run.folder / "fields.txt").write_text("0 fields_0.vtu\n1 fields_1.vtu\n")
    motion = structure.motion_of(run, "fields_1.vtu")
    compare("the crest beside its foundation [m]", motion[:, 1].max(), 1e-3 * HEIGHT, 1e-6)
    compare("  without the motion of the ground [m]", np.abs(motion[:, [0, 2]]).max() + 1., 1., 1e-6)


def check_records(scratch):
    table = scratch / "table.txt"
    table.write_text("# A record. From a book.\n" + "".join(f"{0.02 * i:.2f} 0.1\n" for i in range(151)))
    peer = scratch / "record.at2"
    peer.write_text("PEER\nA record\nACCELERATION\nNPTS=  500, DT=  .0100 SEC\n 0.1 0.2\n")
    compare("duration of a table [s]", records.duration_of(table), 3., 1e-6)
    compare("duration of an AT2 file [s]", records.duration_of(peer), 4.99, 1e-6)
    is_true("hash", records.sha256(table) == hashlib.sha256(table.read_bytes()).hexdigest())
    times = np.linspace(0., 10., 1001)
    sine, cosine = np.sin(2. * np.pi * times), np.cos(2. * np.pi * times)
    compare("correlation of a sine with itself", records.correlation(sine, 0.3 * sine), 1., 1e-9)
    is_true("with a cosine there is none", abs(records.correlation(sine, cosine)) < 1e-2)
    is_true("nor with rest", records.correlation(sine, 0. * sine) is None)


def check_study_evaluations():
    levels = [{"Materials/rock/Density": "2600", "intensity": intensity, "runs": 5, "criterion met": met,
               "probability": None, "median": 2., "median from": 1.5, "median to": 3., "dispersion": 0.4,
               "dispersion from": 0.2, "dispersion to": 0.8, "verdict": "found"} for intensity, met in ((1., 1), (2., 3))]
    sizes = {"coarse": 1.16, "middle": 1.04, "fine": 1.01}
    table, fragility, curve, moves, fits = study_evaluations.evaluations({
        "convergence": [{"quantity": "crest [m]", **sizes, "observed order": 2., "extrapolated": 1.,
                         "band about the fine one": 0.0125, "verdict": "converges"},
                        {"quantity": "heel [MPa]", **sizes, "observed order": None, "extrapolated": None,
                         "band about the fine one": None, "verdict": "diverges"}],
        "fragility": {"intensity": "Ground motion/Overload factor", "criterion": "crest [m] > 1", "confidence": 0.9,
                      "levels": levels},
        "sensitivity": {"change": 0.01, "numbers": [
            {"number": f"number {i}", "value": 1., "quantity": "crest [m]", "as given": 1., "largest change [%]": 1.,
             "change over that of the number": 1.} for i in range(40)]},
        "calibration": {"error": 0.01, "lines": [
            {"number": "Materials/rock/Young's modulus", "in the file": 12e9, "found": 20e9, "standard error [%]": 3.,
             "quantity": "frequency [Hz]", "measured": 5.45, "with the file": 5., "with what was found": 5.46,
             "off by [%]": 0.2, "change over that of the number": 0.1, "verdict": "found"}]}})
    is_true("a number that converges has a band", table.rows[0][-2:] == [f"± {page.number(0.0125)}", "converges"])
    is_true("one that does not has none", table.rows[1][-3:] == ["–", "–", "diverges"])
    is_true("a fragility curve is of its combination", fragility.rows[0][0] == "Density 2600")
    is_true("  with runs, median and bounds", f"{page.number(2.)}: 3 of 5" in fragility.rows[0][1]
            and f"({page.number(1.5)} to {page.number(3.)})" in fragility.rows[0][2])
    is_true("  and a picture", curve.pictures[0].kind == "svg")
    is_true("of many sensitivities the first ones, and how many there are",
            len(moves.rows) == study_evaluations.MOST and "of 40 lines" in moves.caption)
    is_true("what was fitted, and to which number", fits.rows[0][:2] == ["Materials/rock/Young's modulus", "–"]
            and fits.rows[0][-1] == "found" and page.number(1.) in fits.caption)


def make_page(folder, file, **environment):
    answer = subprocess.run([report / "voussoir-report", folder, "-o", file], text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, check=False, env={**os.environ, **environment})
    is_true(f"a page is made: {file.name}", answer.returncode == 0)
    return file.read_text(encoding="utf-8") if answer.returncode == 0 else ""


def check_page(scratch):
    folder = scratch / "sliding_on"
    text = make_page(folder, scratch / "without.html", VOUSSOIR_VTK_JS="/nowhere/vtk.js")
    kinds = dict(re.findall(r'<div class="verdict (\w+)">\s*<span class="soft">([^<]*)<', text)[::-1])
    is_true("blocks of a page", kinds == {"good": "Numerical checks", "bad": "Engineering results"})
    is_true("no verdict of old", "But look" not in text and "but look" not in text)
    is_true("a scene without vtk.js is reported as a still picture", "vtk.js was not found" in text and "vtk-js" not in text)
    is_true("all of the input", "all of parameters.prm" in text and "subsection Interfaces" in text)
    library = page.vtk_js()
    browser = shutil.which("chromium")
    if browser is None:
        print("neither phone nor scene are tried, as there is no chromium")
        return
    phone = scratch / "phone.html"
    phone.write_text(text.replace("</body>", TOO_WIDE + "</body>"))
    is_true("no table is wider than a phone", 'data-too-wide="0"'
            in browse(browser, scratch, "--dump-dom", phone, size="390,3000"))
    if library is None:
        print("the scene is not tried, as there is no vtk.js")
        return
    file = scratch / "with.html"
    text = make_page(folder, file)
    is_true("a page with a scene stays small [5 MB]", len(text.encode()) < 5e6)
    is_true("it loads nothing", not re.search(r'(?:src|href)="(?!data:|#)', text))
    turned = scratch / "turned.html"
    turned.write_text(text.replace("</body>", TURN + "</body>"))
    state = browse(browser, scratch, "--dump-dom", file)
    is_true("the scene is drawn", 'data-state="turns"' in state)
    pictures = []
    for name, which in (("still", file), ("turned", turned)):
        browse(browser, scratch, f"--screenshot={scratch / name}.png", which)
        pictures.append((scratch / f"{name}.png").read_bytes())
    is_true("the scene turns", pictures[0] != pictures[1])


TURN = """<script>
window.addEventListener("load", () => setTimeout(() => {
  const canvas = document.querySelector(".scene canvas"), box = canvas.getBoundingClientRect();
  const move = (kind, x, y) => canvas.dispatchEvent(new PointerEvent(kind, {
    bubbles: true, cancelable: true, pointerId: 1, pointerType: "mouse", isPrimary: true, button: 0, buttons: 1,
    clientX: box.left + x, clientY: box.top + y, pageX: box.left + x, pageY: box.top + y}));
  move("pointerdown", 300, 300);
  for (let i = 1; i < 20; ++i) move("pointermove", 300 + 10 * i, 300 - 5 * i);
  move("pointerup", 490, 205);
}, 5000));
</script>"""


# number of tables that have to be scrolled sideways
TOO_WIDE = """<script>
document.body.dataset.tooWide = [...document.querySelectorAll(".scroll")].filter(
  (place) => place.scrollWidth > place.clientWidth).length;
</script>"""


def browse(browser, scratch, what, file, size="1280,3000"):
    with tempfile.TemporaryDirectory(dir=scratch) as profile:
        return subprocess.run(
            [browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync",
             f"--user-data-dir={profile}", f"--window-size={size}", "--virtual-time-budget=15000", what,
             f"file://{file}"], text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False,
            timeout=300).stdout


def main():
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        run = make_wall(scratch / "wall")
        check_profiles(run)
        check_lifts(scratch)
        check_wide_opening(scratch)
        check_refined(run, scratch)
        check_damage(scratch)
        check_abscissa(run)
        check_colours()
        check_input(run)
        check_stages(scratch)
        check_fragment(scratch)
        check_motion(scratch)
        check_blocks(scratch)
        check_records(scratch)
        check_study_evaluations()
        check_verdicts(scratch)
        check_compression(scratch)
        check_openings(scratch)
        check_bonds(scratch)
        check_study(scratch)
        check_page(scratch)
    verdicts.end()


if __name__ == "__main__":
    main()
