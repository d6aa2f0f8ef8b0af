#!/usr/bin/env python3
"""Random damage to runs of the program: damaged checkpoints, full disks, and invalid
values of entries. Each run ends in time, with the files of an undisturbed run, or with
one sentence and exit code 1; it never ends by a signal, hangs, or has other results and
exit code 0.

usage: abuse.py {checkpoints,disks,nonsense} PROGRAM [--case CASE.prm] [--ranks N]
                [--number N] [--seed N] [--first N] [--folder SCRATCH]

Number N of a seed does not depend on the numbers before it. Full disks are small disks
of tmpfs, which need root; else the exit code is 77. Damaged results are given to the
report by tests/report/damage_results.py.
"""

import argparse
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from kill_and_resume import contents, left_behind

PATIENCE = 300  # s
CRASHES = ("Segmentation", "terminate called", "Assertion", "SIGABRT", "SIGFPE", "bad_alloc",
           "HDF5-DIAG", "Backtrace", "what():", "An error occurred in line", "please report")


def start(options, folder, arguments):
    """Exit code, negative if the program does not end, and its output."""
    program = [str(options.program)]
    if options.ranks > 1:
        program = [str(options.program.parent / "voussoir-run"), "-n", str(options.ranks)]
    process = subprocess.Popen(program + [str(options.case)] + options.shorter + arguments,
                               cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               start_new_session=True)
    try:
        text = process.communicate(timeout=PATIENCE)[0]
    except subprocess.TimeoutExpired:
        subprocess.run(["pkill", "-KILL", "-s", str(process.pid)], check=False)
        process.communicate()
        return -1, "no end"
    return process.returncode, text.decode(errors="replace")


def complaint(code, text):
    """The fault in the end of the program; empty if there is none."""
    if code not in (0, 1):
        return f"exit code {code}"
    for crash in CRASHES:
        if crash in text:
            return f"says \"{crash}\""
    if code == 1 and "Error" not in text and "error" not in text:
        return "exit code 1 without an error"
    return ""


def damage(path, chance):
    """Damages a file; returns a description of the damage."""
    size = path.stat().st_size
    kind = chance.choice(["byte", "bytes", "cut", "zeros", "removed", "empty", "folder", "pipe",
                          "text", "longer", "twice"])
    if kind in ("byte", "bytes", "zeros"):
        with open(path, "r+b") as file:
            n = {"byte": 1, "bytes": 64, "zeros": 4096}[kind]
            file.seek(chance.randrange(max(1, size - n)))
            file.write(bytes(n) if kind == "zeros" else chance.randbytes(n))
    elif kind == "cut":
        os.truncate(path, chance.randrange(size))
    elif kind == "longer":
        with open(path, "ab") as file:
            file.write(chance.randbytes(chance.randrange(1, 5000)))
    elif kind == "twice":
        path.write_bytes(path.read_bytes() * 2)
    else:
        path.unlink()
        if kind == "empty":
            path.touch()
        elif kind == "folder":
            path.mkdir()
        elif kind == "pipe":
            os.mkfifo(path)
        elif kind == "text":
            path.write_text("What is this?\n")
    return f"{kind} of {path.name}"


def different(reference, folder):
    found = contents(folder)
    return left_behind(folder) + sorted(name for name in reference.keys() | found.keys()
                                        if reference.get(name) != found.get(name))


def damaged_checkpoints(options, straight, reference, chance, folder):
    """One or two files of a checkpoint, and a restart."""
    stopped = options.folder / "stopped"
    if not stopped.exists():
        stopped.mkdir()
        code, text = start(options, stopped, ["--set", f"Time/End time={0.6 * options.end}"])
        if code != 0:
            sys.exit(text)
    shutil.copytree(stopped, folder)
    files = sorted((folder / "run" / "checkpoint").glob("*.h5"))
    what = [damage(path, chance)
            for path in chance.sample(files, chance.choice([1, 1, 1, 2, len(files)]))]
    code, text = start(options, folder, ["--restart"])
    wrong = complaint(code, text)
    if code == 0 and not wrong:
        # it reports the damage that it found, the other run had none
        names = [name for name in different(reference, folder) if name != "summary.json"]
        wrong = "other results: " + ", ".join(names) if names else ""
    return ", ".join(what), wrong, code


