#!/usr/bin/env python3
"""Runs hours of motion with many earthquakes in pieces, each of which is stopped
at a random moment and continued with --restart on another number of ranks:
neither memory nor files may grow by more than the histories, and in the end the
histories are those of a run in one piece on one rank, bit for bit.

usage: soak.py PROGRAM [--case CASE.prm] [--hours H] [--ranks 1,2,3] [--piece SECONDS]
               [--seed N] [--folder SCRATCH]

Exit code 1 if something grows, a run does not continue, or the histories differ.
"""

import argparse
import math
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

STOPPED = 75
# files of the run in one piece that must be equal bit for bit, on any number of ranks
SAME = ["histories.csv"]
# from the first line of a piece's histories to its end; measured: 0.1 MB
GROWTH = 0.5  # MB
# From piece to piece, where the set-up leaves the heap in another state each time: 19
# pieces of the same run have 24.4 to 26.4 MB. What a piece keeps cannot pass to the next
# one but by the checkpoint, whose size is compared, too.
SCATTER = 3.0  # MB


def command(options, ranks, end, restart):
    program = [str(options.program.parent / "voussoir-run"), "-n", str(ranks), str(options.case),
               "--set", "Output/Folder=run", "--set", f"Time/End time={end!r}"]
    return program + (["--restart"] if restart else [])


def descendants(pid):
    yield pid
    for task in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
        for child in task.read_text().split():
            yield from descendants(int(child))


def memory_of_largest(pid):
    """Memory of the largest process under pid [MB] without the pages of libraries, of
    which the kernel maps more or fewer in each run."""
    largest = 0.0
    try:
        for process in descendants(pid):
            status = pathlib.Path(f"/proc/{process}/status").read_text()
            largest = max(largest, *(float(line.split()[1]) / 1024.0
                                     for line in status.splitlines()
                                     if line.startswith("RssAnon:")), 0.0)
    except OSError:  # a process has ended meanwhile
        pass
    return largest


def run(options, folder, ranks, end, restart, seconds=float("inf")):
    """Exit code of a run, largest memory of one of its processes, and what it grew by since
    the first line of its histories [MB]; stops the run after a number of seconds. A run
    that was stopped before this line was still setting up: NaN."""
    histories = folder / "run" / "histories.csv"

    def written():
        return histories.stat().st_mtime_ns if histories.exists() else 0

    before = written()
    with open(folder / "terminal.txt", "ab") as terminal:
        process = subprocess.Popen(command(options, ranks, end, restart), cwd=folder,
                                   stdout=terminal, stderr=subprocess.STDOUT)
    stop, stopped, memory, first = time.monotonic() + seconds, False, 0.0, 0.0
    while process.poll() is None:
        now = memory_of_largest(process.pid)
        if not first and written() != before:
            memory = first = now
        memory = max(memory, now)
        if not stopped and time.monotonic() > stop:
            process.send_signal(signal.SIGTERM)
            stopped = True
        time.sleep(0.05)
    if not first:
        memory = first = math.nan
    return process.returncode, memory, memory - first


def sizes(folder):
    return {str(path.relative_to(folder / "run")): path.stat().st_size
            for path in (folder / "run").rglob("*") if path.is_file()}


def checkpoint_bytes(found):
    return max((size for name, size in found.items() if "step-" in name), default=0)


def is_history(name):
    return name.endswith(".csv") or name == "log.txt"


def reached(folder):
    """Simulated time of the last line of the histories [s]."""
    lines = (folder / "run" / "histories.csv").read_text().splitlines()
    return float(lines[-1].split(",")[0]) if len(lines) > 1 else 0.0


