"""A study on a cluster: a real Slurm with four nodes on this machine, one of which dies in the middle."""

import contextlib
import json
import os
import sqlite3
import subprocess
import unittest

from capstan_program import CONFIGS, CapstanTest
from slurm_cluster import SlurmCluster, why_not
from small_study import short_worlds

STUDY = (CONFIGS / "noise-instants.toml", "--repetitions", "2000")  # some seconds a shard
QUICK = (CONFIGS / "noise-instants.toml", "--repetitions", "20")
WORLDS = ("worlds.toml", "--repetitions", "20")


class WithoutSlurm(CapstanTest):
    NO_SLURM = {**os.environ, "PATH": "/nowhere"}

    def test_says_that_there_is_no_slurm(self):
        done = self.run_capstan("study", "submit", "--slurm", *QUICK, "--directory", "d", expect=2, env=self.NO_SLURM)
        self.assertIn("sbatch and squeue are not on PATH", done.stderr)
        self.assertFalse((self.folder / "d").exists())
        self.assertIn("give --slurm", self.run_capstan("study", "submit", *QUICK, expect=2).stderr)
        self.assertIn("holds no submitted study", self.run_capstan("study", "status", "d", expect=1).stderr)

    def test_dry_run_writes_scripts_that_a_shell_can_run(self):
        """As the tasks of an array would, one after the other."""
        self.write("worlds.toml", short_worlds())
        for study, name in ((QUICK, "it's 100% d"), (WORLDS, "worlds")):
            with self.subTest(name):
                self.run_scripts(study, name)

    def run_scripts(self, study, name):
        done = self.run_capstan("study", "submit", "--slurm", *study, "--shards", 3, "--directory", name, "--dry-run", env=self.NO_SLURM)
        folder = self.folder / name
        self.assertIn("sbatch --parsable --array=1-3 ", done.stdout)
        self.assertIn((folder / "shards.sbatch").read_text(), done.stdout)
        self.assertIn("sbatch --parsable --dependency=afterok:JOB ", done.stdout)
        states = lambda: [shard["state"] for shard in self.status(folder)["shards"]]
        self.assertEqual(states(), ["not_started"] * 3)
        for task in (1, 2, 3):
            self.shell(folder, "shards.sbatch", SLURM_ARRAY_TASK_ID=str(task))
            self.assertEqual(states(), ["done"] * task + ["not_started"] * (3 - task))
        self.shell(folder, "merge.sbatch")
        self.shell(folder, "merge.sbatch")  # as after the failure of a node
        self.assertEqual(self.status(folder)["merge"]["state"], "done")
        self.run_capstan("study", "run", *study, "--db", f"{name}.db")
        self.assert_same_bits(self.tables(f"{name}.db"), self.tables(folder / "study.db"))
        self.assertIn("complete; nothing to submit", self.run_capstan(
            "study", "submit", "--slurm", *study, "--shards", 3, "--directory", folder, "--dry-run").stdout)

    def test_a_queue_that_cannot_be_asked_hides_no_files(self):
        """As where Slurm is installed and not set up."""
        self.run_capstan("study", "submit", "--slurm", *QUICK, "--shards", 3, "--directory", "d", "--dry-run", env=self.NO_SLURM)
        bin_folder = self.folder / "bin"
        bin_folder.mkdir()
        for name in ("sbatch", "squeue"):
            (bin_folder / name).write_text("#!/bin/sh\necho 'fatal: no configuration source' >&2\nexit 1\n")
            (bin_folder / name).chmod(0o755)
        done = self.run_capstan("study", "status", "d", "--json", env={**os.environ, "PATH": f"{bin_folder}:{os.environ['PATH']}"})
        self.assertIn("no configuration source", done.stderr)
        self.assertEqual([shard["state"] for shard in json.loads(done.stdout)["shards"]], ["not_started"] * 3)

    def test_refuses_the_folder_of_something_else(self):
        self.run_capstan("study", "submit", "--slurm", *QUICK, "--shards", 3, "--directory", "d", "--dry-run")
        for words, text in (((*QUICK, "--shards", 4), "holds the study in 3 shards, not 4"),
                            ((*QUICK, "--seed", 5, "--shards", 3), "holds a study with another configuration"),
                            ((*QUICK, "--shards", 29), "there are only 28 parts")):
            done = self.run_capstan("study", "submit", "--slurm", *words, "--directory", "d", "--dry-run", expect=2)
            self.assertIn(text, done.stderr)
        (self.folder / "mine").mkdir()
        (self.folder / "mine/thesis.txt").write_text("years of work")
        self.assertIn("holds other files", self.run_capstan("study", "submit", "--slurm", *QUICK, "--directory", "mine",
                                                            "--dry-run", expect=2).stderr)

    def status(self, folder):
        return json.loads(self.run_capstan("study", "status", folder, "--json", env=self.NO_SLURM).stdout)

    def shell(self, folder, script, **environment):
        done = subprocess.run(["sh", script], cwd=folder, env={**os.environ, **environment}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)


