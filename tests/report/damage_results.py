#!/usr/bin/python3
"""Damages result folders at random and makes reports of them: each report ends in time
with a page and exit code 0, or with one sentence and exit code 1, never with a
traceback, and unreadable files are named.

usage: damage_results.py PROGRAM FOLDER_OF_THE_REPORT DAM.prm WALL.prm
                         [--damages N] [--seed N] [--first N]

DAM.prm has joints and concrete that cracks, WALL.prm neither. Damage number N of a seed
does not depend on the numbers before it.
"""

import argparse
import contextlib
import io
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback

sys.dont_write_bytecode = True

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("program", type=pathlib.Path)
parser.add_argument("report", type=pathlib.Path)
parser.add_argument("dam", type=pathlib.Path)
parser.add_argument("wall", type=pathlib.Path)
parser.add_argument("--damages", type=int, default=200)
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--first", type=int, default=0, help="number of the first damage")
parser.add_argument("--patience", type=float, default=120., help="for one report [s]")
options = parser.parse_args()

sys.path.insert(0, str(options.report))
import needed  # noqa: E402, F401
from voussoir_report import __main__ as command, charts, scenes  # noqa: E402
from voussoir_report import (damage, faces, interfaces, motions, over_stress, page, records,  # noqa: E402, F401
                             stages, structure, study, verdict)

# files that reports read: damage to them must be refused
TABLES = ("histories.csv", "energy.csv", "ground_motion.csv", "interfaces.csv", "over_stress.csv")
PICTURES = ("envelopes.vtu", "interface_envelopes.vtu", "over_stress.vtu")
DOCUMENTS = ("summary.json", "study.json")


def emptied(chance, data):
    return b""


def cut(chance, data):
    return data[:chance.randrange(1, len(data) - 1)]


def with_nul_bytes(chance, data):
    place = chance.randrange(len(data))
    return data[:place] + bytes(chance.randrange(1, 5000)) + data[place:]


def of_nul_bytes(chance, data):
    return bytes(len(data))


def replaced_by_text(chance, data):
    return b"The quick brown fox\njumps over the lazy dog.\n" * chance.randrange(1, 20)


def replaced_by_noise(chance, data):
    return chance.randbytes(chance.randrange(1, 5000))


def with_noise(chance, data):
    place, n = chance.randrange(len(data)), chance.randrange(1, 200)
    return data[:place] + chance.randbytes(n) + data[place + n:]


def with_one_bit_turned(chance, data):
    place = chance.randrange(len(data))
    return data[:place] + bytes([data[place] ^ 1 << chance.randrange(8)]) + data[place + 1:]


def with_lines_missing(chance, data):
    lines = data.splitlines(keepends=True)
    first = chance.randrange(len(lines))
    return b"".join(lines[:first] + lines[first + chance.randrange(1, 20):])


def with_a_line_twice(chance, data):
    lines = data.splitlines(keepends=True)
    place = chance.randrange(len(lines))
    return b"".join(lines[:place + 1] + lines[place:])


def without_heading(chance, data):
    return data[data.index(b"\n") + 1:]


def ragged(chance, data):
    lines = data.splitlines(keepends=True)
    place = chance.randrange(1, len(lines))
    cells = lines[place].split(b",")
    lines[place] = b",".join(chance.choice((cells[:-1] + [b"\n"] * (len(cells) < 2), cells[:1] + cells)))
    return b"".join(lines)


def with_words(chance, data):
    lines = data.splitlines(keepends=True)
    place = chance.randrange(1, len(lines))
    cells = lines[place].rstrip(b"\n").split(b",")
    cells[chance.randrange(len(cells))] = chance.choice((b"=1+1", b"1,5", b"none", b"0x10", b"1e"))
    lines[place] = b",".join(cells) + b"\n"
    return b"".join(lines)


