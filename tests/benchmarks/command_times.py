#!/usr/bin/env python3
"""How long commands take beside what `--help` says of them. Run by hand:

    tests/benchmarks/command_times.py [build/capstan] [COMMAND...]

Each runs once in an empty folder on a shipped configuration or recording. Prints wall and processor time in seconds, the load
of the machine, and the words under "Time:" of the command's help."""

import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
CONFIGS = ROOT / "configs"
LOG = CONFIGS / "recordings" / "viscous-pair.csv"
QUIET = ("--progress", "none")

# In this order: a later one needs what an earlier one left.
RUNS = [
    ("study run", ["study", "run", CONFIGS / "quick.toml", *QUIET]),
    ("study run", ["study", "run", CONFIGS / "paper.toml", *QUIET]),
    ("study replay", ["study", "replay", "1"]),
    ("study extend", ["study", "extend", "1", "--repetitions", "4000", *QUIET]),
    ("study plan", ["study", "plan", CONFIGS / "atlas.toml", *QUIET]),
    ("study list", ["study", "list"]),
    ("study show", ["study", "show", "1"]),
    ("study verify", ["study", "verify", "1", *QUIET]),
    ("recommend", ["recommend"]),
    ("place", ["place", CONFIGS / "paper.toml", "--repetitions", "1000", *QUIET]),
    ("place", ["place", CONFIGS / "wrist-exosuit.toml", *QUIET]),
    ("bands", ["bands", CONFIGS / "wrist-exosuit.toml", *QUIET]),
    ("budget", ["budget", CONFIGS / "quick.toml", CONFIGS / "quick.toml", *QUIET]),
    ("sensitivity", ["sensitivity", CONFIGS / "paper.toml", *QUIET]),
    ("duty", ["duty", LOG, *QUIET]),
    ("estimate", ["estimate", LOG, "-o", "t.csv", *QUIET]),
    ("estimate", ["estimate", CONFIGS / "quick.toml", *QUIET]),
    ("calibrate", ["calibrate", LOG, *QUIET]),
    ("diagnose", ["diagnose", LOG, *QUIET]),
    ("report", ["report", "-o", "r.html"]),
    ("export", ["export", "tables"]),
    ("query", ["query", "SELECT * FROM v_best_method"]),
    ("simulate", ["simulate", CONFIGS / "bench-grip.toml", "-o", "b.csv"]),
    ("import", ["import", "--suggest", "b.csv"]),
    ("gap-trial", ["gap-trial", "--cases", "1", "--keep", "trial", "--generate-only"]),
    ("paper exp1", ["paper", "exp1"]),
    ("paper exp2", ["paper", "exp2"]),
    ("paper solver", ["paper", "solver", "--seconds", "0.1", *QUIET]),
    ("paper estimation", ["paper", "estimation", *QUIET]),
    ("config check", ["config", "check", CONFIGS / "paper.toml"]),
    ("config default", ["config", "default"]),
    ("doctor", ["doctor", *QUIET]),
]


def stated(program, name):
    text = subprocess.run([program, *name.split(), "--help"], capture_output=True, text=True, check=True).stdout
    return " ".join(text.split("\nTime:\n")[1].split("\n\n")[0].split())


def main():
    program = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "capstan")
    chosen = set(sys.argv[2:])
    print(f"{'command':<17} {'wall s':>8} {'processor s':>12} {'load':>5}  arguments; what --help says")
    with tempfile.TemporaryDirectory() as folder:
        for name, words in RUNS:
            if chosen and name not in chosen:
                continue
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            start = time.monotonic()
            ended = subprocess.run([program, *map(str, words)], cwd=folder, capture_output=True, text=True)
            wall_s = time.monotonic() - start
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            used_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            failed = "" if ended.returncode == 0 else f" FAILED ({ended.returncode}): {ended.stderr.strip()[-200:]}"
            arguments = " ".join(str(word).replace(str(CONFIGS), "configs") for word in words[len(name.split()):] if word not in QUIET)
            print(f"{name:<17} {wall_s:8.1f} {used_s:12.1f} {os.getloadavg()[0]:5.1f}  {arguments}; {stated(program, name)}{failed}",
                  flush=True)


if __name__ == "__main__":
    main()