def full_disk(options, straight, reference, chance, folder):
    """A disk that is too small, and a restart once there is space."""
    folder.mkdir()
    whole = sum(path.stat().st_size for path in straight.rglob("*") if path.is_file())
    size = int(whole * chance.uniform(0.0, 1.1)) // 4096 * 4096 + 4096
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder], check=True)
    try:
        code, text = start(options, folder, [])
        wrong = complaint(code, text)
        if code == 0 and not wrong:
            names = [name for name in different(reference, folder) if name != "summary.json"]
            wrong = "other results: " + ", ".join(names) if names else ""
        if code == 1 and not wrong:
            subprocess.run(["mount", "-o", f"remount,size={4 * whole}", folder], check=True)
            on = (folder / "run" / "checkpoint").exists()
            if not on:
                shutil.rmtree(folder / "run", ignore_errors=True)
            code, text = start(options, folder, ["--restart"] if on else [])
            wrong = complaint(code, text)
            if wrong:
                wrong += " when there is space"
    finally:
        subprocess.run(["umount", "-l", folder], check=False)
    return f"{size} of {whole} bytes", wrong, code


NONSENSE = ["", "-1", "0", "1e308", "-1e308", "nan", "inf", "-inf", "1e-308", "3.5", "1e9", "38",
            "abc", "1, 2", "1; 2", "true", "9" * 400, "x" * 5000, "../../..", "/dev/zero",
            "/dev/null", "0x10", "1,5", "\u00e9\u4e2d", "*", "|", "$(id)", "`id`", "%s%n", "\\",
            "{}", "[]", "sin(", "t/0", "1e5 m", "-0", "+1", "1.", ".5", "--help", "a: b", "\t"]


def entries_of(options):
    text = subprocess.run([str(options.program), str(options.case), "--defaults", "json"],
                          capture_output=True, text=True, check=True).stdout
    found = []

    def visit(node, path):
        for name, child in node.items():
            if isinstance(child, dict):
                if isinstance(child.get("value"), str):
                    found.append("/".join(path + [name]))
                else:
                    visit(child, path + [name])

    visit(json.loads(text), [])
    return found


def nonsense(options, straight, reference, chance, folder):
    """One to three entries of the case with invalid values."""
    if not hasattr(options, "entries"):
        options.entries = entries_of(options)
    folder.mkdir()
    changes = [f"{entry}={chance.choice(NONSENSE)}"
               for entry in chance.sample(options.entries, chance.choice([1, 1, 2, 3]))]
    code, text = start(options, folder,
                       ["--validate"] + [word for change in changes for word in ("--set", change)])
    return "; ".join(change[:80] for change in changes), complaint(code, text), code


KINDS = {"checkpoints": damaged_checkpoints, "disks": full_disk, "nonsense": nonsense}


def main():
    here = pathlib.Path(__file__).resolve().parent
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--case", type=pathlib.Path, default=here / "dam.prm")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--number", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--end", type=float, default=0.4, help="end time of the case [s]")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("abuse"))
    options = parser.parse_args()
    if options.kind == "disks" and os.geteuid() != 0:
        print("skipped: only root can mount a small disk")
        sys.exit(77)
    options.program = options.program.resolve()
    options.case = options.case.resolve()
    options.folder = options.folder.resolve()
    options.shorter = ["--set", "Output/Folder=run", "--set", f"Time/End time={options.end}",
                       "--set", f"Output/Checkpoint time={options.end / 10}"]
    shutil.rmtree(options.folder, ignore_errors=True)
    options.folder.mkdir(parents=True)

    straight, reference = options.folder / "straight", {}
    if options.kind != "nonsense":
        straight.mkdir()
        code, text = start(options, straight, [])
        if code != 0:
            sys.exit(text)
        reference = contents(straight)

    failures, codes = 0, {}
    for number in range(options.first, options.first + options.number):
        chance = random.Random(f"{options.seed} {number}")
        folder = options.folder / f"{number}"
        what, wrong, code = KINDS[options.kind](options, straight, reference, chance, folder)
        codes[code] = codes.get(code, 0) + 1
        if wrong:
            failures += 1
            print(f"{number}: {what}: {wrong}", flush=True)
        else:
            shutil.rmtree(folder, ignore_errors=True)
    print(f"{options.number} {options.kind}, seed {options.seed}, {options.ranks} rank(s): "
          + ", ".join(f"{n} ended with {code}" for code, n in sorted(codes.items()))
          + f", {failures} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
