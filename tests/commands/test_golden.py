"""The promise of determinism, by checksum: of every table of every configuration's study, for any number of threads, any
split into shards and each width of vector instructions; and the golden ones, which a change must explain:

    WHY="one sentence" UPDATE_GOLDEN=1 ctest --preset release -R commands.golden
"""

import contextlib
import hashlib
import json
import operator
import os
import pathlib
import sqlite3
import subprocess
import unittest

from capstan_program import CONFIGS, PROGRAM, CapstanTest
from small_study import short_worlds

GOLDEN = pathlib.Path(__file__).with_name("golden_checksums.json")
BUILD = os.environ["CAPSTAN_BUILD"]  # what the program was built as: Release of g++, or another
# The golden checksums are those of one width that most processors of today have.
GOLDEN_WIDTH = "AVX2"
# Fewer repetitions than the configurations ask for: whatever changes a bit changes it in the first few.
STUDIES = {
    "quick": (),
    "paper": ("--repetitions", "100"),
    "noise-instants": ("--repetitions", "20"),
    "noise-sweep": ("--repetitions", "20"),
    "wrist-instants": ("--repetitions", "20"),
    "wrist-exosuit": ("--repetitions", "20"),
    "atlas": ("--repetitions", "2", "--shard", "1/800"),
}
SHORT = sorted(set(STUDIES) - {"atlas"})
# Its estimator's patterns may fall either way by the rounding of an exponential, so two widths agree in distribution only.
WORLDS = ("wrist-exosuit", "noise-sweep")
SHARDED = ("noise-instants", "wrist-instants", "wrist-exosuit")  # enough parts for four shards
BENCHES = ("bench-handle", "bench-ramps", "bench-slack")
# Between widths, compilers and degrees of optimisation only the order of sums differs. Errors are of the order of 0.1 N.
BOUND_N = 1e-11


def checksum(rows):
    return hashlib.sha256(repr(rows).encode()).hexdigest()[:16]


def parted(tables):
    """Of each row what is not a number, as text, and its numbers; in the order of the texts."""
    return {table: sorted((repr([value for value in row if type(value) is not float]),
                           [value for value in row if type(value) is float]) for row in rows)
            for table, rows in tables.items() if table != "content_hash"}


