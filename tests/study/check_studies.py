#!/usr/bin/env python3
"""The end of studies, and the runs that they accept as done: exit codes and last lines
of the program, damaged notes, moved folders, two studies at once.

usage: check_studies.py PROGRAM FOLDER_OF_THE_TEST_CASES
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

program, cases = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
failed = []


def is_true(what, good, said=""):
    print(f"{what}  {'ok' if good else 'FAILED: ' + said}")
    if not good:
        failed.append(what)


def started(case, folder, *entries, options=()):
    return subprocess.Popen([program, case, *options, "--set", f"Output/Folder={folder}", *entries],
                            cwd=folder.parent, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def study(*arguments, **named):
    """Exit code and messages."""
    process = started(*arguments, **named)
    said = process.communicate(timeout=300)[0].strip()
    return process.returncode, said


def ends_with(said, line):
    return said.splitlines()[-1].removeprefix("Error: ").startswith(line)


def check_ends(scratch):
    slope, folder = cases / "study_slope.prm", scratch / "ends"
    friction = "Study/Vary=Interfaces/plane/Friction coefficient = "
    code, said = study(slope, folder, "Study/Limit/Entry=", friction + "0.5, 0.1, 0.8")
    is_true("one of three slides away: exit code 2", code == 2, said)
    is_true("  its last line counts",
            ends_with(said, f'Of 3 runs in "{folder}" 2 are complete, 1 was stopped, 0 failed; '), said)
    code, said = study(slope, folder, "Study/Limit/Entry=", friction + "0.5, 0.1, 0.8")
    is_true("the same again: exit code 2, nothing is done twice",
            code == 2 and said.count(": taken, ") == 3, said)
    code, said = study(slope, folder, "Study/Limit/Entry=", friction + "0.5, 0.8")
    is_true("those that are complete: exit code 0", code == 0, said)
    is_true("  its last line counts",
            ends_with(said, f'Of 2 runs in "{folder}" 2 are complete, 0 were stopped, 0 failed'), said)
    code, said = study(slope, scratch / "mistake", "Study/Limit/Entry=",
                       friction + "0.5, 0.8 & Loads/weight/Cell sets = block, nowhere")
    is_true("one has a mistake in its file: exit code 2", code == 2 and "1 is complete, 0 were stopped, 1 failed"
            in said.splitlines()[-1], said)
    code, said = study(slope, scratch / "all", "Study/Limit/Entry=", friction + "0.1, 0.05")
    is_true("none is complete: exit code 1", code == 1 and "0 are complete, 2 were stopped" in said.splitlines()[-1], said)
    is_true("  sentences end with one full stop", ".." not in said.replace(str(scratch), ""), said)
    code, said = study(slope, scratch / "limit", "Study/Limit/Accuracy=0.5")
    is_true("a limit at which runs are stopped is what was asked for: exit code 0",
            code == 0 and " stopped, 0 failed" in said.splitlines()[-1]
            and " 0 were stopped" not in said.splitlines()[-1], said)


def check_misspelt_number(scratch):
    name = "histories/nowhere/largest displacement [m]"
    code, said = study(cases / "study_columns.prm", scratch / "misspelt", "Study/Fragility/Intensity=Materials/stone/Density",
                       f"Study/Fragility/Criterion={name} > 1")
    is_true("a fragility curve of a number that there is not: stopped after the first run",
            code == 1 and name in said and said.count(", about ") == 1, said)


def check_validation(scratch):
    code, said = study(cases / "study_slope.prm", scratch / "valid", "Ground motion/Spectrum/Periods=0.1, 1",
                       options=("--validate",))
    is_true("--validate has the notes of all runs, each once", code == 0 and said.count("note: ") == 1
            and 'note: "Periods" in section "Ground motion/Spectrum" is not used' in said, said)


def check_notes(scratch):
    columns, folder = cases / "study_columns.prm", scratch / "columns"
    code, said = study(columns, folder)
    is_true("four runs", code == 0 and "4 are complete" in said, said)
    note = folder / "Young-s-modulus-1e9_Density-2000.json"
    whole = note.read_text()
    for text in ("{}", "[]", "null", "?", '{"identity": 1, "summary": 3}', whole[:-100]):
        note.write_text(text)
        code, said = study(columns, folder)
        is_true(f"notes of a run that are {text[:20].split(chr(10))[0]}: one sentence that names them", code == 1 and
                note.name in said.splitlines()[-1] and "report it" not in said, said)
    note.write_text("")
    code, said = study(columns, folder)
    is_true("empty notes: this run is done again", code == 0 and said.count(": taken") == 3, said)

    moved = scratch / "elsewhere"
    folder.rename(moved)
    code, said = study(columns, moved, "Title=Moved", "Study/Quantities=cells")
    is_true("a study that was moved is taken as it is", code == 0 and said.count(": taken") == 4, said)
    code, said = study(columns, moved, "Materials/stone/Poisson's ratio=0.1")
    last = said.splitlines()[-1]
    is_true("another entry is named with both values", code == 1 and all(
        words in last for words in ("Materials/stone/Poisson's ratio = 0\"", "Poisson's ratio = 0.1\"")), said)
    code, said = study(columns, moved, "Materials/stone/Poisson's ratio=0.1", options=["--overwrite"])
    is_true("  --overwrite does it anew", code == 0 and ": taken" not in said, said)
    earlier = json.loads(whole)
    earlier["identity"] = "0123456789abcdef"
    (moved / note.name).write_text(json.dumps(earlier))
    code, said = study(columns, moved)
    is_true("notes of an earlier version are refused as such", code == 1 and "earlier version" in said, said)


def check_files(scratch):
    """A record in another folder, and a record with other numbers."""
    wall, folder = cases.parent / "report" / "wall.prm", scratch / "shaken"
    for name in ("here", "there"):
        (scratch / name).mkdir()
        (scratch / name / "motion.txt").write_text("".join(f"{i % 7 - 3}\n" for i in range(200)))
    entries = ["Ground motion/Type=record", "Time/End time=0.2", "Ground motion/Record/Time step=0.01",
               "Study/Vary=Ground motion/Overload factor = 1, 2"]

    def with_file(name):
        return [*entries, f"Ground motion/Record/File y={scratch / name / 'motion.txt'}"]
    code, said = study(wall, folder, *with_file("here"))
    is_true("a study with a record", code == 0, said)
    code, said = study(wall, folder, *with_file("there"))
    is_true("the same record elsewhere is the same", code == 0 and said.count(": taken") == 2, said)
    (scratch / "there" / "motion.txt").write_text("".join(f"{i % 5 - 2}\n" for i in range(200)))
    code, said = study(wall, folder, *with_file("there"))
    is_true("another record is not, and its entry is named",
            code == 1 and "Ground motion/Record/File y = " in said.splitlines()[-1], said)


def check_two_at_once(scratch):
    wall, folder = cases.parent / "report" / "wall.prm", scratch / "twice"
    entries = ["Study/Vary=Ground motion/Overload factor = 1, 2", "Time/End time=600"]
    first = started(wall, folder, *entries)
    end = time.monotonic() + 60.
    while not (folder / ".lock").exists() and first.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
    code, said = study(wall, folder, *entries)
    still = first.poll() is None
    first.terminate()
    first.communicate(timeout=300)
    is_true("a second study in the folder of a running one: refused", still and code == 1
            and f'"{folder}" is that of a study which is still going on' in said, said)
    is_true("  and the first one is asked to stop: exit code 75", first.returncode == 75,
            str(first.returncode))


with tempfile.TemporaryDirectory() as name:
    for check in (check_ends, check_misspelt_number, check_validation, check_notes, check_files, check_two_at_once):
        place = pathlib.Path(name).resolve() / check.__name__
        place.mkdir()
        check(place)
        shutil.rmtree(place)
print(f"{len(failed)} failed" if failed else "all ok")
sys.exit(1 if failed else 0)
