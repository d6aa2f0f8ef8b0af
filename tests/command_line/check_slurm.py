#!/usr/bin/python3
"""The job scripts of doc/running.md, with substitutes for Slurm's commands: after the
signal the jobs requeue themselves; started again, the run continues and ends.

usage: check_slurm.py PROGRAM running.md CASE.prm
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

program, page, case = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
whole, part = [script for script in re.findall(r"```bash\n(.*?)```", page.read_text(), re.DOTALL)
               if "#SBATCH" in script]
# the second one replaces the end of the first
variant = whole[:whole.index("srun ")] + part
failed = []


def is_true(what, good):
    print(f"{what}  {'ok' if good else 'FAILED'}")
    if not good:
        failed.append(what)


def stand_in(folder, name, text):
    file = folder / name
    file.write_text("#!/bin/bash\n" + text)
    file.chmod(0o755)


def start(script, folder):
    environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "SLURM_JOB_ID": "7"}
    return subprocess.Popen(["bash", "-c", script], cwd=folder, env=environment, stdout=subprocess.DEVNULL)


def check(name, script, to_the_step):
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        shutil.copy(case, folder / "own_dam.prm")
        stand_in(folder, "voussoir", f'exec {program} "$@" --set "Time/End time=$END"')
        stand_in(folder, "srun", 'shift; echo $$ >step; exec "$@"')
        stand_in(folder, "mpirun", 'exec "$@"')
        stand_in(folder, "scontrol", 'echo "$@" >>requeued')
        result, requeued = folder / "output/own_dam.7", folder / "requeued"

        os.environ["END"] = "1000"
        job = start(script, folder)
        limit = time.time() + 60.
        while not list(result.glob("checkpoint/step-*")) and time.time() < limit:
            time.sleep(0.05)
        os.kill(int((folder / "step").read_text()) if to_the_step else job.pid, signal.SIGUSR2)
        job.wait(60)
        is_true(f"{name}: the job is put into the queue again",
                requeued.exists() and requeued.read_text() == "requeue 7\n")

        stopped = (result / "log.txt").read_text()
        end = float(re.findall(r"Checkpoint written at t = (\S+)", stopped)[-1])
        os.environ["END"] = str(end + 0.01)
        start(script, folder).wait(60)
        log = (result / "log.txt").read_text()
        is_true("  it continues in its folder and ends",
                log.startswith(stopped) and "Done:" in log[len(stopped):])
        is_true("  and is no longer queued", requeued.read_text() == "requeue 7\n")


check("srun", whole, True)
check("mpirun", variant, False)
print(f"{len(failed)} failed" if failed else "all ok")
sys.exit(1 if failed else 0)