class Golden(CapstanTest):
    def run_study(self, config, db, *words, width=None, file=None):
        environment = {**os.environ, **({"CAPSTAN_SIMD": width} if width else {})}
        self.run_capstan("study", "run", file or CONFIGS / f"{config}.toml", *STUDIES[config], *words, "--db", db, env=environment)
        return self.tables(db)

    def file(self, config):
        """Of a study over worlds a shorter one, for what every study promises."""
        return self.write(f"{config}.toml", short_worlds(config)) if config in WORLDS else CONFIGS / f"{config}.toml"

    @staticmethod
    def widths():
        """Of this program on this processor, widest first: what it says when it is asked for one that nobody has."""
        done = subprocess.run([PROGRAM, "doctor"], env={**os.environ, "CAPSTAN_SIMD": "none"}, capture_output=True, text=True)
        return done.stderr.strip().split(" has ")[1].split(", ")

    def assert_close(self, expected, actual, what):
        """Every number within the bound, everything else the same, of parted tables. Returns the largest difference."""
        largest = 0.0
        for table, rows in expected.items():
            self.assertEqual(len(rows), len(actual[table]), f"{what}: {table}")
            for (text, numbers), (other, found) in zip(rows, actual[table]):
                self.assertEqual(text, other, f"{what}: {table}")
                for difference in map(abs, map(operator.sub, numbers, found)):
                    if not difference <= BOUND_N:
                        self.fail(f"{what}: {table} {text} {numbers} {found}")
                    if difference > largest:
                        largest = difference
        return largest

    def test_threads(self):
        for config in SHORT:
            file = self.file(config)
            expected = self.run_study(config, f"{config}-1.db", "--jobs", "1", file=file)
            for jobs in ("2", "7", "16"):
                self.assert_same_bits(expected, self.run_study(config, f"{config}-{jobs}.db", "--jobs", jobs, file=file))

    def test_shard_splits(self):
        for config in SHARDED:
            file = self.file(config)
            expected = self.run_study(config, f"{config}.db", file=file)
            for count in (2, 3, 4):
                names = [f"{config}-{number}-of-{count}.db" for number in range(1, count + 1)]
                for number, name in enumerate(names, 1):
                    self.run_study(config, name, "--shard", f"{number}/{count}", file=file)
                self.run_capstan("study", "merge", "--db", f"{config}-of-{count}.db", *names)
                self.assert_same_bits(expected, self.tables(f"{config}-of-{count}.db"))

    def test_vector_widths(self):
        """Each width is the same to the bit every time; from one width to another, within the bound."""
        widths = self.widths()
        self.assertIn("SCALAR", widths)
        for config in sorted(set(SHORT) - set(WORLDS)):
            first = parted(self.run_study(config, f"{config}.db", width=widths[0]))
            for width in widths[1:]:
                tables = self.run_study(config, f"{config}-{width}.db", width=width)
                again = self.run_study(config, f"{config}-{width}-again.db", "--jobs", "2", width=width)
                self.assert_same_bits(tables, again)
                largest = self.assert_close(first, parted(tables), f"{config}, {widths[0]} and {width}")
                print(f"{config}: {widths[0]} and {width} differ by at most {largest:.1e}")

    def observed(self):
        checksums, numbers = {}, {}
        for config in STUDIES:
            tables = self.run_study(config, f"golden-{config}.db", width=GOLDEN_WIDTH)
            checksums[config] = {table: checksum(rows) for table, rows in tables.items() if rows}
            # A few figures in full, so that another build can be held to a bound: the mean of each kind of error.
            with contextlib.closing(sqlite3.connect(self.folder / f"golden-{config}.db")) as connection:
                numbers[config] = dict(connection.execute(
                    "SELECT method, avg(mean_abs_error_N) FROM cell GROUP BY method ORDER BY method").fetchall())
        for config in BENCHES:
            done = self.run_capstan("simulate", CONFIGS / f"{config}.toml", env={**os.environ, "CAPSTAN_SIMD": GOLDEN_WIDTH})
            checksums[config] = {"simulate": checksum(done.stdout)}
        return checksums, numbers

    def test_golden_checksums(self):
        if GOLDEN_WIDTH not in self.widths():
            self.skipTest(f"the golden checksums are those of {GOLDEN_WIDTH}, which this processor lacks")
        checksums, numbers = self.observed()
        if os.environ.get("UPDATE_GOLDEN"):
            why = os.environ.get("WHY", "").strip()
            self.assertTrue(why, 'say why the numbers changed: WHY="one sentence"')
            history = json.loads(GOLDEN.read_text())["why"] if GOLDEN.exists() else []
            GOLDEN.write_text(json.dumps({"why": [*history, why], "build": BUILD, "checksums": checksums,
                                          "mean_abs_error_N": numbers}, indent=1) + "\n")
        golden = json.loads(GOLDEN.read_text())
        for config, methods in golden["mean_abs_error_N"].items():
            for method, value in methods.items():
                self.assertAlmostEqual(numbers[config][method], value, delta=BOUND_N, msg=f"{config}, {method}")
        if BUILD != golden["build"]:
            print(f"built as {BUILD}: held to {BOUND_N} N; the bits are those of {golden['build']}")
            return
        for config, tables in golden["checksums"].items():
            changed = [table for table, value in tables.items() if checksums[config].get(table) != value]
            self.assertFalse(changed, f"{config}: these tables have other bits than before. If that is meant, "
                                      f"UPDATE_GOLDEN=1 and WHY (see the top of {GOLDEN.with_name('test_golden.py').name})")


if __name__ == "__main__":
    unittest.main()
