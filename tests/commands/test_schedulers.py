"""A study on any cluster: arrays within the limits of each scheduler, ssh, GNU parallel and Snakemake; always the bits of one
run. Slurm itself is in test_slurm.py; here the schedulers are programs that only do what they are told."""

import json
import shutil
import stat
import subprocess
import time
import unittest

import fake_scheduler
from capstan_program import CONFIGS, CapstanTest

STUDY = (CONFIGS / "noise-instants.toml", "--repetitions", "20")  # 28 parts
WORLDS = CONFIGS / "wrist-exosuit.toml"


class StudyFolder(CapstanTest):
    def submit(self, environment, *words, expect=0):
        return self.run_capstan("study", "submit", *STUDY, "--directory", "study", *words, env=environment, expect=expect)

    def status(self, environment=None):
        return json.loads(self.run_capstan("study", "status", "study", "--json", env=environment).stdout)

    def assert_complete(self):
        if not (self.folder / "complete.db").exists():
            self.run_capstan("study", "run", *STUDY, "--db", "complete.db")
        self.assert_same_bits(self.tables("complete.db"), self.tables("study/study.db"))


class OnAScheduler(StudyFolder):
    def run_on(self, scheduler, **how):
        """Submits 25 shards in arrays of ten; the calls that submit, without the folder's name."""
        environment, calls = fake_scheduler.install(self.folder / f"bin-{scheduler}", **how)
        self.submit(environment, "--scheduler", scheduler, "--shards", 25, "--array-limit", 10, "--throttle", 4)
        return [[word.replace(str(self.folder / "study"), "DIR") for word in call] for call in calls()
                if call[0] in ("sbatch", "qsub", "bsub")]

    def test_slurm_gets_arrays_of_lists(self):
        calls = self.run_on("slurm")
        self.assertEqual([call[2] for call in calls], ["--array=1-10%4", "--array=1-10%4", "--array=1-5%4", calls[3][2]])
        self.assertRegex(calls[3][2], r"--dependency=afterok:\d+:\d+:\d+")
        self.assertEqual([call[-1] for call in calls[:3]], ["DIR/shards.sbatch", "10", "20"])
        self.assert_complete()

    def test_grid_engine(self):
        calls = self.run_on("gridengine")
        self.assertEqual([call[1:6] for call in calls[:3]], [["-terse", "-t", "1-10", "-tc", "4"]] * 2 + [["-terse", "-t", "1-5", "-tc", "4"]])
        self.assertEqual([call[-2:] for call in calls[:3]], [["DIR/shards.sh", str(offset)] for offset in (0, 10, 20)])
        self.assertRegex(" ".join(calls[3]), r"^qsub -terse -hold_jid \d+,\d+,\d+ DIR/merge.sh$")
        self.assertIn("#$ -wd ", (self.folder / "study/shards.sh").read_text())
        self.assert_complete()

    def test_pbs(self):
        calls = self.run_on("pbs", is_pbs=True)
        self.assertEqual(calls[1], ["qsub", "-J", "1-10%4", "-v", "CAPSTAN_OFFSET=10", "DIR/shards.sh"])
        self.assertRegex(" ".join(calls[3]), r"^qsub -W depend=afterok:\d+\[\]\.server:\d+\[\]\.server:\d+\[\]\.server DIR/merge.sh$")
        self.assert_complete()

    def test_lsf(self):
        calls = self.run_on("lsf")
        self.assertRegex(calls[1][2], r"^capstan-[0-9a-f]{8}\+10\[1-10\]%4$")
        self.assertEqual(calls[1][-3:], ["sh", "DIR/shards.sh", "10"])
        self.assertRegex(" ".join(calls[3]), r" -w done\(\d+\) && done\(\d+\) && done\(\d+\) sh DIR/merge.sh$")
        self.assert_complete()

    def test_a_single_task_is_no_array_of_pbs(self):
        """PBS refuses an array of one."""
        environment, calls = fake_scheduler.install(self.folder / "bin", is_pbs=True)
        self.submit(environment, "--scheduler", "pbs", "--shards", 11, "--array-limit", 10)
        self.assertEqual(calls()[-2][1:3], ["-v", "CAPSTAN_OFFSET=10,CAPSTAN_TASK=1"])
        self.assert_complete()

    def test_only_what_is_missing_is_submitted_again(self):
        environment, calls = fake_scheduler.install(self.folder / "bin", runs=False)
        words = ("--scheduler", "gridengine", "--shards", 6)
        self.submit(environment, *words)
        first = len(calls())
        (self.folder / "bin/in_queue").touch()
        self.assertIn("In the queue already: 6 shards", self.submit(environment, *words).stdout)
        self.assertEqual([shard["state"] for shard in self.status(environment)["shards"]], ["waiting"] * 6)
        self.assertNotIn("qsub", [call[0] for call in calls()[first:]])
        (self.folder / "bin/in_queue").unlink()
        for shard in (2, 3):
            self.run_capstan("study", "work", "study", "--shard", shard)
        done = self.submit(environment, *words).stdout
        self.assertIn("Submitted shards 1,4-6 of 6 as jobs", done)
        self.assertEqual([call[3] for call in calls() if call[0] == "qsub"][-3:-1], ["1", "4-6"])

    def test_a_hundred_thousand_tasks_in_a_hundred_calls(self):
        environment, calls = fake_scheduler.install(self.folder / "bin", runs=False)
        begin = time.monotonic()
        self.run_capstan("study", "submit", WORLDS, "--repetitions", 50000, "--slurm", "--shards", 100000,
                         "--throttle", 500, "--directory", "large", env=environment)
        seconds = time.monotonic() - begin
        submissions = [call for call in calls() if call[0] == "sbatch"]
        self.assertEqual(len(submissions), 101)
        self.assertLess(len(calls()), 110)
        self.assertEqual(submissions[99][2:4][0], "--array=1-1000%500")
        self.assertEqual(submissions[99][-1], "99000")
        print(f"100,000 tasks in {len(calls())} calls and {seconds:.1f} s")

    def test_says_which_programs_are_missing(self):
        for scheduler, text in (("gridengine", "qsub and qstat are not on PATH, so there is no Grid Engine here"),
                                ("lsf", "bsub and bjobs are not on PATH"), ("ssh", "needs --hosts")):
            done = self.submit({"PATH": "/nowhere"}, "--scheduler", scheduler, "--shards", 3, expect=2)
            self.assertIn(text, done.stderr)
        self.assertFalse((self.folder / "study").exists())

    def test_all_shards_run_at_the_stated_width(self):
        environment, _ = fake_scheduler.install(self.folder / "bin")
        self.submit(environment, "--slurm", "--shards", 3, "--simd", "SCALAR")
        self.run_capstan("study", "run", *STUDY, "--db", "complete.db", "--simd", "SCALAR")
        self.assert_complete()


