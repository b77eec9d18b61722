"""The program with something that fails, started once for many faults (forked_main.h)."""

import contextlib
import hashlib
import os
import re
import signal
import sqlite3
import subprocess
import tempfile
import types

from capstan_program import PROGRAM, CapstanTest
from small_study import integrity

# The faults are not the disk's own: what is written need not reach one.
if os.access("/dev/shm", os.W_OK):
    tempfile.tempdir = "/dev/shm"


class FaultyTest(CapstanTest):
    shim = None  # the library that makes things fail

    def setUp(self):
        super().setUp()
        self.judged = set()  # files that faults have left, byte for byte
        self.continued = {}  # what faults have left, by its rows -> the first fault that left it

    def environment(self, **more):
        return {**os.environ, "LD_PRELOAD": self.shim, "CAPSTAN_FAULT_COUNT": "count", **more}

    def count_of(self, *words, program=PROGRAM):
        """How many requests the command makes that may fail, and its answer."""
        done = self.run_program(program, *words, env=self.environment(CAPSTAN_FAULT_AT="0"))
        return int((self.folder / "count").read_text()), done.stdout

    def start_faulty(self, *words, program=PROGRAM):
        """A program that runs the command for every fault it is told of."""
        process = subprocess.Popen([program, *map(str, words)], cwd=self.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   text=True, bufsize=1, env=self.environment(CAPSTAN_FAULT_SERVER="1"))
        self.addCleanup(self.end, process)
        return process

    def faulty(self, process, fault):
        """How the command ends with this fault."""
        process.stdin.write(f"{fault}\n")
        code = os.waitstatus_to_exitcode(int(process.stdout.readline()))
        self.assertNotEqual(code, -signal.SIGALRM, f"{fault}: it hangs")
        return types.SimpleNamespace(returncode=code, stdout=(self.folder / "out").read_text(), stderr=(self.folder / "err").read_text())

    def remove(self, pattern):
        for path in self.folder.glob(pattern):
            path.unlink()

    def run_capstan_any(self, *words):
        return subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True)

    def assert_whole(self, name, *said):
        path = self.folder / name
        if path.exists():
            self.assertEqual(integrity(path), ["ok"], (name, *said))

    def left_before(self, pattern, outcome):
        """Whether a fault with this outcome has left the very same files before: then they are judged already."""
        state = hashlib.sha256(repr(outcome).encode())
        for path in sorted(self.folder.glob(pattern)):
            state.update(f"{path.name} {path.stat().st_size} ".encode() + path.read_bytes())
        known = state.digest() in self.judged
        self.judged.add(state.digest())
        return known

    def is_new(self, fault, pattern):
        """Whether no fault before has left these files with the same rows and schema: what goes on from such a state has been
        tried, and ends the same way."""
        state = [(path.name, content_of(path)) for path in sorted(self.folder.glob(pattern))]
        return self.continued.setdefault(hashlib.sha256(repr(state).encode()).digest(), fault) == fault


def content_of(path):
    """Of a database its rows and schema, of anything else its bytes."""
    if path.stat().st_size == 0 or not re.search(r"\.db(\.version\d+)?$", path.name):
        return path.read_bytes()
    with contextlib.closing(sqlite3.connect(path)) as connection:
        schema = connection.execute("SELECT type, name, sql FROM sqlite_schema ORDER BY type, name").fetchall()
        version = connection.execute("PRAGMA user_version").fetchall()
        rows = [connection.execute(f"SELECT * FROM {name}").fetchall() for kind, name, _ in schema if kind == "table"]
    return schema, version, rows