def without_its_end(chance, data):
    lines = data.splitlines(keepends=True)
    return b"".join(lines[:chance.randrange(3, max(4, 2 * len(lines) // 3))])


def another_document(chance, data):
    return chance.choice((b"[]", b"null", b"{}", b"3", b'"no objection"', b"[{}]", b"[[[[]]]]", b"NaN",
                          b"[" * 100000, b'{"verdict": null}', b'{"runs": {}}'))


def with_another_value(chance, data):
    """A value of another type, or a missing value, at some place."""
    value = json.loads(data)
    part = value
    while True:
        name = chance.choice(list(part) if isinstance(part, dict) else range(len(part)))
        if isinstance(part[name], (dict, list)) and part[name] and chance.random() < 0.75:
            part = part[name]
            continue
        if chance.random() < 0.2:
            del part[name]
        else:
            part[name] = chance.choice((None, [], {}, "", "text", True, -1, 10**400, [None], {"a": 1}, [[]],
                                        float("nan")))
        return json.dumps(value).encode()


def with_another_number(chance, data):
    """A number of the markup."""
    text = data.decode("latin-1")
    place = text.index('"', text.index(chance.choice(("NumberOfPoints=", "NumberOfCells=",
                                                      'NumberOfComponents=')))) + 1
    return (text[:place] + chance.choice(("0", "1", "-1", "x", "", "9" * 18))
            + text[text.index('"', place):]).encode("latin-1")


def with_another_length(chance, data):
    """The lengths at the beginning of an array, in base 64."""
    text = data.decode("latin-1")
    starts = [i for i in range(len(text)) if text.startswith('format="binary">', i)]
    place = text.index("\n", chance.choice(starts)) + 1 + chance.randrange(16)
    return (text[:place] + chance.choice("ABCDEFGHIJ0123456789+/") + text[place + 1:]).encode("latin-1")


def as_folder(file):
    file.unlink()
    file.mkdir()


def as_pipe(file):
    file.unlink()
    os.mkfifo(file)


def as_link_to_itself(file):
    file.unlink()
    file.symlink_to(file.name)


def as_link_to_zeros(file):
    file.unlink()
    file.symlink_to("/dev/zero")


ANY = (emptied, cut, with_nul_bytes, of_nul_bytes, replaced_by_text, replaced_by_noise, with_noise,
       with_one_bit_turned, with_lines_missing, with_a_line_twice)
PLACES = (as_folder, as_pipe, as_link_to_itself, as_link_to_zeros, pathlib.Path.unlink)
OF_TABLES = (without_heading, ragged, with_words, without_its_end)
OF_PICTURES = (with_another_number, with_another_length)
OF_DOCUMENTS = (another_document, with_another_value)
# after these a file that a report needs cannot be read
UNREADABLE = {
    ".csv": (emptied, with_nul_bytes, of_nul_bytes, replaced_by_text, replaced_by_noise, *OF_TABLES),
    ".vtu": (emptied, cut, with_nul_bytes, of_nul_bytes, replaced_by_text, replaced_by_noise,
             with_another_number),
    ".json": (emptied, cut, with_nul_bytes, of_nul_bytes, replaced_by_text, replaced_by_noise,
              another_document)}


def damage_one(chance, folder):
    """Damages a file; returns its name, the damage, and whether the file must be
    refused, or at least named."""
    files = sorted(path for path in folder.rglob("*") if path.is_file()
                   and not {"checkpoint", "static_states"} & set(path.parts)
                   and path.name not in (".lock", "report.html") and path.stat().st_size > 2)
    # files that reports read are chosen more often
    used = [path for path in files if path.name in TABLES + PICTURES + DOCUMENTS]
    file = chance.choice(used if chance.random() < 0.8 else files)
    kinds = list(ANY)
    kinds += {".csv": 2 * OF_TABLES, ".vtu": 3 * OF_PICTURES, ".json": 4 * OF_DOCUMENTS}.get(file.suffix, ())
    name = str(file.relative_to(folder))
    if chance.random() < 0.08:
        how = chance.choice(PLACES)
        how(file)
        return name, how.__name__, "named" if file in used else None
    how = chance.choice(kinds)
    file.write_bytes(how(chance, file.read_bytes()))
    return name, how.__name__, "refused" if file in used and how in UNREADABLE[file.suffix] else None


def outcome(folder):
    """Exit code, or None after a time-out, and the output of a report of the folder."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.setpgid(0, 0)
        os.close(reading)
        os.dup2(writing, 1)
        os.dup2(writing, 2)
        sys.argv = ["voussoir-report", str(folder)]
        sys.stdout, sys.stderr = os.fdopen(1, "w"), os.fdopen(2, "w")
        code = 3
        try:
            command.main()
            code = 0
        except SystemExit as end:
            code = end.code
            if isinstance(code, str):
                print(code, file=sys.stderr)
                code = 1
        except BaseException:  # as Python itself would end
            traceback.print_exc()
        finally:
            with contextlib.suppress(Exception):
                sys.stdout.flush()
                sys.stderr.flush()
            os._exit(code)
    os.close(writing)
    os.set_blocking(reading, False)
    said, end, status = io.BytesIO(), time.monotonic() + options.patience, None
    while status is None and time.monotonic() < end:
        done, state = os.waitpid(child, os.WNOHANG)
        if done:
            status = state
        with contextlib.suppress(BlockingIOError):
            while part := os.read(reading, 65536):
                said.write(part)
        time.sleep(0.01)
    if status is None:
        os.killpg(child, signal.SIGKILL)
        os.waitpid(child, 0)
    os.close(reading)
    code = None if status is None else os.waitstatus_to_exitcode(status)
    return code, said.getvalue().decode(errors="replace").strip()


def complaint(code, said, name, expected, page):
    """The fault in the end of a report, or nothing."""
    if code is None:
        return "does not end"
    if code not in (0, 1):
        return f"exit code {code}"
    if "Traceback" in said or "please report it" in said:
        return "an error of its own"
    if code == 0 and expected == "refused":
        return "accepted"
    if code == 0 and expected == "named" and pathlib.Path(name).name not in page.read_text():
        return "missing without a word"
    if code == 1 and len(said.splitlines()) != 1:
        return "not one sentence"
    if code == 1 and pathlib.Path(name).name not in said:
        return "what cannot be read is not named"
    return None


def main():
    with tempfile.TemporaryDirectory() as scratch:
        whole = pathlib.Path(scratch) / "whole"
        for folder, case, entries in (
                ("dam", options.dam, ("Time/End time=0.3", "Modes/Number=1",
                                      "Output/fields/Interval=0.15", "Static state/Keep in=")),
                ("wall", options.wall, ("Time/End time=1",)),
                ("study", options.wall, ("Time/End time=0.5",
                                         "Study/Vary=Ground motion/Overload factor = 1, 2"))):
            subprocess.run([options.program, case, "--set", f"Output/Folder={whole / folder}", *entries],
                           check=True, stdout=subprocess.DEVNULL)
        charts.DPI = charts.FULL_DPI = 20  # drawing is not tested here
        scenes.open_display()
        scenes.open_display = lambda: None
        failures, refused = 0, 0
        for folder in sorted(whole.iterdir()):
            code, said = outcome(folder)
            if code != 0:
                failures += 1
                print(f"{folder.name}, whole: exit code {code}, {said}")
        for number in range(options.first, options.first + options.damages):
            chance = random.Random(f"{options.seed} {number}")
            damaged = pathlib.Path(scratch) / "damaged"
            shutil.copytree(whole / chance.choice(("dam", "dam", "wall", "study")), damaged, symlinks=True)
            name, how, expected = damage_one(chance, damaged)
            code, said = outcome(damaged)
            said = said.replace(scratch, "")
            wrong = complaint(code, said, name, expected, damaged / "report.html")
            refused += code == 1
            failures += wrong is not None
            print(f"{number}: {name} {how}: {'FAILED, ' + wrong + '; ' if wrong else ''}{code}, {said}",
                  flush=True)
            shutil.rmtree(damaged)
        print(f"{options.damages} damages, {refused} refused, {failures} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
