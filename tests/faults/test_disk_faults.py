"""Every write, sync and truncation of SQLite failing in turn, in a study, a merge and a migration: a clear error, nothing
corrupt, and going on ends with the same bits.

CAPSTAN_DISK_FAULTS says how many of them are tried in each case, spread evenly (8); `all` tries every one."""

import os
import shutil
import sqlite3
import unittest

from capstan_program import PROGRAM
from faulty_program import FaultyTest
from small_study import SMALL_STUDY

MIGRATE_FILE = os.environ["CAPSTAN_MIGRATE_FILE"]  # the migration of no release, tests/storage/migrate_file.cpp
TRIED = os.environ.get("CAPSTAN_DISK_FAULTS", "8")
# A full disk refuses to be written; where a sync or a truncation is the one that fails, it is an error of the disk.
FULL = "disk is full|disk reports an error"
KINDS = {"full": FULL, "error": "disk reports an error", "short": FULL, "stays_full": "disk is full"}
FEW_UNITS = SMALL_STUDY.replace("samples = [15, 18, 21, 39, 42, 45]", "samples = [15, 45]")


def columns_of(path, table):
    connection = sqlite3.connect(path)
    try:
        return [row[1] for row in connection.execute(f"PRAGMA table_info({table})")]
    finally:
        connection.close()


class DiskFaults(FaultyTest):
    shim = os.environ["CAPSTAN_SQLITE_FAULTS"]

    def setUp(self):
        super().setUp()
        self.write("small.toml", FEW_UNITS.format(seed=1))

    def places(self, *words, program):
        """Which of the operations that the command makes are to fail."""
        count, _ = self.count_of(*words, program=program)
        self.assertGreater(count, 20)
        if TRIED == "all":
            return count, range(1, count + 1)
        wanted = min(int(TRIED), count)
        return count, sorted({1 + k * (count - 1) // max(1, wanted - 1) for k in range(wanted)})

    def judge(self, done, kind, at):
        """Whether the command failed; then it says why, in one line, and does not crash."""
        self.assertIn(done.returncode, (0, 1, 3), f"{kind} at {at}: {done.stderr}")
        if done.returncode != 0:
            self.assertRegex(done.stderr, KINDS[kind], f"{kind} at {at}")
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, f"{kind} at {at}: {done.stderr}")
        return done.returncode != 0

    def try_all(self, what, files, prepare, words, look, go_on, program=PROGRAM):
        """`look` at the files that each fault leaves; `go_on` from them, where none before has left the same."""
        prepare()
        count, places = self.places(*words, program=program)
        process = self.start_faulty(*words, program=program)
        tried, failed = 0, 0
        for kind in KINDS:
            print(f"  {what}: {kind}", flush=True)
            for at in places:
                prepare()
                done = self.faulty(process, f"{at} {kind}")
                tried += 1
                failed += self.judge(done, kind, at)
                if self.left_before(files, done.returncode):
                    continue
                with self.subTest(kind=kind, at=at, said=done.stderr, code=done.returncode):
                    look(done.returncode == 0)
                    if done.returncode != 0 and self.is_new((kind, at), files):
                        go_on()
        print(f"{what}: {tried} faults at {len(places)} of {count} writes, syncs and truncations; {failed} ended the "
              f"command with an error, the others SQLite could do without; {len(self.judged)} different files were left, of "
              f"{len(self.continued)} different contents, each gone on from", flush=True)
        self.assertGreater(failed, tried // 2)

    def test_a_study(self):
        self.run_capstan("study", "run", "small.toml", "--db", "complete.db")
        expected = self.tables("complete.db")
        words = ("study", "run", "small.toml", "--db", "faulty.db", "--jobs", 1, "--progress", "none")

        def look(succeeded):
            self.assert_whole("faulty.db")
            if succeeded:
                self.assert_same_bits(expected, self.tables("faulty.db"))

        def go_on():
            if self.run_capstan_any("study", "resume", "latest", "--db", "faulty.db").returncode != 0:
                self.run_capstan("study", "run", "small.toml", "--db", "faulty.db")  # it had not begun
            look(True)

        self.try_all("study", "faulty.db*", lambda: self.remove("faulty.db*"), words, look, go_on)

    def test_a_merge(self):
        shards = ("1.db", "2.db")
        for number, name in enumerate(shards, 1):
            self.run_capstan("study", "run", "small.toml", "--shard", f"{number}/{len(shards)}", "--db", name)
        rows = [self.tables(name) for name in shards]
        self.run_capstan("study", "merge", "--db", "complete.db", *shards)
        expected = self.tables("complete.db")
        words = ("study", "merge", "--db", "merged.db", "--progress", "none", *shards)

        def look(succeeded):
            self.assertEqual((self.folder / "merged.db").exists(), succeeded, "complete or not at all")
            if succeeded:
                self.assert_whole("merged.db")
                self.assert_same_bits(expected, self.tables("merged.db"))
            for name, before in zip(shards, rows):
                self.assert_same_bits(before, self.tables(name))

        def go_on():
            self.run_capstan(*words)
            look(True)

        self.try_all("merge", "[12m]*.db*", lambda: self.remove("merged.db*"), words, look, go_on)

    def test_a_migration(self):
        self.run_capstan("study", "run", "small.toml", "--db", "old.db")
        old = self.tables("old.db")
        shutil.copy(self.folder / "old.db", self.folder / "complete.db")
        self.run_program(MIGRATE_FILE, "complete.db")
        expected = self.tables("complete.db")

        def prepare():
            self.remove("older.db*")
            shutil.copy(self.folder / "old.db", self.folder / "older.db")

        def look(succeeded):
            self.assert_whole("older.db")
            found = self.tables("older.db")
            self.assert_same_bits(expected if succeeded or "author" in columns_of(self.folder / "older.db", "study") else old, found)
            copy = self.folder / "older.db.version1"
            if copy.exists():
                self.assert_whole(copy.name)
                self.assert_same_bits(old, self.tables(copy.name))

        def go_on():
            self.run_program(MIGRATE_FILE, "older.db")
            look(True)

        self.try_all("migration", "older.db*", prepare, ("older.db",), look, go_on, program=MIGRATE_FILE)


if __name__ == "__main__":
    unittest.main()
