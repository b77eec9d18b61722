"""Schedulers for a test: `sbatch`, `qsub`, `bsub`, ... on PATH, which note how they were called and run the tasks at once,
one after the other, as the real ones would (variables, arguments, output)."""

import json
import os
import pathlib
import stat
import sys

PROGRAM = r'''#!{python}
import json, os, pathlib, re, subprocess, sys
name, words, folder = pathlib.Path(sys.argv[0]).name, sys.argv[1:], pathlib.Path({folder!r})
with open(folder / "calls.jsonl", "a") as calls:
    calls.write(json.dumps([name, *words]) + "\n")
if name in ("qstat", "bjobs", "squeue", "qdel", "bkill", "scancel"):
    held = folder / "in_queue"  # a test makes it: every job is still there
    if name == "bjobs" and held.exists():
        print("PEND")
    sys.exit(0 if held.exists() or name in ("squeue", "qdel", "bkill", "scancel") else 1)
if name == "scontrol":
    print("MaxJobCount             = 10000\nMaxArraySize            = 1001\n")
    sys.exit(0)
number = len((folder / "calls.jsonl").read_text().splitlines())
value = lambda option: words[words.index(option) + 1] if option in words else ""
script = next(k for k, word in enumerate(words) if word.endswith((".sh", ".sbatch")))
environment, indices = dict(os.environ), ""
variables = {{"sbatch": "SLURM_ARRAY_TASK_ID", "bsub": "LSB_JOBINDEX", "qsub": "PBS_ARRAY_INDEX" if {is_pbs} else "SGE_TASK_ID"}}
if name == "sbatch":
    indices = next((word[8:] for word in words if word.startswith("--array=")), "")
elif name == "bsub":
    indices = "".join(re.findall(r"\[(.*)\]", value("-J")))
else:
    indices = value("-J") or value("-t")
    environment.update(pair.split("=") for pair in value("-v").split(",") if pair)
tasks = []
for part in filter(None, indices.split("%")[0].split(",")):
    first, _, last = part.partition("-")
    tasks += range(int(first), int(last or first) + 1)
if {runs}:
    for task in tasks or [None]:
        if task is not None:
            environment[variables[name]] = str(task)
        subprocess.run(["sh", *words[script:]], env=environment, check=False, cwd=value("-cwd") or None,
                       stdout=open(folder / "output.txt", "a"), stderr=subprocess.STDOUT)
print({{"sbatch": f"{{number}}", "bsub": f"Job <{{number}}> is submitted to queue <normal>.",
       "qsub": f"{{number}}[].server" if {is_pbs} else f"{{number}}.1-3:1"}}[name])
'''


def install(folder, *, is_pbs=False, runs=True):
    """The environment with the programs in it, and a function that gives the calls so far."""
    folder = pathlib.Path(folder)
    folder.mkdir()
    for name in ("sbatch", "squeue", "scancel", "scontrol", "qsub", "qstat", "qdel", "bsub", "bjobs", "bkill"):
        path = folder / name
        path.write_text(PROGRAM.format(python=sys.executable, folder=str(folder), is_pbs=is_pbs, runs=runs))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
    calls = folder / "calls.jsonl"
    return ({**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"},
            lambda: [json.loads(line) for line in calls.read_text().splitlines()] if calls.exists() else [])
