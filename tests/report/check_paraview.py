#!/usr/bin/python3
"""Shows a small run in ParaView and compares the view with closed forms.

usage: check_paraview.py PROGRAM voussoir_paraview.py CASE.prm
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

if not (shutil.which("pvpython") and shutil.which("xvfb-run")):
    print("skipped: the package python3-paraview or xvfb is missing")
    sys.exit(77)

sys.dont_write_bytecode = True
import verdicts  # noqa: E402
from verdicts import compare, is_true  # noqa: E402

program, script, case = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
HEIGHT = 20.
SETTLEMENT = 2400. * 9.81 * HEIGHT**2 / (2. * 30e9)  # of the block, and opening of the joint [m]


def show(folder, *picture, **environment):
    return subprocess.run(["xvfb-run", "-a", "pvpython", script, *map(str, (folder, *picture))],
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
                          env={**os.environ, **environment})


with tempfile.TemporaryDirectory() as name:
    run, picture = pathlib.Path(name) / "run", pathlib.Path(name) / "run.png"
    subprocess.run([program, case, "--set", f"Output/Folder={run}"], check=True,
                   stdout=subprocess.DEVNULL)
    answer = show(run, picture)
    is_true("it is shown", answer.returncode == 0)
    if answer.returncode != 0:
        print(answer.stdout)
        sys.exit(1)
    opening = re.search(r"largest opening of the joints \[mm\] from 0 to (\S+)", answer.stdout)
    compare("opening of the joint [mm]", float(opening[1]), 1e3 * SETTLEMENT, 0.1)
    factor = re.search(r"displacement, (\S+) times", answer.stdout)
    compare("motion as drawn over the height of the dam [%]",
            100. * float(factor[1]) * SETTLEMENT / HEIGHT, 5., 20.)
    is_true("with its tension over the run", "largest tension of the run [MPa] from 0" in answer.stdout)
    is_true("the picture is there", picture.stat().st_size > 10000)
    is_true("what is no run is refused", "is not the output folder of a run" in show(name).stdout)
verdicts.end()