@unittest.skipIf(why_not(), why_not())
class OnACluster(CapstanTest):
    def setUp(self):
        super().setUp()
        self.cluster = SlurmCluster(self.folder / "slurm")
        self.addCleanup(self.cluster.stop)

    def capstan(self, *words, **options):
        return self.run_capstan(*words, env=self.cluster.environment, **options).stdout

    def submit(self, *study, shards=8):
        return self.capstan("study", "submit", "--slurm", *study, "--shards", shards, "--directory", "study")

    def status(self):
        return json.loads(self.capstan("study", "status", "study", "--json"))

    def wait_for_the_merge(self):
        self.cluster.wait("the merged study", lambda: (self.folder / "study/study.db").exists())

    def units_done(self, number, shards=8):
        file = self.folder / f"study/shard-{number}-of-{shards}.db"
        try:
            with contextlib.closing(sqlite3.connect(f"file:{file}?mode=ro", uri=True)) as connection:
                return connection.execute("SELECT sum(done) FROM work_unit").fetchone()[0] or 0
        except sqlite3.Error:
            return 0

    def test_a_node_dies_in_the_middle(self):
        self.run_capstan("study", "run", *STUDY, "--db", "complete.db")
        self.assertIn("Submitted shards 1-8 of 8", self.submit(*STUDY))
        victim = {}

        def a_task_is_half_way():
            for line in self.cluster.slurm("squeue", "-h", "-r", "-t", "R", "-o", "%K %N").splitlines():
                index, node = line.split()
                if index.isdigit() and 0 < self.units_done(int(index)) < 6:
                    victim.update(shard=int(index), node=node)
                    return True
            return False

        self.cluster.wait("a task that has stored some of its units", a_task_is_half_way)
        self.cluster.kill_node(victim["node"])
        self.assertLess(self.units_done(victim["shard"]), 6)  # it had not finished
        self.assertNotIn("done", self.status()["merge"]["state"])
        self.wait_for_the_merge()
        self.assertIn("Restarts=1", self.cluster.slurm("scontrol", "show", "job"))
        self.assertIn("down", self.cluster.slurm("sinfo", "-h", "-n", victim["node"], "-o", "%t"))
        status = self.status()
        self.assertEqual({shard["state"] for shard in status["shards"]}, {"done"})
        self.assertEqual(status["merge"]["state"], "done")
        self.assert_same_bits(self.tables("complete.db"), self.tables("study/study.db"))

    def test_submitted_again_only_what_is_missing_runs(self):
        self.run_capstan("study", "run", *QUICK, "--db", "complete.db")
        self.capstan("study", "submit", "--slurm", *QUICK, "--shards", 5, "--directory", "study", "--dry-run")
        self.run_capstan("study", "run", *QUICK, "--shard", "2/5", "--db", "study/shard-2-of-5.db")
        text = "not a database, but long enough to be looked at" * 40
        self.write("study/shard-4-of-5.db", text)  # this one fails
        self.assertIn("Submitted shards 1,3-5 of 5", self.submit(*QUICK, shards=5))
        self.cluster.wait("all that can be done", lambda: not self.cluster.slurm("squeue", "-h"))
        states = [shard["state"] for shard in self.status()["shards"]]
        self.assertEqual(states, ["done", "done", "done", "failed", "done"])
        self.assertEqual(self.status()["merge"]["state"], "not_started")
        self.assertIn("study submit --scheduler slurm", self.capstan("study", "status", "study"))
        self.assertIn("not a database", self.status()["shards"][3]["message"])  # the last line of its log
        self.assertEqual((self.folder / "study/shard-4-of-5.db").read_text(), text)

        (self.folder / "study/shard-4-of-5.db").unlink()
        self.assertIn("Submitted shards 4 of 5", self.submit(*QUICK, shards=5))
        self.wait_for_the_merge()
        self.assert_same_bits(self.tables("complete.db"), self.tables("study/study.db"))
        self.assertIn("nothing to submit", self.submit(*QUICK, shards=5))

    def test_more_shards_than_an_array_may_have(self):
        """Three arrays of at most ten, four tasks at a time in each; the merge waits for all."""
        self.run_capstan("study", "run", *QUICK, "--db", "complete.db")
        text = self.capstan("study", "submit", "--slurm", *QUICK, "--shards", 28, "--array-limit", 10, "--throttle", 4,
                            "--directory", "study")
        self.assertRegex(text, r"Submitted shards 1-28 of 28 as jobs \d+ to \d+")
        self.assertNotIn("Submitted", self.capstan("study", "submit", "--slurm", *QUICK, "--shards", 28, "--array-limit", 10,
                                                   "--directory", "study"))
        self.wait_for_the_merge()
        self.assert_same_bits(self.tables("complete.db"), self.tables("study/study.db"))

    def test_submitted_twice_at_once_nothing_runs_twice(self):
        self.submit(*STUDY, shards=4)
        again = self.submit(*STUDY, shards=4)
        self.assertNotIn("Submitted", again)
        self.assertEqual(len(self.cluster.slurm("squeue", "-h", "-r").splitlines()), 5)


if __name__ == "__main__":
    unittest.main()
