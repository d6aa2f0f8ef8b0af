#!/usr/bin/env python3
"""Runs the scaling benchmark on this machine, lets the program count partitions into
more ranks, and predicts their speed from the measured rate and stated figures of a
network. Prints a table and writes a figure and numbers to a folder.

usage: scaling.py PROGRAM [--ranks 1,2] [--levels 1] [--counts 16,191,1024] [...]

The prediction: a step takes as long as its slowest rank, which computes its cells at
the rate of a core. Displacements arrive, as they are and filtered for damping, while the
first half of the cells without exchanged nodes is computed; forces leave during the
second half. An exchange takes a latency, an overhead of the processor for each neighbour
and vector, and the bytes over the bandwidth. Cores share nothing else. The rate of a core
is the lowest of the runs on no more ranks than there are cores, or the given one if other
work disturbs the runs.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

CASE = pathlib.Path(__file__).resolve().parent.parent / "prm/benchmarks/scaling.prm"
# Guo, Li, Tu, Chen: PSDAP, 1.3 million unknowns, hours of its Table 1
PAPER = {1: 949.4, 2: 499.7, 191: 18.9}
BYTES = 24  # of a node


def run(options, ranks, level, counts=()):
    """Summary of the run."""
    folder = options.folder / f"{ranks}_ranks_level_{level}"
    command = [str(options.program.parent / "voussoir-run"), "-n", str(ranks), str(CASE),
               "--overwrite", "--set", f"Output/Folder={folder}",
               f"Mesh/Global refinement={level}",
               "Mesh/Count partitions=" + ", ".join(map(str, counts)), *options.set]
    process = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if process.returncode != 0:
        sys.exit(process.stdout[-2000:])
    return json.loads((folder / "summary.json").read_text())


def step_seconds(summary):
    return summary["loop time [s]"] / summary["steps"]


def predict(partition, core_rate, unknowns, options):
    """Seconds of a step, and of one without overlap of computation and exchange."""
    mean = unknowns / core_rate / len(partition["neighbours"])
    ranks = list(zip(*(partition[name] for name in (
        "load over the mean", "part of cells without these", "neighbours", "nodes exchanged"))))

    def exchange(neighbours, nodes, vectors):
        return options.latency + vectors * (neighbours * options.overhead +
                                            BYTES * nodes / options.bandwidth)

    overlapped, plain = [], []
    for load, inner, *exchanged in ranks:
        work = load * mean
        half = inner * work / 2.
        arrive, leave = exchange(*exchanged, 2), exchange(*exchanged, 1)
        overlapped.append(work - 2. * half + max(half, arrive) + max(half, leave))
        plain.append(work + arrive + leave)
    return max(overlapped), max(plain)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--ranks", default="1,2", help="numbers of ranks that run here")
    parser.add_argument("--levels", default="1", help="levels of refinement")
    parser.add_argument("--counts", default="16,64,191,1024", help="numbers of ranks to partition for")
    parser.add_argument("--latency", type=float, default=2e-6, help="latency of a message [s]")
    parser.add_argument("--overhead", type=float, default=1e-6,
                        help="time of the processor to send and receive a message [s]")
    parser.add_argument("--bandwidth", type=float, default=1e9, help="bandwidth of a rank [B/s]")
    parser.add_argument("--core-rate", type=float, default=0.,
                        help="rate of a core [million unknowns times steps per second]")
    parser.add_argument("--set", nargs="*", default=[], help="changed entries of the case")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("output/scaling"))
    options = parser.parse_args()
    options.program = options.program.resolve()
    options.folder = options.folder.resolve()
    counts = [int(n) for n in options.counts.split(",")]

    kept = []
    for level in map(int, options.levels.split(",")):
        rates, partitions = [], None
        for ranks in map(int, options.ranks.split(",")):
            summary = run(options, ranks, level, [] if partitions else counts)
            partitions = partitions or summary["counted partitions"]
            unknowns, memory = summary["unknowns"], summary["peak memory of a rank [MB]"]
            rate = summary["MDOF-steps/s"]
            if ranks <= os.cpu_count():
                rates.append(rate / ranks)
            kept.append({"level": level, "ranks": ranks, "unknowns": unknowns,
                         "step [ms]": 1e3 * step_seconds(summary), "MDOF-steps/s": rate,
                         "memory [MB]": memory})
            print(f"{unknowns} unknowns on {ranks} ranks: {rate:.1f} MDOF-steps/s, "
                  f"{memory:.0f} MB a rank", flush=True)
        core_rate = 1e6 * (options.core_rate or min(rates))
        for partition in partitions:
            ranks = len(partition["neighbours"])
            seconds, without_overlap = predict(partition, core_rate, unknowns, options)
            ideal = unknowns / core_rate / ranks
            kept.append({"level": level, "ranks": ranks, "predicted step [ms]": 1e3 * seconds,
                         "without overlap [ms]": 1e3 * without_overlap,
                         "efficiency": ideal / seconds,
                         "balance": max(partition["load over the mean"]),
                         "most neighbours": max(partition["neighbours"]),
                         "most nodes": max(partition["nodes exchanged"])})
            print(f"  {ranks} ranks: balance {kept[-1]['balance']:.3f}, "
                  f"at most {kept[-1]['most neighbours']} neighbours and "
                  f"{kept[-1]['most nodes']} nodes; predicted step "
                  f"{1e3 * seconds:.3f} ms, efficiency {100 * ideal / seconds:.0f} % "
                  f"({100 * ideal / without_overlap:.0f} % without overlap)")
    options.folder.mkdir(parents=True, exist_ok=True)
    (options.folder / "scaling.json").write_text(json.dumps(kept, indent=1) + "\n")
    plot(kept, options.folder / "scaling.png")


def plot(kept, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot

    figure, axes = pyplot.subplots(figsize=(6., 4.5))
    for level in sorted({one["level"] for one in kept}):
        measured = {one["ranks"]: one["step [ms]"] for one in kept
                    if one["level"] == level and "step [ms]" in one}
        # over one rank at the rate that the prediction takes
        predicted = {one["ranks"]: one["efficiency"] * one["ranks"] for one in kept
                     if one["level"] == level and "efficiency" in one}
        unknowns = next(one["unknowns"] for one in kept if one["level"] == level)
        label = f"{unknowns / 1e6:.1f} million unknowns"
        first = measured[min(measured)] * min(measured)
        axes.loglog(list(measured), [first / ms for ms in measured.values()], "o",
                    label=label + ", measured")
        axes.loglog(list(predicted), list(predicted.values()), "x--",
                    label=label + ", predicted")
    axes.loglog(list(PAPER), [PAPER[1] / hours for hours in PAPER.values()], "s-",
                label="PSDAP, 1.3 million unknowns")
    most = max(one["ranks"] for one in kept)
    axes.loglog([1, most], [1, most], "k:", linewidth=1., label="ideal")
    axes.set_xlabel("ranks")
    axes.set_ylabel("times as fast as one rank")
    axes.legend()
    axes.grid(True, which="both", alpha=0.3)
    figure.savefig(path, dpi=150, bbox_inches="tight")


if __name__ == "__main__":
    main()
