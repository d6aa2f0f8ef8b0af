#!/usr/bin/python3
"""Signals to the launcher and to its processes on two ranks: the exit code that mpirun
passes on and the delay, and that the run continues from where it was stopped to the
files of an uninterrupted run.

usage: check_signals.py LAUNCHER CASE.prm
"""

import os
import pathlib
import pty
import re
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "kills"))
from kill_and_resume import contents  # noqa: E402

launcher, case = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
STOPPED = 75
failed = []


def is_true(what, good):
    print(f"{what}  {'ok' if good else 'FAILED'}", flush=True)
    if not good:
        failed.append(what)


def wait_for(condition, seconds=60.):
    limit = time.monotonic() + seconds
    while not condition() and time.monotonic() < limit:
        time.sleep(0.02)
    return condition()


def ranks(folder):
    """Processes of the program in a folder, in the order of their ids."""
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if (os.readlink(process / "exe") == str(launcher.parent / "voussoir")
                    and os.readlink(process / "cwd") == str(folder)):
                found.append(int(process.name))
        except OSError:
            pass  # it has ended, or belongs to another user
    return sorted(found)


def parent(process):
    return int(re.search(r"PPid:\s*(\d+)", pathlib.Path(f"/proc/{process}/status").read_text())[1])


def start(folder, *arguments, end=1000., **options):
    folder.mkdir(exist_ok=True)
    with open(folder / "terminal.txt", "a") as terminal:
        return subprocess.Popen(
            [str(launcher), "-n", "2", str(case), "--set", f"Time/End time={end:.9g}", "Output/Folder=run", *arguments],
            **{"cwd": folder, "stdout": terminal, "stderr": terminal, "start_new_session": True, **options})


def started(folder, **options):
    """A run that is in its time loop."""
    run = start(folder, **options)
    wait_for(lambda: list(folder.glob("run/checkpoint/step-*")))
    time.sleep(0.3)
    return run


def ends(run, seconds=60.):
    """The exit code of a run; None if it does not end and has to be killed."""
    try:
        return run.wait(seconds)
    except subprocess.TimeoutExpired:
        run.kill()
        run.wait()
        return None


def last_time(folder):
    return float(re.findall(r"Stopped on request at t = (\S+) s; ", (folder / "terminal.txt").read_text())[-1])


def check_stops(scratch):
    stopped = {}
    for kind in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR2, "SIGTERM to one rank"):
        folder = scratch / getattr(kind, "name", "rank")
        run = started(folder)
        if isinstance(kind, signal.Signals):
            run.send_signal(kind)
        else:
            os.kill(ranks(folder)[-1], signal.SIGTERM)
        begin = time.monotonic()
        code = ends(run)
        seconds = time.monotonic() - begin
        name = getattr(kind, "name", kind)
        is_true(f"{name}: exit code {code}", code == STOPPED)
        is_true(f"  after {seconds:.1f} s", seconds < 60.)
        if code == STOPPED:
            stopped[name] = folder
    ending = max(last_time(folder) for folder in stopped.values()) + 0.1
    straight = scratch / "straight"
    is_true("a run that nobody disturbs ends with 0", ends(start(straight, end=ending), 300.) == 0)
    expected = contents(straight)
    for name, folder in stopped.items():
        is_true(f"{name}: it continues", ends(start(folder, "--restart", end=ending), 300.) == 0)
        is_true("  to the same files", contents(folder) == expected)


def check_early(scratch):
    for i, delay in enumerate((0.05, 0.3, 0.6, 1.)):
        run = start(scratch / f"early{i}")
        time.sleep(delay)
        run.terminate()
        code = ends(run)
        is_true(f"SIGTERM {delay} s after the start: exit code {code}", code == STOPPED)


def check_errors(scratch):
    folder = scratch / "typo"
    seconds = []
    for _ in range(3):
        begin = time.monotonic()
        code = ends(start(folder, "Time/Edn time=3"))
        seconds.append(time.monotonic() - begin)
    is_true(f"a wrong entry: exit code {code}", code == 1)
    # two without load, one of them to start
    is_true(f"  after {min(seconds):.1f} s", min(seconds) < 10.)
    is_true("  reported once each time", (folder / "terminal.txt").read_text().count('Error: --set "Time/Edn time') == 3)


