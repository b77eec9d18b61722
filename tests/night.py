#!/usr/bin/env python3
"""All long parts of the tests in sequence, and one page of their results for each date:

    tests/run --night            in build-night: 2026-01-31.html, and its logs in the folder 2026-01-31
    tests/run --night --hours 6  what has not ended by then is stopped, and says so on the page

Killed or stopped, the same command goes on with the part that had not ended, as long as the sources are the same; a night
that is complete is followed by a new one."""

import argparse
import datetime
import html
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parents[1]
PARTS = ("release", "supply", "sanitize", "fuzz", "coverage", "thread", "slow")  # the longest last
FUZZ_SECONDS = "300"  # of each target
STYLE = ("body{font:16px/1.5 sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem}td,th{padding:.3rem .8rem;text-align:left;"
         "vertical-align:top}table{border-collapse:collapse}tr{border-bottom:1px solid #ccc}.failed,.stopped{color:#a00}"
         ".passed{color:#060}pre{white-space:pre-wrap;background:#f4f4f4;padding:.5rem}")


def commit():
    """Of the sources, with a mark where they differ from it."""
    def git(*words):
        return subprocess.run(["git", *words], cwd=SOURCE, capture_output=True, text=True).stdout.strip()
    return git("rev-parse", "--short", "HEAD") + ("+changes" if git("status", "--porcelain") else "")


def counts(log):
    """Passed and all tests, of all that ctest said."""
    found = re.findall(r"(\d+) tests? failed out of (\d+)", log)
    failed, all_tests = (sum(int(pair[k]) for pair in found) for k in (0, 1))
    return f"{all_tests - failed} of {all_tests} tests" if found else ""


def failures(log):
    return re.findall(r"^\s+\d+ - (\S+) \((?:Failed|Timeout|SEGFAULT|Not Run|.*Exception).*\)", log, re.MULTILINE)


def words_of(seconds):
    return f"{seconds / 3600:.1f} h" if seconds >= 5400 else f"{seconds / 60:.0f} min" if seconds >= 90 else f"{seconds:.0f} s"


def page(night):
    """The results of a night as HTML; of one that has not ended, so far."""
    rows = []
    for part in PARTS:
        done = night["parts"].get(part)
        if done is None:
            rows.append(f"<tr><td>{part}<td>not run<td><td><td>")
            continue
        named = "<br>".join(html.escape(name) for name in done["failures"])
        rows.append(f'<tr><td><a href="{night["date"]}/{part}.log">{part}</a><td class="{done["result"]}">{done["result"]}'
                    f'<td>{words_of(done["seconds"])}<td>{html.escape(done["tests"])}<td>{named}')
    results = [done["result"] for done in night["parts"].values()]
    summary = (f"{results.count('passed')} of {len(PARTS)} parts passed in {words_of(sum(d['seconds'] for d in night['parts'].values()))}, "
               f"at {night['commit']}, on {os.cpu_count()} processors.")
    return (f'<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>Tests of {night["date"]}</title><style>{STYLE}</style>'
            f'<h1>Tests of {night["date"]}</h1><p>{summary}</p><table><tr><th>part<th>result<th>time<th>tests<th>failed'
            + "".join(rows) + "</table>\n")


class Night:
    def __init__(self, folder, hours):
        self.folder = folder
        self.end = time.monotonic() + 3600 * hours
        folder.mkdir(parents=True, exist_ok=True)
        self.state = self.unfinished() or {"date": self.new_date(), "commit": commit(), "parts": {}}
        (folder / self.state["date"]).mkdir(exist_ok=True)

    def unfinished(self):
        states = sorted(self.folder.glob("*/state.json"))
        state = json.loads(states[-1].read_text()) if states else None
        if state and state["commit"] == commit() and set(state["parts"]) != set(PARTS):
            return state
        return None

    def new_date(self):
        """A second night of a day has a number."""
        today = datetime.date.today().isoformat()
        number = 1
        while (self.folder / (today if number == 1 else f"{today}-{number}")).exists():
            number += 1
        return today if number == 1 else f"{today}-{number}"

    def save(self):
        for path, text in ((self.folder / self.state["date"] / "state.json", json.dumps(self.state, indent=1) + "\n"),
                           (self.folder / f"{self.state['date']}.html", page(self.state))):
            written = path.with_name(path.name + ".new")
            written.write_text(text)
            written.rename(path)

    def run_part(self, part, command):
        log_path = self.folder / self.state["date"] / f"{part}.log"
        print(f"== {part}: {log_path}", flush=True)
        begun = time.monotonic()
        with open(log_path, "wb") as log:
            process = subprocess.Popen(command, cwd=SOURCE, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True)
            try:
                result = "passed" if process.wait(timeout=max(self.end - begun, 1)) == 0 else "failed"
            except subprocess.TimeoutExpired:
                result = "stopped"
            finally:
                if process.poll() is None:
                    os.killpg(process.pid, signal.SIGTERM)
                    process.wait()
        text = log_path.read_text(errors="replace")
        self.state["parts"][part] = {"result": result, "seconds": round(time.monotonic() - begun), "tests": counts(text),
                                     "failures": failures(text)}
        self.save()

    def run(self, command_of):
        self.save()
        for part in PARTS:
            if part not in self.state["parts"] and time.monotonic() < self.end:
                self.run_part(part, command_of(part))
        print(self.folder / f"{self.state['date']}.html")
        return all(done["result"] == "passed" for done in self.state["parts"].values()) and len(self.state["parts"]) == len(PARTS)


def command_of(part):
    return ["tests/run"] + {"release": [], "fuzz": ["--fuzz", FUZZ_SECONDS]}.get(part, [f"--{part}"])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=float, default=8.0)
    parser.add_argument("--folder", type=pathlib.Path, default=SOURCE / "build-night")
    asked = parser.parse_args()
    sys.exit(0 if Night(asked.folder, asked.hours).run(command_of) else 1)
