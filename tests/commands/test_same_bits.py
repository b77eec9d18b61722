"""The promise of the results database: the same bits for any thread count, and after any kill and resume."""

import contextlib
import json
import os
import pathlib
import random
import signal
import sqlite3
import subprocess
import time
import unittest

from capstan_program import CONFIGS, CapstanTest

# Long enough to be killed ten times, with several noise levels, regimes and units.
STUDY = (CONFIGS / "noise-instants.toml", "--repetitions", "200")


class SameBits(CapstanTest):
    def uninterrupted(self):
        start = time.monotonic()
        self.run_capstan("study", "run", *STUDY, "--db", "complete.db")
        return self.tables("complete.db"), time.monotonic() - start

    def status(self, name):
        """Of the only study: 'running', 'complete', or None before it was begun."""
        try:
            connection = sqlite3.connect(f"file:{self.folder / name}?mode=ro", uri=True)
            with contextlib.closing(connection):
                return connection.execute("SELECT status FROM study").fetchone()[0]
        except (sqlite3.Error, TypeError):
            return None

    def test_any_number_of_jobs(self):
        """Also with more threads than processors: so many really are there, which is looked up while it runs."""
        expected, _ = self.uninterrupted()
        for jobs in (1, 2, 7, 16):
            process = self.start_capstan("study", "run", *STUDY, "--db", f"jobs{jobs}.db", "--jobs", jobs, "--progress", "none")
            threads = self.max_threads(process)
            self.assertEqual(process.returncode, 0, process.stderr.read())
            self.assertEqual(threads, jobs)
            print(f"the same bits with {threads} threads on {os.cpu_count()} processors")
            self.assert_same_bits(expected, self.tables(f"jobs{jobs}.db"))

    @staticmethod
    def max_threads(process):
        """That the process had at any time until it ended."""
        most = 0
        while process.poll() is None:
            with contextlib.suppress(OSError, StopIteration):
                lines = pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines()
                most = max(most, int(next(line for line in lines if line.startswith("Threads:")).split()[1]))
            time.sleep(0.002)
        return most

    def test_killed_ten_times_at_random_moments(self):
        expected, duration_s = self.uninterrupted()
        moments = random.Random(20)
        kills = 0
        round_number = 0
        while kills < 10:  # a round that ends before it has been killed often enough is followed by another
            round_number += 1
            name = f"killed{round_number}.db"
            while kills < 10:
                words = ("study", "resume") if self.status(name) else ("study", "run", *STUDY)
                process = self.start_capstan(*words, "--db", name, "--jobs", "2")
                try:
                    process.wait(timeout=moments.uniform(0.0, 0.4 * duration_s))
                    break
                except subprocess.TimeoutExpired:
                    process.send_signal(signal.SIGKILL)
                    process.communicate()
                    kills += 1
            words = ("study", "resume") if self.status(name) else ("study", "run", *STUDY)
            self.run_capstan(*words, "--db", name)
            self.assert_same_bits(expected, self.tables(name))

    def test_killed_after_each_unit(self):
        """The moments that random ones may miss: right behind a commit."""
        expected, _ = self.uninterrupted()
        for units in (1, 2, 5, 9, 30, 55):
            name = f"units{units}.db"
            process = self.start_capstan("study", "run", *STUDY, "--db", name, "--progress", "json")
            for line in process.stderr:
                if f'"done":{units},' in line:
                    break
            process.send_signal(signal.SIGKILL)
            process.communicate()
            self.run_capstan("study", "resume", "--db", name)
            self.assert_same_bits(expected, self.tables(name))

    def test_stopped_politely_and_resumed(self):
        expected, _ = self.uninterrupted()
        for request in (signal.SIGINT, signal.SIGTERM):
            name = f"stopped{int(request)}.db"
            process = self.start_capstan("study", "run", *STUDY, "--db", name, "--progress", "json")
            for line in process.stderr:
                if '"done":2,' in line:
                    break
            process.send_signal(request)
            answer, messages = process.communicate()
            self.assertEqual(process.returncode, 130, messages)
            self.assertIn("capstan study resume 1 --db " + name, messages)
            self.assertEqual(answer, "")
            self.run_capstan("recommend", "--db", name, expect=3)  # says that it is not complete
            self.run_capstan("study", "resume", "--db", name)
            self.assert_same_bits(expected, self.tables(name))

    def test_seed_changes_the_draws_and_comes_back(self):
        for name, seed in (("a.db", 5), ("b.db", 5), ("c.db", 6)):
            self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", name, "--seed", seed)
        self.assert_same_bits(self.tables("a.db"), self.tables("b.db"))
        self.assertNotEqual(self.tables("a.db")["cell"], self.tables("c.db")["cell"])

    def test_stored_configuration_runs_the_same_study(self):
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "a.db", "--repetitions", 30, "--seed", 9)
        self.run_capstan("study", "show", "--config", "--db", "a.db", "-o", "again.toml")
        self.run_capstan("study", "run", "again.toml", "--db", "b.db")
        self.assert_same_bits(self.tables("a.db"), self.tables("b.db"))

    def test_replay_shows_a_repetition_of_the_study(self):
        """The mean error over replayed repetitions is the stored one."""
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--repetitions", 4)
        errors = {}
        for repetition in (1, 2, 3, 4):
            replay = json.loads(self.run_capstan("study", "replay", "--json", "--repetition", repetition).stdout)
            for estimate in replay["estimates"]:
                key = (json.dumps(estimate["nodes"]).replace(" ", ""), estimate["method"])
                errors.setdefault(key, {})[repetition] = estimate["mean_abs_error_N"]
        connection = sqlite3.connect(self.folder / "capstan.db")
        self.addCleanup(connection.close)
        cells = connection.execute("SELECT nodes, method, mean_abs_error_N FROM cell JOIN sensor_set USING (sensor_set_id) "
                                   "JOIN scenario USING (scenario_id) WHERE scenario_index = 0").fetchall()
        self.assertTrue(cells)
        for nodes, method, stored in cells:
            self.assertAlmostEqual(sum(errors[nodes, method].values()) / 4, stored, places=12, msg=f"{nodes} {method}")


if __name__ == "__main__":
    unittest.main()