def check_kills(scratch):
    folder = scratch / "no_mpirun"
    run = started(folder)
    processes = ranks(folder)
    is_true("two ranks", len(processes) == 2)
    os.kill(parent(processes[0]), signal.SIGKILL)
    # Open MPI itself grants them a second
    is_true("ranks do not outlive mpirun", wait_for(lambda: not ranks(folder), 0.7))
    code = ends(run)
    is_true(f"  exit code {code}", code == 128 + signal.SIGKILL)

    folder = scratch / "no_rank"
    run = started(folder)
    os.kill(ranks(folder)[0], signal.SIGKILL)
    code = ends(run, 10.)
    is_true(f"SIGKILL to one rank: exit code {code}", code == 128 + signal.SIGKILL)

    folder = scratch / "no_launcher"
    run = started(folder)
    run.kill()
    run.wait()
    is_true("ranks do not outlive the launcher", wait_for(lambda: not ranks(folder), 5.))


def check_session_folders(scratch):
    """A killed mpirun of Open MPI 5 leaves a folder of its process number, and process
    numbers recur."""
    temporary = scratch / "temporary"
    temporary.mkdir()
    last = os.getpid()
    for process in range(last, last + 3000):  # numbers go up
        (temporary / f"prterun.{socket.gethostname()}.{process}.{os.getuid()}" / "0").mkdir(parents=True)
    left = set(temporary.iterdir())
    run = started(scratch / "same_number", env={**os.environ, "TMPDIR": str(temporary)})
    processes = ranks(scratch / "same_number")
    is_true("it starts where folders of its number are", len(processes) == 2)
    if processes:
        os.kill(parent(processes[0]), signal.SIGKILL)
    ends(run)
    is_true("  and leaves none", set(temporary.iterdir()) == left)


def check_second(scratch):
    folder = scratch / "second"
    run = started(folder)
    waiting = ranks(folder)[-1]
    os.kill(waiting, signal.SIGSTOP)  # writes no checkpoint
    run.send_signal(signal.SIGINT)
    time.sleep(2.5)
    is_true("SIGINT waits for the checkpoint", run.poll() is None)
    run.send_signal(signal.SIGINT)
    code = ends(run, 10.)
    is_true(f"  a second one ends the run, exit code {code}", code == 1)
    is_true("  and its ranks", wait_for(lambda: not ranks(folder), 2.))


def check_terminal(scratch):
    """Ctrl-C goes to all processes in the foreground of a terminal."""
    try:
        master, terminal = pty.openpty()
    except OSError:
        print("no terminal can be made here: Ctrl-C is not tried", flush=True)
        return
    folder = scratch / "terminal"
    run = start(folder, stdin=terminal, stdout=terminal, stderr=terminal,
                env={**os.environ, "TERM": "xterm"}, preexec_fn=lambda: os.login_tty(terminal))
    os.close(terminal)
    shown = b""

    def comes(pattern):
        nonlocal shown
        limit = time.monotonic() + 200.
        while not re.search(pattern, shown) and time.monotonic() < limit:
            if select.select([master], [], [], 1.)[0]:
                try:
                    shown += os.read(master, 4096)
                except OSError:  # no process has the terminal open
                    break
        return re.search(pattern, shown)

    is_true("a terminal shows how far the run is", comes(rb" +[0-9.]+ %  t = "))
    os.write(master, b"\x03")
    is_true("  Ctrl-C stops the run", comes(rb"Stopped on request at"))
    code = ends(run)
    is_true(f"  exit code {code}", code == STOPPED)
    os.close(master)


with tempfile.TemporaryDirectory() as name:
    for check in (check_stops, check_early, check_errors, check_kills, check_session_folders, check_second, check_terminal):
        check(pathlib.Path(name))
print(f"{len(failed)} failed" if failed else "all ok")
sys.exit(1 if failed else 0)
