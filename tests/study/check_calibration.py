#!/usr/bin/python3
"""Moduli of a rod of two materials, from its frequencies in closed form.

usage: check_calibration.py PROGRAM SOURCE_FOLDER
"""

import importlib.util
import pathlib
import subprocess
import sys

if importlib.util.find_spec("numpy") is None:
    print("numpy is missing")
    sys.exit(77)

program, source = sys.argv[1], pathlib.Path(sys.argv[2])
# f of Z1 cot(2 pi f L1 / c1) = Z2 tan(2 pi f L2 / c2): 40 m of rock, 20 GPa and 2700 kg/m3,
# below 60 m of concrete, 30 GPa and 2400 kg/m3, with impedances Z and wave speeds c
FREQUENCIES = "7.535475", "24.023641", "39.166642"
failed = []


def is_true(what, good, said=""):
    print(f"{what}  {'ok' if good else 'FAILED: ' + said}")
    if not good:
        failed.append(what)


def calibrate(entries, frequencies):
    """Exit code, and what is said."""
    run = subprocess.run([sys.executable, source / "doc/published/calibrate.py",
                          source / "tests/data/rod_of_two.prm", "--fit", *entries, "--measured", *frequencies,
                          "--program", program],
                         text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, timeout=300)
    return run.returncode, run.stdout


rock, concrete = "Materials/rock/Young's modulus=12e9", "Materials/concrete/Young's modulus=36e9"
code, said = calibrate([rock, concrete], FREQUENCIES)
is_true("both moduli are found", code == 0, said)
if code == 0:
    lines = said.splitlines()
    for line, modulus in zip(lines, (20e9, 30e9)):
        found = float(line.split("=")[1].split(",")[0])
        is_true(f"  {found:.4g} Pa, {modulus:.4g} Pa within 1 %", abs(found / modulus - 1.) < 0.01, said)
    # frequencies grow with the root of both moduli together
    for line in lines[3:]:
        both = sum(float(word) for word in line.split()[-2:])
        is_true(f"  a frequency changes by {both} of the change of both, 0.5 within 1 %", abs(both - 0.5) < 0.005, said)
code, said = calibrate([rock, concrete], FREQUENCIES[:1])
is_true("one frequency does not fix two moduli", code == 1 and "give more" in said, said)
code, said = calibrate(["Materials/rock/Young's modulus=12e9", "Materials/rock/Density=2700",
                        "Materials/concrete/Young's modulus=36e9", "Materials/concrete/Density=2400"],
                       FREQUENCIES + ("55.514995",))
is_true("frequencies do not fix moduli and densities at once", code == 1 and "tell the entries apart" in said, said)
sys.exit(bool(failed))
