"""Reads logs that others wrote with print_log, and compares."""
import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PRINT_LOG = os.environ["CAPSTAN_PRINT_LOG"]


class Log:
    def __init__(self, line):
        self.refusal = line.get("refusal", "")
        self.remarks = "\n".join(line.get("remarks", []))
        self.assumptions = "\n".join(line.get("assumptions", []))
        self.format = line.get("format")
        self.rows = {table["name"]: table["rows"] for table in line.get("tables", [])}
        self.tables = {table["name"]: {column["name"]: [math.nan if value is None else value for value in column["values"]]
                                       for column in table["columns"]} for table in line.get("tables", [])}
        self.units = {table["name"]: {column["name"]: column["unit"] for column in table["columns"]}
                      for table in line.get("tables", [])}


def read_logs(paths):
    """One Log a path. A crash, or an exception that is not a refusal, is an error of the test."""
    run = subprocess.run([PRINT_LOG, *map(str, paths)], capture_output=True, text=True)
    if run.returncode != 0:
        raise AssertionError(f"print_log ended with {run.returncode} after {len(run.stdout.splitlines())} files of "
                             f"{[str(path) for path in paths]}: {run.stderr}")
    return [Log(json.loads(line)) for line in run.stdout.splitlines()]


def read_log(path):
    return read_logs([path])[0]


class WrittenLogTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name)

    def assert_numbers(self, table, expected):
        """Every number of every column, to the last bit."""
        self.assertEqual(list(table), list(expected))
        for name, values in expected.items():
            got, values = table[name], [float(value) for value in values]
            self.assertEqual(len(got), len(values), name)
            for row, (one, other) in enumerate(zip(got, values)):
                self.assertTrue(one == other or (math.isnan(one) and math.isnan(other)), f"{name}, row {row}: {one}, not {other}")

    def assert_cuts_are_told(self, path, may_be_silent_from=None):
        """At every fiftieth of the file: the complete part with a remark, or a refusal that says why."""
        complete = path.read_bytes()
        full = read_log(path)
        paths = []
        for part in range(1, 50):
            cut = path.with_name(f"cut_{part:02d}{path.suffix}")
            cut.write_bytes(complete[:len(complete) * part // 50])
            paths.append(cut)
        kept = 0
        for cut, log in zip(paths, read_logs(paths)):
            at = cut.stat().st_size
            if may_be_silent_from is not None and at >= may_be_silent_from:
                continue
            self.assertTrue(log.remarks or log.refusal, f"{path.name} cut at {at} of {len(complete)} bytes: nothing is said")
            for name, table in log.tables.items():
                for column, values in table.items():
                    whole_values = full.tables[name][column]
                    self.assertLessEqual(len(values), len(whole_values))
                    for row, (one, other) in enumerate(zip(values, whole_values)):
                        self.assertTrue(one == other or (math.isnan(one) and math.isnan(other)),
                                        f"{path.name} cut at {at}: {name} {column}, row {row}: {one}, not {other}")
                kept = max(kept, log.rows[name])
            cut.unlink()
        return kept
