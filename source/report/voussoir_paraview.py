"""Shows a run in ParaView, in up to four views of its dam: the motion over time with damage or
tension, the largest tension of the whole run, the joints, the arch stress.

As a macro (Macros, Import new macro, this file) it is a button and takes the run whose results are
open (its fields.pvd, or any of its files). Or without ParaView open:

  voussoir-paraview FOLDER                           opens it
  pvpython voussoir_paraview.py FOLDER PICTURE.png   draws a picture
"""

import collections
import os
import sys

from paraview import simple as pv

# quantities of a view, of which the first one in the results is taken; None in a range stands for
# the extreme in the dam
Quantity = collections.namedtuple("Quantity", "field title low high", defaults=(None, None))
STATE = [Quantity("tension_damage", "damage in tension [-]", 0., 1.),
         Quantity("damage", "damage [-]", 0., 1.),
         Quantity("largest_principal_stress_MPa", "largest principal stress [MPa]")]
ENVELOPE = [Quantity("largest_principal_stress_MPa", "largest tension of the run [MPa]", 0.),
            Quantity("largest_acceleration_m_per_s2", "largest acceleration [m/s2]", 0.)]
JOINTS = [Quantity("largest_opening_mm", "largest opening of the joints [mm]", 0.)]
FACES = [Quantity("largest_arch_stress_MPa", "largest arch stress of the run [MPa]")]

MOTIONS = ["displacement_since_static_state", "displacement_since_grouting", "displacement"]
LARGEST_MOTION = 0.05  # as drawn, over the height of the dam
ROCK = [0.80, 0.77, 0.72]
DARK = [0.2, 0.2, 0.2]
FROM_DOWNSTREAM, FROM_THE_RIGHT = (0.35, -1., 0.55), (-1., -0.5, 0.3)  # +y is upstream


def result_folder():
    """The folder that is given, or that of the source selected in ParaView."""
    folder = os.environ.get("VOUSSOIR_RESULTS") or (sys.argv[1] if len(sys.argv) > 1 else "")
    if not folder:
        files = getattr(pv.GetActiveSource(), "FileName", "")
        folder = os.path.dirname(files if isinstance(files, str) else files[0])
        if os.path.basename(folder) in ("fields", "face_stresses"):
            folder = os.path.dirname(folder)
    if not os.path.isfile(os.path.join(folder, "parameters.prm")):
        raise RuntimeError(f'"{folder}" is not the output folder of a run, as it has no parameters.prm; '
                           "open the fields.pvd of a run and select it in the Pipeline Browser, or give "
                           "the folder of the run to voussoir-paraview.")
    return folder


def open_results(folder, *names):
    """A source of ParaView for the first of these files that exists, or None."""
    for name in names:
        file = os.path.join(folder, name)
        if os.path.isfile(file):
            source = pv.OpenDataFile(file)
            pv.RenameSource(name, source)
            source.UpdatePipeline()
            return source
    return None


def names_of(source, field):
    """Names that the numbers of a field stand for."""
    data = source.GetDataInformation().DataInformation.GetFieldDataInformation()
    names = data.GetArrayInformation(field + "_names")
    return [names.GetStringValue(i).strip('"') for i in range(names.GetNumberOfStringValues())]


def dam_materials(names):
    """Numbers of the materials with dam, block or concrete, and without rock, in their names,
    or else of the first material."""
    def is_called(name, *words):
        return any(word in name.lower() for word in words)

    return [number for number, name in enumerate(names) if is_called(name, "dam", "block", "concrete")
            and not is_called(name, "rock", "foundation")] or [0]


def dam_and_rock(source):
    """Cells of the dam, and the other cells or None."""
    names = names_of(source, "material")
    dam = dam_materials(names)

    def cells_of(title, numbers):
        parts = [pv.Threshold(Input=source, Scalars=["POINTS", "material"],
                              LowerThreshold=number - 0.5, UpperThreshold=number + 0.5)
                 for number in numbers]
        cells = parts[0] if len(parts) == 1 else pv.AppendDatasets(Input=parts)
        pv.RenameSource(title, cells)
        cells.UpdatePipeline()
        return cells

    rock = [number for number in range(len(names)) if number not in dam]
    return cells_of("dam", dam), cells_of("rock", rock) if rock else None


def times_of(series):
    """Times of a series [s]; an arbitrary one for a single picture."""
    return list(getattr(series, "TimestepValues", None) or [0.])


def largest_motion(dam, field, series):
    """The largest motion in all pictures [m]."""
    largest = 0.
    for time in times_of(series):
        dam.UpdatePipeline(time)
        largest = max(largest, dam.PointData.GetArray(field).GetRange(-1)[1])
    return largest


def warped(fields):
    """The source warped by the magnified motion, and the factor; the source itself if nothing moves."""
    field = next((name for name in MOTIONS if fields.PointData.GetArray(name)), None)
    dam, _ = dam_and_rock(fields)
    largest = largest_motion(dam, field, fields) if field else 0.
    if largest == 0.:
        return fields, 0.
    bounds = dam.GetDataInformation().GetBounds()
    factor = float(f"{LARGEST_MOTION * (bounds[5] - bounds[4]) / largest:.0e}")
    warp = pv.WarpByVector(Input=fields, Vectors=["POINTS", field], ScaleFactor=factor)
    title = f"{field.replace('_', ' ')}, {factor:g} times"
    print(title)
    pv.RenameSource(title, warp)
    warp.UpdatePipeline()
    return warp, factor


