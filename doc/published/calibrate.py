#!/usr/bin/env python3
"""Fits entries of a case to natural frequencies that were measured.

    python3 calibrate.py CASE.prm --fit ENTRY [ENTRY ...] --measured HZ [HZ ...]

    python3 calibrate.py dam.prm --fit "Materials/concrete/Young's modulus=28e9" \\
        "Materials/rock/Young's modulus=14e9" --measured 5.45 5.68 7.1

Each entry has the value at which the search begins; the frequencies are those of the
lowest modes in their order, 0 for one that was not measured. Steps of Gauss and Newton
in the logarithms of the entries make the sum of the squares of relative differences
smallest. Printed are the entries with standard errors (--error is that of a
frequency), and of each frequency what was measured and computed, and its relative
change over that of each entry. Modes that change places are not told apart.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy

DIFFERENCE = 0.02  # of a logarithm, for the sensitivities
LARGEST = 0.7  # change of a logarithm in one step


def frequencies(options, entries, values):
    """Of the modes with these values of the entries."""
    with tempfile.TemporaryDirectory() as folder:
        said = subprocess.run(
            [options.program, options.case, "--set", "Time/End time=0", "Ground motion/Type=none",
             f"Modes/Number={len(options.measured)}", "Output/Observers=", f"Output/Folder={folder}/run",
             *[f"{entry}={value:.12g}" for entry, value in zip(entries, values)]],
            text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        summary = pathlib.Path(folder, "run", "summary.json")
        if not summary.exists():
            sys.exit(said.stdout)
        modes = json.loads(summary.read_text())["modes"]["modes"]
    return numpy.array([mode["frequency [Hz]"] for mode in modes])


def calibrate(options):
    entries = [text.rsplit("=", 1)[0] for text in options.fit]
    start = numpy.log([float(text.rsplit("=", 1)[1]) for text in options.fit])
    known = numpy.array(options.measured) > 0.
    measured = numpy.array(options.measured)[known]
    if len(measured) < len(entries):
        sys.exit(f"{len(measured)} frequencies do not fix {len(entries)} entries; give more of them.")

    def misfit(place):
        return numpy.log(frequencies(options, entries, numpy.exp(place))[known] / measured)
    place, here = start, misfit(start)
    first = here
    for _ in range(options.iterations):
        slopes = numpy.transpose([(misfit(place + DIFFERENCE * unit) - here) / DIFFERENCE
                                  for unit in numpy.eye(len(entries))])
        if numpy.linalg.svd(slopes, compute_uv=False)[-1] < 1e-3:
            sys.exit("These frequencies do not tell the entries apart; fit fewer of them.")
        step = -numpy.linalg.lstsq(slopes, here, rcond=None)[0]
        if abs(step).max() < options.accuracy:
            break
        step *= min(1., LARGEST / abs(step).max())
        there = misfit(place + step)
        while numpy.linalg.norm(there) >= numpy.linalg.norm(here) and abs(step).max() > options.accuracy:
            step /= 2
            there = misfit(place + step)
        if numpy.linalg.norm(there) >= numpy.linalg.norm(here):
            break
        place, here = place + step, there
    else:
        sys.exit(f"Not found in {options.iterations} steps; begin at other values.")
    errors = options.error * numpy.sqrt(numpy.diag(numpy.linalg.inv(slopes.T @ slopes)))
    return entries, start, place, errors, measured, first, here, slopes


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    parser.add_argument("--fit", nargs="+", required=True, metavar="ENTRY", help='"Section/Entry=value"')
    parser.add_argument("--measured", nargs="+", type=float, required=True, metavar="HZ")
    parser.add_argument("--error", type=float, default=0.01, help="relative, of a frequency")
    parser.add_argument("--accuracy", type=float, default=1e-3, help="relative change at which it ends")
    parser.add_argument("--iterations", type=int, default=10)
    parser.add_argument("--program", default="voussoir")
    entries, start, place, errors, measured, first, here, slopes = calibrate(parser.parse_args())
    for entry, begin, found, error in zip(entries, start, place, errors):
        print(f"{entry} = {numpy.exp(found):.6g}, began at {numpy.exp(begin):.6g}, "
              f"standard error {100 * error:.2g} %")
    print("measured [Hz]  at the start  as fitted  off by [%]  relative change over that of each entry")
    for k, value in enumerate(measured):
        print(f"{value:13.4f}{value * numpy.exp(first[k]):14.4f}{value * numpy.exp(here[k]):11.4f}"
              f"{100 * numpy.expm1(here[k]):12.3f}  " + "  ".join(f"{s:.3f}" for s in slopes[k]))


if __name__ == "__main__":
    main()
