"""Workers that share the folder of a study by leases: any number, killed, stopped or slow, the result has the bits of one run."""

import json
import os
import shutil
import signal
import sqlite3
import time
import unittest

from capstan_program import CONFIGS, CapstanTest
from small_study import short_worlds

STUDY = (CONFIGS / "noise-instants.toml", "--repetitions", "400")
SHARDS = 8


class FolderTest(CapstanTest):
    def worker(self, *words):
        return self.start_capstan("study", "work", "study", "--progress", "none", *words)

    def end_of(self, *workers):
        for worker in workers:
            _, messages = worker.communicate(timeout=120)
            self.assertEqual(worker.returncode, 0, messages)


class Workers(FolderTest):
    def setUp(self):
        super().setUp()
        self.submit()

    def submit(self):
        self.run_capstan("study", "submit", *STUDY, "--scheduler", "snakemake", "--shards", SHARDS, "--directory", "study")

    def status(self):
        return json.loads(self.run_capstan("study", "status", "study", "--json").stdout)

    def states(self):
        return [shard["state"] for shard in self.status()["shards"]]

    def wait(self, what, condition, seconds=120):
        end = time.monotonic() + seconds
        while not condition():
            self.assertLess(time.monotonic(), end, f"waited for: {what}\n{self.status()}")
            time.sleep(0.05)

    def held(self):
        return sorted(int(path.name.split("-")[1].split(".")[0]) for path in (self.folder / "study/leases").glob("*.lease")
                      if path.name.startswith("shard"))

    def assert_complete(self):
        self.run_capstan("study", "run", *STUDY, "--db", "complete.db")
        self.assert_same_bits(self.tables("complete.db"), self.tables("study/study.db"))
        self.assertEqual(self.states(), ["done"] * SHARDS)

    def has_stored_a_unit(self, shard):
        try:
            with sqlite3.connect(f"file:{self.folder}/study/shard-{shard}-of-{SHARDS}.db?mode=ro", uri=True) as connection:
                return connection.execute("SELECT ifnull(sum(done), 0) FROM work_unit").fetchone()[0] > 0
        except sqlite3.Error:
            return False

    def in_the_middle(self):
        """A shard with stored units of which some are left; its database lists the units of the other shards, too."""
        of_shard = self.status()["shards"]
        return next((shard for shard in self.held() if 0 < of_shard[shard - 1]["units_done"] < of_shard[shard - 1]["units"]), None)

    def stopped_in_the_middle(self, *words):
        """A worker that was stopped when it had stored a unit of its first shard and not all, and the shard. A busy machine may stop it too
        late: then the study begins again."""
        end = time.monotonic() + 120
        while True:
            worker = self.worker(*words)
            self.wait("a stored unit or the worker's end", lambda: any(map(self.has_stored_a_unit, self.held())) or worker.poll() is not None)
            if worker.poll() is None:
                worker.send_signal(signal.SIGSTOP)
                os.waitid(os.P_PID, worker.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
                shard = self.in_the_middle()
                if shard:
                    return worker, shard
                worker.kill()
            worker.communicate()
            self.assertLess(time.monotonic(), end, "no worker was stopped in the middle of a shard")
            shutil.rmtree(self.folder / "study")
            self.submit()

    def test_three_workers_share_the_shards(self):
        workers = [self.worker() for _ in range(3)]
        self.end_of(*workers)
        self.assert_complete()
        records = [json.loads((self.folder / f"study/leases/shard-{n}.done").read_text()) for n in range(1, SHARDS + 1)]
        self.assertEqual({record["worker"].rsplit("-", 1)[1] for record in records}, {str(worker.pid) for worker in workers})
        self.assertEqual([path.name for path in (self.folder / "study/leases").iterdir() if not path.name.endswith(".done")], [])

    def test_the_shard_of_a_killed_worker_is_done_by_another(self):
        dead, shard = self.stopped_in_the_middle()
        dead.kill()
        dead.wait()
        lease = self.folder / f"study/leases/shard-{shard}.lease"
        self.assertTrue(lease.exists())
        hour_ago = time.time() - 3600
        os.utime(lease, (hour_ago, hour_ago))
        self.end_of(self.worker())
        self.assert_complete()

    def test_a_slow_worker_does_not_hold_the_result(self):
        """The slowest there is: stopped in the middle, its lease renewed as by one that lives."""
        slow, _ = self.stopped_in_the_middle("--shard", 3)
        lease = self.folder / "study/leases/shard-3.lease"
        later = time.time() + 600  # a beat that is not stale for the length of the test
        os.utime(lease, (later, later))
        self.end_of(*[self.worker("--late", 1) for _ in range(2)])
        self.assertTrue((self.folder / "study/study.db").exists())
        record = json.loads((self.folder / "study/leases/shard-3.done").read_text())
        self.assertIn("shard-3-of-8-by-", record["file"])
        slow.send_signal(signal.SIGCONT)
        self.end_of(slow)
        self.assert_complete()

    def test_two_workers_on_one_shard_do_no_harm(self):
        self.end_of(*[self.worker("--shard", 2) for _ in range(2)])
        self.assertEqual(self.states()[1], "done")
        self.end_of(self.worker())
        self.assert_complete()

    def test_a_stopped_worker_goes_on(self):
        worker, _ = self.stopped_in_the_middle()
        worker.send_signal(signal.SIGINT)
        worker.send_signal(signal.SIGCONT)
        _, messages = worker.communicate(timeout=60)
        self.assertEqual(worker.returncode, 130, messages)
        self.assertEqual(self.held(), [])
        self.end_of(self.worker())
        self.assert_complete()

    def test_status_says_who_works_what_failed_and_what_is_left(self):
        slow, _ = self.stopped_in_the_middle("--shard", 2)
        self.end_of(self.worker("--shard", 1))
        self.write("study/shard-4-of-8.db", "not a database" * 200)
        with open(self.folder / "study/logs/shard-4.log", "w") as log:
            failed = self.start_capstan("study", "work", "study", "--shard", 4)
            _, messages = failed.communicate()
            log.write(messages)
        self.assertEqual(failed.returncode, 3)
        lease = self.folder / "study/leases/shard-2.lease"
        worker = lease.read_text().split()[0]
        lease.write_text(f"{worker} {time.time()}\n")
        status = self.status()
        self.assertEqual([shard["state"] for shard in status["shards"]][:5], ["done", "running", "not_started", "unfinished", "not_started"])
        self.assertIn("shard-4-of-8.db is not a database", status["shards"][3]["message"])
        self.assertTrue(status["shards"][1]["worker"].endswith(f"-{slow.pid}"))
        self.assertEqual(status["workers"], 1)
        seconds = json.loads((self.folder / "study/leases/shard-1.done").read_text())["seconds"]
        self.assertAlmostEqual(status["left_core_h"], 7 * seconds / 3600)
        lease.write_text(f"{worker} {time.time() - 100}\n")
        self.assertEqual(self.states()[1], "late")

    def test_the_last_worker_merges_and_nobody_twice(self):
        self.end_of(*[self.worker("--shard", shard) for shard in range(1, SHARDS + 1)])
        self.assert_complete()
        before = (self.folder / "study/study.db").read_bytes()
        self.end_of(self.worker("--merge"), self.worker())
        self.assertEqual(before, (self.folder / "study/study.db").read_bytes())

    def test_a_merge_names_what_is_missing(self):
        self.end_of(self.worker("--shard", 1))
        messages = self.run_capstan("study", "work", "study", "--merge", expect=3).stderr
        self.assertIn("shard-2-of-8.db does not exist", messages)
        self.assertIn("the study has 8 shards", self.run_capstan("study", "work", "study", "--shard", 9, expect=2).stderr)


class Worlds(FolderTest):
    def test_three_workers_share_the_worlds(self):
        study = (self.write("worlds.toml", short_worlds()), "--repetitions", "20")
        self.run_capstan("study", "submit", *study, "--scheduler", "snakemake", "--shards", 5, "--directory", "study")
        self.end_of(*[self.worker() for _ in range(3)])
        self.run_capstan("study", "run", *study, "--db", "complete.db")
        self.assert_same_bits(self.tables("complete.db"), self.tables("study/study.db"))


if __name__ == "__main__":
    unittest.main()
