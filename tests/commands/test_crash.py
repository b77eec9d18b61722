"""Killed at random moments, a study, a merge, a migration, a report and a job of the service lose nothing that was said to be done.

CAPSTAN_CRASHES says how many moments (10); they are the same ones in every run. After each kill the database is intact, what was
reported as done is there, and going on ends with the bits of a run that nobody disturbed."""

import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import time
import unittest

from capstan_program import PROGRAM
from capstan_service import ServiceTest
from small_study import SMALL_STUDY, UNITS, integrity

MIGRATE_FILE = os.environ["CAPSTAN_MIGRATE_FILE"]  # the migration of no release, tests/storage/migrate_file.cpp
CRASHES = max(5, int(os.environ.get("CAPSTAN_CRASHES", "10")))
KINDS = 5
EACH = (CRASHES + KINDS - 1) // KINDS


class Crash(ServiceTest):
    def setUp(self):
        super().setUp()
        self.moments = random.Random(20240917)
        self.write("small.toml", SMALL_STUDY.format(seed=1))
        self.killed_under_way = 0

    def killed(self, lasts_s, *words, program=PROGRAM):
        """Runs a command and kills it at a random moment; its messages, and whether it was still at work."""
        process = subprocess.Popen([program, *map(str, words)], cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        try:
            process.wait(self.moments.uniform(0, 1.1 * lasts_s))
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
        messages = process.communicate()[1]
        self.assertIn(process.returncode, (0, -signal.SIGKILL), messages)
        self.killed_under_way += process.returncode != 0
        return messages

    def lasting(self, *words, program=PROGRAM):
        """How long the command takes undisturbed; the least of three."""
        times_s = []
        for turn in range(3):
            begin = time.monotonic()
            self.run_program(program, *[str(word).format(turn=turn) for word in words])
            times_s.append(time.monotonic() - begin)
        return min(times_s)

    def remove(self, *patterns):
        for pattern in patterns:
            for path in self.folder.glob(pattern):
                shutil.rmtree(path) if path.is_dir() else path.unlink()

    def assert_intact(self, name):
        self.assertEqual(integrity(self.folder / name), ["ok"], name)

    def units_done(self, name):
        listed = json.loads(self.run_capstan("study", "list", "--json", "--db", name).stdout)
        return (listed[0]["units_done"], listed[0]["status"]) if listed else (0, "")

    @staticmethod
    def reported(messages):
        units, complete = 0, False
        for line in messages.splitlines():
            try:
                told = json.loads(line)
            except json.JSONDecodeError:
                continue  # cut off in the middle
            units = max(units, told.get("done") or 0)
            complete = complete or told.get("event") == "complete"
        return units, complete

    def test_a_study(self):
        lasts_s = self.lasting("study", "run", "small.toml", "--db", "complete{turn}.db", "--progress", "json")
        expected = self.tables("complete0.db")
        self.assertEqual(len(expected["work_unit"]), UNITS)
        most = 0
        for _ in range(EACH):
            self.remove("killed.db*")
            messages = self.killed(lasts_s, "study", "run", "small.toml", "--db", "killed.db", "--progress", "json")
            units, complete = self.reported(messages)
            most = max(most, units)
            done = (0, "")
            if (self.folder / "killed.db").exists():
                self.assert_intact("killed.db")
                if (self.folder / "killed.db").stat().st_size > 0:
                    done = self.units_done("killed.db")
            self.assertGreaterEqual(done[0], units)
            if complete:
                self.assertEqual(done[1], "complete")
            if done[1] == "":
                self.assertEqual(units, 0)
                self.run_capstan("study", "run", "small.toml", "--db", "killed.db")
            elif done[1] == "running":
                self.run_capstan("study", "resume", "latest", "--db", "killed.db")
            self.assert_same_bits(expected, self.tables("killed.db"))
        print(f"study: {self.killed_under_way} of {EACH} killed under way, up to unit {most} of {UNITS}", flush=True)

    def test_a_merge(self):
        shards = ("1.db", "2.db", "3.db")
        for number, name in enumerate(shards, 1):
            self.run_capstan("study", "run", "small.toml", "--shard", f"{number}/{len(shards)}", "--db", name)
        rows = [self.tables(name) for name in shards]
        lasts_s = self.lasting("study", "merge", "--db", "complete{turn}.db", *shards)
        expected = self.tables("complete0.db")
        for _ in range(EACH):
            self.remove("merged.db*")
            self.killed(lasts_s, "study", "merge", "--db", "merged.db", *shards)
            if (self.folder / "merged.db").exists():
                self.assert_intact("merged.db")
                self.assert_same_bits(expected, self.tables("merged.db"))
            else:
                self.run_capstan("study", "merge", "--db", "merged.db", *shards)
                self.assert_same_bits(expected, self.tables("merged.db"))
            for name, before in zip(shards, rows):
                self.assert_intact(name)
                self.assert_same_bits(before, self.tables(name))
        print(f"merge: {self.killed_under_way} of {EACH} killed under way", flush=True)

    def test_a_migration(self):
        self.run_capstan("study", "run", "small.toml", "--db", "old.db", "--repetitions", 200)
        version = schema_version(self.folder / "old.db")
        old = self.tables("old.db")
        for turn in range(3):
            shutil.copy(self.folder / "old.db", self.folder / f"complete{turn}.db")
        lasts_s = self.lasting("complete{turn}.db", program=MIGRATE_FILE)
        expected = self.tables("complete0.db")
        migrated = schema_version(self.folder / "complete0.db")
        self.assertGreater(migrated, version)
        versions = []
        for _ in range(EACH):
            self.remove("older.db*")
            shutil.copy(self.folder / "old.db", self.folder / "older.db")
            self.killed(lasts_s, "older.db", program=MIGRATE_FILE)
            self.assert_intact("older.db")
            versions.append(schema_version(self.folder / "older.db"))
            self.assertIn(versions[-1], (version, migrated))
            copy = self.folder / f"older.db.version{version}"
            if copy.exists():
                self.assert_intact(copy.name)
                self.assert_same_bits(old, self.tables(copy.name))
            self.assertTrue(versions[-1] == version or copy.exists(), "nothing is migrated without a copy beside it")
            self.assert_same_bits(old if versions[-1] == version else expected, self.tables("older.db"))
            self.run_program(MIGRATE_FILE, "older.db")
            self.assert_same_bits(expected, self.tables("older.db"))
        print(f"migration: {self.killed_under_way} of {EACH} killed under way, {versions.count(version)} before it was done", flush=True)

    def test_a_report(self):
        self.run_capstan("study", "run", "small.toml", "--db", "small.db")
        lasts_s = self.lasting("report", "--db", "small.db", "-o", "complete{turn}.html")
        expected = (self.folder / "complete0.html").read_bytes()
        absent = 0
        for turn in range(EACH):
            self.remove("report.html*")
            before = b"an older report" if turn % 2 else None
            if before:
                (self.folder / "report.html").write_bytes(before)
            self.killed(lasts_s, "report", "--db", "small.db", "-o", "report.html")
            found = (self.folder / "report.html").read_bytes() if (self.folder / "report.html").exists() else None
            self.assertIn(found, (before, expected))
            absent += found == before
            self.run_capstan("report", "--db", "small.db", "-o", "report.html")
            self.assertEqual((self.folder / "report.html").read_bytes(), expected)
        self.assert_intact("small.db")
        print(f"report: {self.killed_under_way} of {EACH} killed under way, {absent} left what there was before", flush=True)

    def test_a_job_of_the_service(self):
        toml = SMALL_STUDY.format(seed=1)
        self.run_capstan("study", "run", "small.toml", "--db", "complete.db")
        expected = self.tables("complete.db")
        most = 0
        for _ in range(EACH):
            self.remove("served.db*")
            process = self.serve("--jobs", 2)
            job = self.post("/api/studies", {"config_toml": toml}, expect=202)[0]["job"]
            wanted = self.moments.randint(0, UNITS)
            units = self.await_units(1, wanted) if wanted > 0 else 0
            time.sleep(self.moments.uniform(0, 0.05))
            most = max(most, units)
            process.send_signal(signal.SIGKILL)
            process.communicate()
            self.assert_intact("served.db")
            again = self.serve("--jobs", 2)
            self.assertGreaterEqual(sum(study["units_done"] for study in self.get("/api/studies")), units)
            self.assertEqual(self.await_job(job, "done")["study_id"], 1)
            self.assertEqual(len(self.get("/api/jobs")), 1)
            self.assert_same_bits(expected, self.tables("served.db"))
            again.send_signal(signal.SIGTERM)
            again.communicate()
            self.assert_intact("served.db")
        print(f"service: {EACH} killed, up to unit {most} of {UNITS}", flush=True)


def schema_version(path):
    """The schema's version, as the file says."""
    connection = sqlite3.connect(path)
    try:
        return connection.execute("PRAGMA user_version").fetchone()[0]
    finally:
        connection.close()


if __name__ == "__main__":
    unittest.main()
