#!/usr/bin/env python3
"""Measures the step on this machine and writes the tables of performance.md.

usage: performance.py PROGRAM [--ranks 1,2] [--repeat 2] [--lulesh LULESH]

Throughput is that of prm/benchmarks, the best of --repeat runs. LULESH is the serial
program of that name; its rate is three times the nodes of its mesh, times steps, over time.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "doc/performance.md"
SINGLE = "Discretization/Cell precision=single"
ONE_POINT = "Discretization/Quadrature=one point"
KINDS = [
    ("degree 1, eight points", "throughput", []),
    ("the same in single precision", "throughput", [SINGLE]),
    ("degree 1, one point", "throughput", [ONE_POINT]),
    ("the same in single precision", "throughput", [ONE_POINT, SINGLE]),
    ("cracking concrete, eight points", "throughput_damage", []),
    ("the same in single precision", "throughput_damage", [SINGLE]),
    ("cracking concrete, one point", "throughput_damage", [ONE_POINT]),
    ("the same in single precision", "throughput_damage", [ONE_POINT, SINGLE]),
    ("degree 2", "throughput", ["Discretization/Degree=2", "Mesh/box/Cells=24, 24, 24"]),
    ("degree 3", "throughput", ["Discretization/Degree=3", "Mesh/box/Cells=16, 16, 16"]),
    ("degree 4", "throughput", ["Discretization/Degree=4", "Mesh/box/Cells=12, 12, 12"]),
]


def run(program, case, settings, ranks, folder):
    """Summary of a run."""
    command = [str(program)] if ranks == 1 else \
        [str(program.parent / "voussoir-run"), "-n", str(ranks)]
    command += [str(ROOT / f"prm/benchmarks/{case}.prm"), "--overwrite", "--set",
                f"Output/Folder={folder}", *settings]
    process = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if process.returncode != 0:
        sys.exit(process.stdout[-2000:])
    return json.loads((folder / "summary.json").read_text())


def processor():
    text = pathlib.Path("/proc/cpuinfo").read_text()
    name = re.search(r"model name\s*: (.*)", text).group(1)
    return f"{name}, {text.count('processor')} cores"


def lulesh_rate(program, size=48, steps=200):
    start = time.time()
    subprocess.run([program, "-s", str(size), "-i", str(steps), "-q"], check=True,
                   stdout=subprocess.DEVNULL)
    return 3e-6 * (size + 1) ** 3 * steps / (time.time() - start)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--ranks", default="1,2")
    parser.add_argument("--repeat", type=int, default=2)
    parser.add_argument("--lulesh")
    options = parser.parse_args()
    program = options.program.resolve()
    ranks = [int(n) for n in options.ranks.split(",")]

    peer = lulesh_rate(options.lulesh) if options.lulesh else None
    head = ["MDOF-steps/s"] + [f"{n} rank{'s' * (n > 1)}" for n in ranks]
    if peer:
        head.append("one rank over LULESH")
    rows = [head, ["---"] * len(head)]
    with tempfile.TemporaryDirectory() as folder:
        for name, case, settings in KINDS:
            rates = []
            for n in ranks:
                runs = [run(program, case, settings, n, pathlib.Path(folder) / case)
                        for _ in range(options.repeat)]
                rates.append(max(summary["MDOF-steps/s"] for summary in runs))
                version, bits = (runs[0][key] for key in ("version", "SIMD bits"))
            row = [name] + [f"{value:.1f}" for value in rates]
            if peer:
                row.append(f"{rates[0] / peer:.1f}")
            rows.append(row)
            print(*row, sep="  ", flush=True)
    lines = [f"{processor()}; SIMD of {bits} bits; version {version}"
             + (f"; LULESH 2 on one core {peer:.1f} MDOF-steps/s" if peer else "") + ".", ""]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    text = PAGE.read_text()
    begin, end = "<!-- measured -->\n", "<!-- end -->"
    before, rest = text.split(begin)
    PAGE.write_text(before + begin + "\n".join(lines) + "\n" + end + rest.split(end)[1])


if __name__ == "__main__":
    main()
