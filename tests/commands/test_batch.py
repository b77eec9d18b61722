"""Commands run as units: any number of workers share a batch, killed or stopped, and its answers are those of each command by itself."""

import json
import os
import shutil
import signal
import time
import unittest

import fake_scheduler
from capstan_program import CONFIGS, CapstanTest

TRIAL = ("--cases", 2, "--only", "none", "--seed", 4, "--length", "short")  # soon diagnosed; the seed of test_gap_trial.py


class BatchTest(CapstanTest):
    def setUp(self):
        super().setUp()
        (self.folder / "configs").mkdir()
        for k in range(6):
            shutil.copy(CONFIGS / "quick.toml", self.folder / f"configs/c{k}.toml")

    def submit(self, *words, expect=0, **options):
        return self.run_capstan("batch", *words, "--directory", "batch", expect=expect, **options)

    def places(self, *words, **options):
        return self.submit("place", "configs", "--with", "--repetitions 300", *words, **options)

    def worker(self, *words):
        return self.start_capstan("study", "work", "batch", "--progress", "none", *words)

    def end_of(self, *workers):
        for worker in workers:
            _, messages = worker.communicate(timeout=300)
            self.assertEqual(worker.returncode, 0, messages)

    def results(self):
        return json.loads((self.folder / "batch/results.json").read_text())

    def status(self):
        return json.loads(self.run_capstan("study", "status", "batch", "--json").stdout)

    def assert_answers(self, command, *words):
        """Each is what the command prints by itself, byte by byte."""
        results = self.results()
        for number, shard in enumerate(results["shards"], 1):
            alone = self.run_capstan(command, shard["input"], *words, "--json", "--progress", "none").stdout
            self.assertEqual((self.folder / f"batch/shard-{number}-of-{len(results['shards'])}.json").read_text(), alone)
            self.assertEqual(shard["answer"], json.loads(alone))
        self.assertIn("every answer has its hash", self.run_capstan("study", "status", "batch").stdout.replace("\n", " "))


class Batch(BatchTest):
    def test_three_workers_share_the_inputs(self):
        self.places()
        self.end_of(*[self.worker() for _ in range(3)])
        self.assert_answers("place", "--repetitions", 300)
        first = (self.folder / "batch/results.json").read_bytes()
        shutil.rmtree(self.folder / "batch")
        self.places()
        self.end_of(self.worker())
        self.assertEqual((self.folder / "batch/results.json").read_bytes(), first)
        self.assertIn("The batch is complete", self.places().stdout)

    def test_a_killed_worker_leaves_its_unit_to_another(self):
        self.submit("place", "configs", "--with", "--repetitions 3000")
        dead = self.worker()
        end = time.monotonic() + 60
        while not list((self.folder / "batch/leases").glob("*.lease")):
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)
        dead.send_signal(signal.SIGKILL)
        dead.wait()
        for lease in (self.folder / "batch/leases").glob("*.lease"):
            hour_ago = time.time() - 3600
            os.utime(lease, (hour_ago, hour_ago))
        self.end_of(self.worker())
        self.assertEqual([shard["state"] for shard in self.status()["shards"]], ["done"] * 6)
        self.assert_answers("place", "--repetitions", 3000)

    def test_a_damaged_answer_is_computed_again(self):
        self.places()
        for shard in (1, 2, 3, 4, 5):
            self.end_of(self.worker("--shard", shard))
        answer = self.folder / "batch/shard-2-of-6.json"
        right = answer.read_bytes()
        answer.write_bytes(right.replace(b"quick", b"quicj", 1))
        record = self.folder / "batch/leases/shard-3.done"
        record.write_text(record.read_text().replace("AVX", "AWX").replace("SSE", "SSF").replace("EMU", "FMU"))
        worker = self.worker()
        _, messages = worker.communicate(timeout=300)
        self.assertIn("The result of shard 2 is damaged; computing it again", messages)
        self.assertIn("The result of shard 3 is damaged", messages)
        self.assertEqual(answer.read_bytes(), right)
        self.assert_answers("place", "--repetitions", 300)
        results = self.folder / "batch/results.json"
        results.write_bytes(results.read_bytes().replace(b'"seed": 1', b'"seed": 3', 1))
        self.assertIn("does not have its hash", self.run_capstan("study", "status", "batch").stdout.replace("\n", " "))
        for text in ('{"shards": [1], "sha256": "a"}', '{"shards": 1, "sha256": "a"}', '{"shards": [], "sha256": 3}', "["):
            results.write_text(text)
            self.assertIn("is not the merged result", self.run_capstan("study", "status", "batch").stdout.replace("\n", " "), text)

    def test_an_input_that_is_refused_has_the_refusal_as_its_answer(self):
        self.write("configs/c3.toml", "study = 1\n")
        self.places()
        self.end_of(self.worker())
        answers = [shard["answer"] for shard in self.results()["shards"]]
        self.assertEqual([k for k, answer in enumerate(answers) if "refused" in answer], [3])
        self.assertIn("c3.toml:1: study: unknown key", answers[3]["refused"])

    def test_answers_of_different_widths_are_not_joined(self):
        self.places("--simd", "SCALAR")
        self.end_of(self.worker())
        self.assertIn("SIMD SCALAR", self.results()["computed_with"])
        self.assertIn("another batch", self.submit("sensitivity", "configs", expect=2).stderr)

    def test_on_a_scheduler(self):
        environment, calls = fake_scheduler.install(self.folder / "bin")
        self.places("--scheduler", "slurm", "--array-limit", 4, env=environment)
        self.assertEqual([call[2] for call in calls() if call[0] == "sbatch"][:2], ["--array=1-4", "--array=1-2"])
        self.assert_answers("place", "--repetitions", 300)

    def test_what_is_wrong_is_said_at_once(self):
        self.assertIn("did you mean '--repetitions'", self.submit("place", "configs", "--with", "--repetitons 3", expect=2).stderr)
        self.assertIn("keeps the answers itself", self.submit("place", "configs", "--with", "-o x", expect=2).stderr)
        self.assertIn("cannot run as a batch", self.submit("recommend", "configs", expect=2).stderr)
        self.assertIn("holds no recording", self.submit("diagnose", "configs", expect=2).stderr)
        self.assertIn("no trial with sealed labels", self.submit("gap-trial", "configs", expect=2).stderr)
        self.assertIn("does not exist", self.submit("place", "nowhere", expect=2).stderr)
        self.assertFalse((self.folder / "batch").exists())


class Diagnoses(BatchTest):
    def setUp(self):
        super().setUp()
        self.run_capstan("gap-trial", *TRIAL, "--keep", "trial", "--generate-only")

    def test_a_trial_in_units_gives_the_score_of_one_process(self):
        shutil.copytree(self.folder / "trial", self.folder / "alone")
        self.submit("gap-trial", "trial")
        self.end_of(*[self.worker() for _ in range(2)])
        score = self.run_capstan("gap-trial", "--unseal", "trial/labels.json", "--json").stdout
        alone = self.run_capstan("gap-trial", *TRIAL, "--keep", "alone", "--json").stdout
        self.assertEqual(score, alone)
        for number, shard in enumerate(self.results()["shards"], 1):
            answer = (self.folder / f"alone/answers/case00{number}.json").read_text()
            self.assertEqual(shard["answer"], json.loads(answer))

    def test_a_folder_of_recordings(self):
        self.submit("diagnose", "trial")
        self.end_of(*[self.worker() for _ in range(2)])
        self.assert_answers("diagnose")


if __name__ == "__main__":
    unittest.main()
