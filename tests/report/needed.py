"""Packages that reports need; without one of them a test is skipped."""

import shutil
import sys

SKIPPED = 77  # exit code for ctest

try:
    import jinja2  # noqa: F401
    import matplotlib  # noqa: F401
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
except ImportError as error:
    print(f"skipped: {error}; install python3-vtk9, python3-matplotlib and python3-jinja2")
    sys.exit(SKIPPED)
if not shutil.which("Xvfb"):
    print("skipped: the package xvfb is missing")
    sys.exit(SKIPPED)
