#!/usr/bin/env python3
"""Kills runs at random moments, restarts them with --restart, and compares their files
with those of an uninterrupted run, bit for bit.

usage: kill_and_resume.py PROGRAM [--case CASE.prm] [--ranks N] [--kills N]
                          [--seed N] [--folder SCRATCH]

Signals are SIGKILL (mostly), SIGTERM, SIGHUP and SIGUSR2, at any moment from the
start of the program: in set-up, static state, time loop and while checkpoints
are written. Exit code 1 if a run does not continue or its files differ.
"""

import argparse
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time

# times on the clock, and the date that deal.II writes into pictures
VOLATILE = [re.compile(rb"<!--.*?-->", re.S), re.compile(rb"Date and time[^\n]*")]
NOT_COMPARED = {"log.txt"}
# of summary.json: durations, memory
VOLATILE_NUMBERS = {"seconds", "loop time [s]", "MDOF-steps/s", "contact share of the loop",
                    "time of cells, largest over mean of the ranks",
                    "peak memory of a rank [MB]"}
STOPPED = 75


def command(options, restart):
    program = [str(options.program), str(options.case), "--set", "Output/Folder=run"]
    if options.ranks > 1:
        program = [str(options.program.parent / "voussoir-run"), "-n", str(options.ranks)] + program[1:]
    return program + (["--restart"] if restart else [])


def start(options, folder, restart):
    with open(folder / "terminal.txt", "ab") as terminal:
        return subprocess.Popen(
            command(options, restart), cwd=folder, stdout=terminal,
            stderr=subprocess.STDOUT, start_new_session=True)


def has_checkpoint(folder):
    return any((folder / "run" / "checkpoint").glob("step-*.h5"))


def lasting(value):
    """The part of a summary that must be the same."""
    if not isinstance(value, dict):
        return value
    return {name: lasting(part) for name, part in value.items() if name not in VOLATILE_NUMBERS}


def left_behind(folder):
    """Files that only a restart needs."""
    return [str(path) for path in (folder / "run").rglob("*")
            if path.suffix in (".part", ".unfinished", ".lock")]


def contents(folder):
    files = {}
    for path in sorted((folder / "run").rglob("*")):
        name = str(path.relative_to(folder / "run"))
        if path.is_file() and path.name not in NOT_COMPARED and "checkpoint" not in name:
            data = path.read_bytes()
            if path.name == "summary.json":
                data = json.dumps(lasting(json.loads(data))).encode()
            for pattern in VOLATILE:
                data = pattern.sub(b"", data)
            files[name] = data
    return files


def missing_observers(options):
    """Observers that the case does not have; each must survive a kill."""
    every = subprocess.run([str(options.program), "--list", "observers"],
                           capture_output=True, text=True, check=True).stdout
    used = re.search(r"set Observers\s*=\s*(.*)", options.case.read_text()).group(1)
    return {line.split(":")[0] for line in every.splitlines()} - set(
        name.strip() for name in used.split(","))


def fresh(folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)


def finish(process):
    """Exit code; all remaining processes of the run have ended afterwards: mpirun, in a
    group of its own in the session, lives a moment longer than its launcher."""
    code = process.wait()
    session = ["-s", str(process.pid)]
    while subprocess.run(["pkill", "-KILL"] + session).returncode == 0:
        time.sleep(0.05)
    return code


def main():
    here = pathlib.Path(__file__).resolve().parent
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--case", type=pathlib.Path, default=here / "dam.prm")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("kills"))
    options = parser.parse_args()
    options.program = options.program.resolve()
    options.case = options.case.resolve()
    chance = random.Random(options.seed)
    if left_out := missing_observers(options):
        sys.exit("the case leaves out the observers " + ", ".join(sorted(left_out)))

    straight = options.folder / "straight"
    fresh(straight)
    began = time.monotonic()
    if finish(start(options, straight, False)) != 0:
        sys.exit("the run that nobody disturbs fails; see " + str(straight))
    duration = time.monotonic() - began
    reference = contents(straight)
    print(f"{len(reference)} files, {duration:.1f} s undisturbed", flush=True)

    disturbed = options.folder / "disturbed"
    kills = runs = failures = 0
    while kills < options.kills:
        fresh(disturbed)
        runs += 1
        restart = False
        while True:
            process = start(options, disturbed, restart)
            code = None
            if kills < options.kills:
                wait = chance.uniform(0.0, duration)
                try:
                    code = process.wait(wait)
                except subprocess.TimeoutExpired:
                    kind = chance.choice([signal.SIGKILL] * 5 + [
                        signal.SIGTERM, signal.SIGHUP, signal.SIGUSR2])
                    os.killpg(process.pid, kind)
                    kills += 1
            code = finish(process)
            if code == 0:
                break
            if code not in (STOPPED, 137, -signal.SIGKILL, -signal.SIGTERM,
                            -signal.SIGHUP, -signal.SIGUSR2):
                print(f"after {kills} kills: exit code {code}", flush=True)
                failures += 1
                shutil.copytree(disturbed, options.folder / f"failed-{failures}",
                                dirs_exist_ok=True)
                break
            if code != STOPPED and (disturbed / "run" / "summary.json").exists():
                code = 0  # killed after the end of the work
                break
            restart = has_checkpoint(disturbed)
            if not restart:
                shutil.rmtree(disturbed / "run", ignore_errors=True)
        if code != 0:
            continue
        found = contents(disturbed)
        different = left_behind(disturbed) + sorted(name for name in reference.keys() | found.keys()
                           if reference.get(name) != found.get(name))
        if different:
            failures += 1
            shutil.copytree(disturbed, options.folder / f"failed-{failures}",
                            dirs_exist_ok=True)
            print(f"after {kills} kills: different: {', '.join(different)}", flush=True)
    print(f"{kills} kills, {runs} runs, {failures} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
