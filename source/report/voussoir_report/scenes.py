"""Pictures in space: VTK, on a virtual display."""

import atexit
import base64
import json
import os
import shutil
import subprocess

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow,
                                         vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (draws)

from .files import ReportError

STONE, CONCRETE = (0.80, 0.77, 0.72), (0.86, 0.86, 0.84)
FROM_DOWNSTREAM = (0.35, -1., 0.55)


def open_display():
    """Starts an invisible X display, which Debian's VTK needs to draw with OpenGL."""
    server = shutil.which("Xvfb")
    if not server:
        if os.environ.get("DISPLAY"):
            return
        raise ReportError("There is no display to draw on; install the package xvfb.")
    ours, theirs = os.pipe()
    # without -noreset no process could connect for a moment after another one has left
    process = subprocess.Popen(
        [server, "-displayfd", str(theirs), "-screen", "0", "64x64x24", "-nolisten", "tcp", "-noreset"],
        pass_fds=[theirs], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(theirs)
    with os.fdopen(ours) as pipe:
        number = pipe.readline().strip()
    if not number:
        raise ReportError("The invisible display (Xvfb) does not start; set DISPLAY to another display.")
    atexit.register(process.terminate)
    os.environ["DISPLAY"] = ":" + number


def quadrilaterals(corners, colours, edges=True):
    """An actor of VTK: corners (n, 4, 3), colours (3,), (n, 3) or (n, 4, 3)."""
    data = vtkPolyData()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(corners.reshape(-1, 3)), deep=True))
    data.SetPoints(points)
    cells = vtkCellArray()
    n = len(corners)
    cells.SetData(numpy_to_vtkIdTypeArray(4 * np.arange(n + 1), deep=True),
                  numpy_to_vtkIdTypeArray(np.arange(4 * n), deep=True))
    data.SetPolys(cells)
    colours = np.asarray(colours, float)
    at_corners = colours.ndim == 3
    if colours.ndim == 1:
        colours = np.tile(colours, (n, 1))
    numbers = numpy_to_vtk((255 * colours.reshape(-1, 3)).astype(np.uint8), deep=True)
    (data.GetPointData() if at_corners else data.GetCellData()).SetScalars(numbers)

    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetInterpolationToFlat()
    look.SetAmbient(0.5)
    look.SetDiffuse(0.55)
    if edges:
        look.EdgeVisibilityOn()
        look.SetEdgeColor(0.25, 0.25, 0.25)
        look.SetLineWidth(1.)
    return actor


def draw(actors, around, direction, size=(1500, 960), zoom=1.):
    """RGB (height, width, 3) of a scene with the points @p around (n, 3) in the middle, and
    the width of the scene [m].

    @p direction from the middle to the eye, which is far away (no perspective).
    """
    renderer = vtkRenderer()
    renderer.SetBackground(1., 1., 1.)
    for actor in actors:
        renderer.AddActor(actor)
    direction = np.array(direction, float) / np.linalg.norm(direction)
    right = np.cross((0., 0., 1.), direction)
    right /= np.linalg.norm(right)
    up = np.cross(direction, right)
    across, upwards = around @ right, around @ up
    middle = (right * (across.max() + across.min()) / 2. + up * (upwards.max() + upwards.min()) / 2.
              + direction * (around @ direction).mean())
    reach = 1e4 + 10. * np.ptp(around, axis=0).max()

    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + reach * direction))
    camera.SetViewUp(*up)
    half_height = max(np.ptp(upwards), np.ptp(across) * size[1] / size[0]) * 0.52 / zoom
    camera.SetParallelScale(half_height)
    renderer.ResetCameraClippingRange()

    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*size)
    window.AddRenderer(renderer)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.Update()
    pixels = image.GetOutput()
    rows = vtk_to_numpy(pixels.GetPointData().GetScalars()).reshape(size[1], size[0], -1)
    return rows[::-1, :, :3], 2. * half_height * size[0] / size[1]


def packed(values, kind):
    return base64.b64encode(np.ascontiguousarray(values, kind).tobytes()).decode()


def as_json(corners, colours, rock, motion, factor):
    """A scene for the browser: quadrilaterals of the dam (n, 4, 3) with colours (n, 4, 3),
    a motion (m, 4, 3) [m] of the first of them that is drawn up to @p factor times, while those
    without motion are hidden, and quadrilaterals of the rock; in 16 bits, that is to
    centimetres."""
    middle = 0.5 * (corners.min(axis=(0, 1)) + corners.max(axis=(0, 1)))
    unit = np.abs(np.concatenate([corners, rock]) - middle).max() / 32767.
    motion_unit = max(np.abs(motion).max(), 1e-9) / 32767.
    return json.dumps({
        "middle": middle.tolist(), "unit": unit, "dam": packed(np.rint((corners - middle) / unit), "<i2"),
        "colours": packed(np.rint(255. * colours), "u1"), "rock": packed(np.rint((rock - middle) / unit), "<i2"),
        "stone": STONE, "eye": FROM_DOWNSTREAM, "motionUnit": motion_unit,
        "motion": packed(np.rint(motion / motion_unit), "<i2") if factor else ""})


def without_outer_planes(corners):
    """Whether each quadrilateral (n, 4, 3) lies outside the planes that bound the model."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    keep = np.ones(len(corners), bool)
    for axis in range(3):
        for plane in ((low[axis], high[axis]) if axis < 2 else (low[axis],)):
            keep &= ~np.all(np.abs(corners[:, :, axis] - plane) < 1e-3, axis=1)
    return keep