def main():
    here = pathlib.Path(__file__).resolve().parent
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--case", type=pathlib.Path, default=here / "soak.prm")
    parser.add_argument("--hours", type=float, default=24.0)
    parser.add_argument("--ranks", default="1,2,3")
    parser.add_argument("--piece", type=float, default=20.0, help="seconds of wall time")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("soak"))
    options = parser.parse_args()
    options.program = options.program.resolve()
    options.case = options.case.resolve()
    ranks_to_try = [int(n) for n in options.ranks.split(",")]
    chance = random.Random(options.seed)
    end = 3600.0 * options.hours
    failures = []

    pieces = options.folder / "pieces"
    shutil.rmtree(options.folder, ignore_errors=True)
    pieces.mkdir(parents=True)
    first_memory, first_checkpoint, restart, ranks_of_pieces = {}, 0, False, []
    while True:
        others = [n for n in ranks_to_try if n not in ranks_of_pieces[-1:]]
        ranks = chance.choice(others or ranks_to_try)
        continued = restart
        code, memory, growth = run(options, pieces, ranks, end, restart,
                                   options.piece * chance.uniform(0.3, 1.7))
        if code not in (0, STOPPED):
            sys.exit(f"piece {len(ranks_of_pieces) + 1} on {ranks} ranks ends with {code}; "
                     f"see {pieces}")
        ranks_of_pieces.append(ranks)
        n_pieces = len(ranks_of_pieces)
        restart = (pieces / "run" / "checkpoint").exists()
        if not restart:
            continue
        found = sizes(pieces)
        checkpoint = checkpoint_bytes(found)
        print(f"piece {n_pieces}, {ranks} ranks: until {reached(pieces) / 3600:.3f} h, "
              f"{memory:.1f} MB, {growth:.1f} MB of growth, checkpoint {checkpoint} bytes, "
              f"{sum(size for name, size in found.items() if is_history(name))} of tables",
              flush=True)
        if growth > GROWTH:
            failures.append(f"memory on {ranks} ranks grew by {growth:.1f} MB in piece {n_pieces}")
        if (continued and not math.isnan(memory)
                and memory > first_memory.setdefault(ranks, memory) + SCATTER):
            failures.append(f"memory on {ranks} ranks grew from {first_memory[ranks]:.1f} "
                            f"to {memory:.1f} MB in piece {n_pieces}")
        first_checkpoint = first_checkpoint or checkpoint
        # damage may spread, and numbers in the header vary in their digits
        if checkpoint > 1.5 * first_checkpoint + 10000:
            failures.append(f"the checkpoint grew from {first_checkpoint} to {checkpoint} bytes")
        steps = [name for name in found if "step-" in name]
        if len(steps) > 2:
            failures.append(f"{len(steps)} checkpoints stay: " + ", ".join(steps))
        if code == 0:
            break
    if len(set(ranks_of_pieces)) < 2 and len(ranks_to_try) > 1:
        failures.append("all pieces had the same number of ranks: take a smaller --piece")

    straight = options.folder / "straight"
    straight.mkdir()
    # the static state depends on the ranks that found it, and is kept
    shutil.copytree(pieces / "static_states", straight / "static_states")
    code, memory, growth = run(options, straight, 1, end, False)
    if code != 0:
        sys.exit(f"the run in one piece fails; see {straight}")
    print(f"one piece, 1 rank: {memory:.1f} MB, {growth:.1f} MB of growth")
    if not growth <= GROWTH or not memory <= max(first_memory.values(), default=0.0) + SCATTER:
        failures.append(f"memory of the run in one piece is {memory:.1f} MB")
    for name in SAME:
        if (pieces / "run" / name).read_bytes() != (straight / "run" / name).read_bytes():
            failures.append(f"{name} is not that of the run in one piece")
    ours, theirs = sizes(pieces), sizes(straight)
    for name in sorted(ours.keys() | theirs.keys()):
        if name not in ours or name not in theirs:
            if "checkpoint" not in name:
                failures.append(f"{name} is in one of the folders only")
        elif name.endswith(".csv") and (
                len((pieces / "run" / name).read_bytes().splitlines())
                != len((straight / "run" / name).read_bytes().splitlines())):
            failures.append(f"{name} has other lines than that of the run in one piece")
    for failure in failures:
        print(failure)
    print(f"{options.hours} h in {n_pieces} pieces on {options.ranks} ranks, "
          f"{len(failures)} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