class WithoutAQueue(StudyFolder):
    def test_ssh(self):
        """Each host is a shell of this machine."""
        fake = self.folder / "bin/ssh"
        fake.parent.mkdir()
        fake.write_text('#!/bin/sh\nshift 2\necho "$1" >> "$0.hosts"\nshift\nexec sh -c "$*"\n')
        fake.chmod(fake.stat().st_mode | stat.S_IXUSR)
        environment = {"PATH": f"{fake.parent}:/usr/bin:/bin"}
        done = self.submit(environment, "--scheduler", "ssh", "--hosts", "n1,n2,n3,n4", "--shards", 12)
        self.assertEqual(done.stdout.count("Started: ssh"), 4)
        self.wait_for_the_result()
        self.assertEqual((self.folder / "bin/ssh.hosts").read_text().split(), ["n1", "n2", "n3", "n4"])
        self.assert_complete()

    def wait_for_the_result(self):
        end = time.monotonic() + 120
        while not (self.folder / "study/study.db").exists():
            self.assertLess(time.monotonic(), end, "".join(path.read_text() for path in (self.folder / "study/logs").iterdir()))
            time.sleep(0.2)

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_gnu_parallel(self):
        done = self.submit(None, "--scheduler", "parallel", "--shards", 6, "--throttle", 2)
        script = done.stdout.split("Run it with: sh ")[1].split("\n")[0]
        self.run_program("sh", script)
        self.run_program("sh", script)  # again: nothing is left
        self.assert_complete()

    @unittest.skipUnless(shutil.which("snakemake"), "Snakemake is not installed")
    def test_snakemake(self):
        self.submit(None, "--scheduler", "snakemake", "--shards", 6)
        self.run_program("snakemake", "--directory", "study", "--snakefile", "study/Snakefile", "--cores", "2")
        self.assert_complete()

    def test_the_workflow_has_two_rules(self):
        self.submit(None, "--scheduler", "snakemake", "--shards", 6)
        text = (self.folder / "study/Snakefile").read_text()
        self.assertIn('input: expand("leases/shard-{shard}.done", shard=range(1, 6 + 1))', text)
        call = json.loads(text.split("rule shard:")[1].split("shell: ")[1]).replace("{wildcards.shard}", "{0}").replace("{log}", "{1}")
        for shard in range(1, 7):
            subprocess.run(call.format(shard, f"logs/shard-{shard}.log"), shell=True, check=True, cwd=self.folder / "study")
            self.assertTrue((self.folder / f"study/leases/shard-{shard}.done").exists())
        self.assert_complete()


if __name__ == "__main__":
    unittest.main()
