"""Every write, sync and truncation of SQLite failing in turn, in a study, a merge and a migration: a clear error, nothing
corrupt, and going on ends with the same bits.

CAPSTAN_DISK_FAULTS says how many of them are tried in each case, spread evenly (8); `all` tries every one."""

import os
import shutil
import subprocess
import unittest

from capstan_program import PROGRAM, CapstanTest
from small_study import SMALL_STUDY, integrity, to_version_1

SHIM = os.environ["CAPSTAN_SQLITE_FAULTS"]
TRIED = os.environ.get("CAPSTAN_DISK_FAULTS", "8")
# A full disk refuses to be written; where a sync or a truncation is the one that fails, it is an error of the disk.
FULL = "disk is full|disk reports an error"
KINDS = {"full": FULL, "error": "disk reports an error", "short": FULL, "stays_full": "disk is full"}
FEW_UNITS = SMALL_STUDY.replace("samples = [15, 18, 21, 39, 42, 45]", "samples = [15, 45]")


class DiskFaults(CapstanTest):
    def setUp(self):
        super().setUp()
        self.write("small.toml", FEW_UNITS.format(seed=1))

    def faulty(self, at, kind, *words):
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=300,
                              env={**os.environ, "LD_PRELOAD": SHIM, "CAPSTAN_FAULT_AT": str(at), "CAPSTAN_FAULT_KIND": kind,
                                   "CAPSTAN_FAULT_COUNT": "count"})
        return done

    def places(self, *words):
        """Which of the operations that the command makes are to fail."""
        done = self.faulty(0, "full", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        count = int((self.folder / "count").read_text())
        self.assertGreater(count, 20)
        if TRIED == "all":
            return count, range(1, count + 1)
        wanted = min(int(TRIED), count)
        return count, sorted({1 + k * (count - 1) // max(1, wanted - 1) for k in range(wanted)})

    def remove(self, *patterns):
        for pattern in patterns:
            for path in self.folder.glob(pattern):
                path.unlink()

    def judge(self, done, kind, at):
        """Whether the command failed; then it says why, in one line, and does not crash."""
        self.assertIn(done.returncode, (0, 1, 3), f"{kind} at {at}: {done.stderr}")
        if done.returncode != 0:
            self.assertRegex(done.stderr, KINDS[kind], f"{kind} at {at}")
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, f"{kind} at {at}: {done.stderr}")
        return done.returncode != 0

    def assert_whole(self, name):
        path = self.folder / name
        if path.exists():
            self.assertEqual(integrity(path), ["ok"], name)

    def try_all(self, what, prepare, words, go_on):
        prepare()
        count, places = self.places(*words)
        tried, failed = 0, 0
        for kind in KINDS:
            for at in places:
                prepare()
                done = self.faulty(at, kind, *words)
                tried += 1
                failed += self.judge(done, kind, at)
                with self.subTest(kind=kind, at=at, said=done.stderr, code=done.returncode):
                    go_on(done.returncode == 0)
        print(f"{what}: {tried} faults at {len(places)} of {count} writes, syncs and truncations; {failed} ended the "
              f"command with an error, the others SQLite could do without", flush=True)
        self.assertGreater(failed, tried // 2)

    def test_a_study(self):
        self.run_capstan("study", "run", "small.toml", "--db", "whole.db")
        expected = self.tables("whole.db")
        words = ("study", "run", "small.toml", "--db", "faulty.db", "--jobs", 1, "--progress", "none")

        def go_on(succeeded):
            self.assert_whole("faulty.db")
            if not succeeded:
                if self.run_capstan_any("study", "resume", "latest", "--db", "faulty.db").returncode != 0:
                    self.run_capstan("study", "run", "small.toml", "--db", "faulty.db")  # it had not begun
            self.assert_whole("faulty.db")
            self.assert_same_bits(expected, self.tables("faulty.db"))

        self.try_all("study", lambda: self.remove("faulty.db*"), words, go_on)

    def run_capstan_any(self, *words):
        return subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=300)

    def test_a_merge(self):
        shards = ("1.db", "2.db")
        for number, name in enumerate(shards, 1):
            self.run_capstan("study", "run", "small.toml", "--shard", f"{number}/{len(shards)}", "--db", name)
        rows = [self.tables(name) for name in shards]
        self.run_capstan("study", "merge", "--db", "whole.db", *shards)
        expected = self.tables("whole.db")
        words = ("study", "merge", "--db", "merged.db", "--progress", "none", *shards)

        def go_on(succeeded):
            self.assertEqual((self.folder / "merged.db").exists(), succeeded, "whole or not at all")
            if not succeeded:
                self.run_capstan(*words)
            self.assert_whole("merged.db")
            self.assert_same_bits(expected, self.tables("merged.db"))
            for name, before in zip(shards, rows):
                self.assert_same_bits(before, self.tables(name))

        self.try_all("merge", lambda: self.remove("merged.db*"), words, go_on)

    def test_a_migration(self):
        self.run_capstan("study", "run", "small.toml", "--db", "old.db")
        to_version_1(self.folder / "old.db")
        old = self.tables("old.db")
        shutil.copy(self.folder / "old.db", self.folder / "whole.db")
        self.run_capstan("study", "resume", "all", "--db", "whole.db")
        expected = self.tables("whole.db")
        words = ("study", "resume", "all", "--db", "older.db")

        def prepare():
            self.remove("older.db*")
            shutil.copy(self.folder / "old.db", self.folder / "older.db")

        def go_on(succeeded):
            self.assert_whole("older.db")
            found = self.tables("older.db")
            self.assert_same_bits(expected if sorted(found) == sorted(expected) else old, found)
            copy = self.folder / "older.db.version1"
            if copy.exists():
                self.assert_whole(copy.name)
                self.assert_same_bits(old, self.tables(copy.name))
            self.run_capstan(*words)
            self.assert_whole("older.db")
            self.assert_same_bits(expected, self.tables("older.db"))

        self.try_all("migration", prepare, words, go_on)


if __name__ == "__main__":
    unittest.main()