def range_of(source, quantity, series):
    """The range of a quantity over all pictures."""
    low, high = [], []
    for time in times_of(series):
        source.UpdatePipeline(time)
        found = source.PointData.GetArray(quantity.field).GetRange()
        low.append(found[0])
        high.append(found[1])
    low = min(low) if quantity.low is None else quantity.low
    high = max(high) if quantity.high is None else quantity.high
    if quantity.low is None and low < 0. < high:  # symmetric, so that colours show the sign
        high = max(-low, high)
        low = -high
    return low, max(high, low + 1e-6)


def show(source, view, colour):
    display = pv.Show(source, view)
    display.Representation = "Surface With Edges"
    display.EdgeColor = DARK
    display.Ambient, display.Diffuse = 0.5, 0.55  # weak shades, which are not mistaken for colours
    display.ColorArrayName = [None, ""]
    display.AmbientColor = display.DiffuseColor = colour
    return display


def colour_by(source, view, quantities, series):
    """Shows a source by the first of these quantities that it has."""
    display = show(source, view, ROCK)
    quantity = next((item for item in quantities if source.PointData.GetArray(item.field)), None)
    if quantity is None:
        return
    # a colour table for each view, as the range of a field differs between views
    pv.ColorBy(display, ("POINTS", quantity.field), separate=True)
    table = pv.GetColorTransferFunction(quantity.field, display, separate=True)
    low, high = range_of(source, quantity, series)
    print(f"{quantity.title} from {low:.4g} to {high:.4g}")
    table.ApplyPreset("Cool to Warm" if low < 0. else "Inferno (matplotlib)", True)
    if low >= 0.:
        table.InvertTransferFunction()
    table.RescaleTransferFunction(low, high)
    bar = pv.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = quantity.title, ""
    bar.TitleColor = bar.LabelColor = DARK
    bar.TitleFontSize, bar.LabelFontSize = 14, 12
    bar.LabelFormat = bar.RangeLabelFormat = "%.3g"
    bar.Orientation, bar.WindowLocation = "Horizontal", "Lower Center"
    bar.ScalarBarThickness, bar.ScalarBarLength = 12, 0.4
    bar.DrawBackground, bar.BackgroundColor = 1, [1., 1., 1., 0.7]
    display.SetScalarBarVisibility(view, True)


def new_view(title, around, direction):
    low, high = around[::2], around[1::2]
    if high[0] - low[0] < 0.5 * (high[2] - low[2]):  # a slice of a dam
        direction = FROM_THE_RIGHT
    view = pv.CreateView("RenderView")
    pv.RenameView(title, view)
    view.UseColorPaletteForBackground = 0
    view.Background = [1., 1., 1.]
    view.OrientationAxesLabelColor = DARK
    view.CameraParallelProjection = 1
    size = sum((b - a)**2 for a, b in zip(low, high))**0.5
    middle = [0.5 * (a + b) for a, b in zip(low, high)]
    middle[2] -= 0.1 * size  # space for the colour bar below
    view.CameraFocalPoint = middle
    view.CameraPosition = [m + size * d for m, d in zip(middle, direction)]
    view.CameraViewUp = [0., 0., 1.]
    view.CameraParallelScale = 0.55 * size
    return view


def note(view, source):
    """Shows a line of text in the corner of a view."""
    display = pv.Show(source, view)
    display.Color = DARK
    display.FontSize = 12
    display.WindowLocation = "Upper Left Corner"


def show_motion(fields, view_of):
    moving, factor = warped(fields)
    dam, rock = dam_and_rock(moving)
    view = view_of("motion", dam)
    colour_by(dam, view, STATE, fields)
    if rock:
        show(rock, view, ROCK)
    motion = f"motion {factor:g} times" if factor else "without motion"
    if len(times_of(fields)) > 1:
        note(view, pv.AnnotateTimeFilter(Input=fields, Format="t = {time:.2f} s, " + motion))
    else:
        note(view, pv.Text(Text=motion))


def arrange(views, title):
    """A layout of views, two in a row."""
    layout = pv.CreateLayout(title)
    cells = [0]  # of a binary tree: below n are 2 n + 1 and 2 n + 2
    if len(views) > 1:
        layout.SplitVertical(0, 0.5)
        cells = [1, 2]
    if len(views) > 2:
        layout.SplitHorizontal(1, 0.5)
        cells = [3, 4, 2]
    if len(views) > 3:
        layout.SplitHorizontal(2, 0.5)
        cells = [3, 4, 5, 6]
    for cell, view in zip(cells, views):
        layout.AssignView(cell, view)
    return layout


def show_run(folder):
    """The layout with views of all results in the folder."""
    views, around = [], None

    def view_of(title, source, direction=FROM_DOWNSTREAM):
        nonlocal around
        around = around or source.GetDataInformation().GetBounds()
        views.append(new_view(title, around, direction))
        return views[-1]

    fields = open_results(folder, "fields.pvd", "last_good.vtu")
    if fields:
        show_motion(fields, view_of)
    envelopes = open_results(folder, "envelopes.vtu")
    if envelopes:
        dam, _ = dam_and_rock(envelopes)
        colour_by(dam, view_of("envelopes", dam), ENVELOPE, envelopes)
    joints = open_results(folder, "interface_envelopes.vtu")
    if joints:
        colour_by(joints, view_of("joints", joints, FROM_THE_RIGHT), JOINTS, joints)
    faces = open_results(folder, "face_stress_envelopes.vtu")
    if faces:
        colour_by(faces, view_of("faces", faces), FACES, faces)
    if not views:
        raise RuntimeError(f'"{folder}" has no pictures; add "fields", "envelopes" or "interfaces" to '
                           '"Observers" in section "Output".')

    scene = pv.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()
    return arrange(views, os.path.basename(os.path.abspath(folder)))


def main():
    layout = show_run(result_folder())
    pv.RenderAllViews()
    if len(sys.argv) > 2:
        layout.SetSize(1500, 1000)
        pv.SaveScreenshot(sys.argv[2], layout)


main()
