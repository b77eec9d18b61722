"""Running the program under test in a folder of its own."""

import contextlib
import marshal
import os
import pathlib
import sqlite3
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["CAPSTAN"]
CONFIGS = pathlib.Path(os.environ["CAPSTAN_CONFIGS"])


class CapstanTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_capstan(self, *words, expect=0, **options):
        """The finished process; fails unless it ends with the expected exit code."""
        return self.run_program(PROGRAM, *words, expect=expect, **options)

    def run_program(self, program, *words, expect=0, **options):
        done = subprocess.run([program, *map(str, words)], cwd=self.folder, capture_output=True, text=True, **options)
        self.assertEqual(done.returncode, expect, f"{program} {' '.join(map(str, words))}\n{done.stdout}\n{done.stderr}")
        return done

    def start_capstan(self, *words):
        process = subprocess.Popen([PROGRAM, *map(str, words)], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        process.kill()
        process.communicate()

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def tables(self, name):
        """Every row of every table but the history, which has a clock; Python prints and compares doubles bit for bit."""
        with contextlib.closing(sqlite3.connect(self.folder / name)) as connection:
            names = [row[0] for row in connection.execute("SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT IN ('history', 'computed_with') "
                                                             "ORDER BY name")]
            self.assertIn("cell", names)
            return {table: sorted(connection.execute(f"SELECT * FROM {table}").fetchall(), key=repr) for table in names}

    def assert_same_bits(self, expected, actual):
        """Names the first difference instead of printing two databases."""
        self.assertEqual(sorted(expected), sorted(actual))
        for table, rows in expected.items():
            if marshal.dumps(rows, 2) == marshal.dumps(actual[table], 2):  # all at once, and exactly
                continue
            self.assertEqual(len(rows), len(actual[table]), table)
            for row, other in zip(rows, actual[table]):
                self.assertEqual(repr(row), repr(other), table)
