"""A study run in shards, on any number of machines, is the study run at once: the same bits in every table."""

import json
import resource
import shutil
import signal
import sqlite3
import unittest

from capstan_program import CONFIGS, CapstanTest

# 28 parts: four instants at seven noise levels.
STUDY = (CONFIGS / "noise-instants.toml", "--repetitions", "100")

SWEEP = """
name = "small sweep"
repetitions = 20
[motion.proximal]
amplitude_m = 0.015
[[regime]]
name = "mass"
samples = [112]
duty_fraction = 0.5
[[regime]]
name = "partial_proximal"
samples = [6]
duty_fraction = 0.5
[layouts]
families = "all"
counts = [1, 3]
[sweep]
friction_ratio = [0.5, 1]
stiffness_ratio = [1, 2]
segments = [6, 10]
instants_per_regime = 2
"""


class Shards(CapstanTest):
    def run_shard(self, number, count, db, *words, study=STUDY, expect=0):
        return self.run_capstan("study", "run", *study, "--shard", f"{number}/{count}", "--db", db, *words, expect=expect)

    def run_shards(self, count, study=STUDY):
        names = [f"shard-{number}-of-{count}.db" for number in range(1, count + 1)]
        for number, name in enumerate(names, 1):
            self.run_shard(number, count, name, study=study)
        return names

    def test_one_three_and_eight_shards_have_the_bits_of_one_run(self):
        self.run_capstan("study", "run", *STUDY, "--db", "complete.db")
        expected = self.tables("complete.db")
        for count in (1, 3, 8):
            names = self.run_shards(count)
            self.run_capstan("study", "merge", "--db", f"merged{count}.db", *reversed(names))
            self.assert_same_bits(expected, self.tables(f"merged{count}.db"))
        self.assertEqual(self.run_capstan("recommend", "--db", "complete.db").stdout,
                         self.run_capstan("recommend", "--db", "merged3.db").stdout)

    def test_more_shards_than_a_process_may_have_files_open(self):
        self.run_capstan("study", "run", *STUDY, "--db", "complete.db")
        self.run_capstan("study", "merge", "--db", "merged.db", *self.run_shards(28),
                         preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (50, 50)))
        self.assert_same_bits(self.tables("complete.db"), self.tables("merged.db"))

    def test_every_part_belongs_to_exactly_one_shard(self):
        done = []
        for name in self.run_shards(3):
            connection = sqlite3.connect(self.folder / name)
            self.addCleanup(connection.close)
            done.append({row[0] for row in connection.execute("SELECT unit_index FROM work_unit WHERE done")})
        self.assertEqual(sum(map(len, done)), 56)
        self.assertEqual(set.union(*done), set(range(56)))

    def test_a_killed_shard_goes_on_to_the_same_bits(self):
        self.run_capstan("study", "run", *STUDY, "--db", "complete.db")
        names = self.run_shards(2)
        for units in (1, 3, 14, 20):
            process = self.start_capstan("study", "run", *STUDY, "--shard", "1/2", "--db", f"killed{units}.db",
                                         "--progress", "json")
            for line in process.stderr:
                if f'"done":{units},' in line:
                    break
            process.send_signal(signal.SIGKILL)
            process.communicate()
            self.run_shard(1, 2, f"killed{units}.db")
            self.run_capstan("study", "merge", "--db", f"merged{units}.db", f"killed{units}.db", names[1])
            self.assert_same_bits(self.tables("complete.db"), self.tables(f"merged{units}.db"))

    def test_two_programs_in_one_shard_do_no_harm(self):
        """As after a node that was only thought dead."""
        both = [self.start_capstan("study", "run", *STUDY, "--shard", "1/2", "--db", "twice.db") for _ in range(2)]
        for process in both:
            _, messages = process.communicate()
            self.assertEqual(process.returncode, 0, messages)
        self.run_shard(1, 2, "once.db")
        self.assert_same_bits(self.tables("once.db"), self.tables("twice.db"))

    def test_a_finished_shard_is_left_as_it_is(self):
        self.run_shard(1, 4, "a.db")
        before = (self.folder / "a.db").read_bytes()
        self.run_shard(1, 4, "a.db")
        self.assertEqual(before, (self.folder / "a.db").read_bytes())

    def test_a_sweep_in_shards_has_the_bits_of_one_run(self):
        study = (self.write("sweep.toml", SWEEP),)
        self.run_capstan("study", "run", *study, "--db", "complete.db")
        listed = json.loads(self.run_capstan("study", "list", "--json", "--db", "complete.db").stdout)
        self.assertEqual(len(listed), 8)
        self.assertEqual(len({one["name"] for one in listed}), 8)
        self.assertEqual({one["status"] for one in listed}, {"complete"})
        names = self.run_shards(5, study)
        self.run_capstan("study", "merge", "--db", "merged.db", *names)
        self.assert_same_bits(self.tables("complete.db"), self.tables("merged.db"))

    def test_a_killed_sweep_is_resumed_completely(self):
        study = (self.write("sweep.toml", SWEEP),)
        self.run_capstan("study", "run", *study, "--db", "complete.db")
        process = self.start_capstan("study", "run", *study, "--db", "killed.db", "--progress", "json")
        for line in process.stderr:
            if '"done":13,' in line:
                break
        process.send_signal(signal.SIGKILL)
        process.communicate()
        self.run_capstan("study", "resume", "all", "--db", "killed.db")
        self.assert_same_bits(self.tables("complete.db"), self.tables("killed.db"))

    def test_a_study_of_a_sweep_is_a_study_of_its_own(self):
        self.run_capstan("study", "run", self.write("sweep.toml", SWEEP), "--db", "sweep.db")
        self.run_capstan("study", "show", "5", "--config", "--db", "sweep.db", "-o", "five.toml")
        self.run_capstan("study", "run", "five.toml", "--db", "five.db")
        conclusions = [json.loads(self.run_capstan("recommend", study, "--json", "--db", db).stdout)["recommendations"]
                       for study, db in (("5", "sweep.db"), ("1", "five.db"))]
        self.assertEqual(*conclusions)


class Atlas(CapstanTest):
    def test_a_shard_of_the_atlas_runs(self):
        check = json.loads(self.run_capstan("config", "check", CONFIGS / "atlas.toml", "--json").stdout)
        self.assertGreater(check["studies"], 50)
        count = check["scenarios"] * check["noise_levels"]
        self.run_capstan("study", "run", CONFIGS / "atlas.toml", "--repetitions", 20, "--shard", f"{count // 2}/{count // 8}",
                         "--db", "x.db", expect=2)
        self.run_capstan("study", "run", CONFIGS / "atlas.toml", "--repetitions", 20, "--shard", f"7/{count // 8}",
                         "--db", "atlas.db")
        connection = sqlite3.connect(self.folder / "atlas.db")
        self.addCleanup(connection.close)
        self.assertEqual(connection.execute("SELECT count(*) FROM study").fetchone()[0], check["studies"])
        self.assertEqual(connection.execute("SELECT sum(done) FROM work_unit").fetchone()[0], 2 * 8)


class MergeRefuses(CapstanTest):
    STUDY = (CONFIGS / "quick.toml", "--repetitions", "20")  # two parts

    def setUp(self):
        super().setUp()
        for number in (1, 2):
            self.shard(f"{number}.db", f"{number}/2")

    def shard(self, db, shard, *words):
        self.run_capstan("study", "run", *self.STUDY, "--shard", shard, "--db", db, *words)

    def files(self):
        """Without what a reader may leave beside a database."""
        return {path.name for path in self.folder.iterdir() if not path.name.endswith(("-wal", "-shm"))}

    def refusal(self, *shards):
        before = self.files()
        messages = self.run_capstan("study", "merge", "--db", "merged.db", *shards, expect=3).stderr
        self.assertEqual(self.files(), before)
        return messages

    def test_missing_shards(self):
        self.assertIn("shard 2 of 2 is missing; name its file, or run it: capstan study run CONFIG --shard 2/2",
                      self.refusal("1.db"))
        self.assertIn("nothere.db does not exist", self.refusal("1.db", "nothere.db"))

    def test_doubled_shards(self):
        shutil.copy(self.folder / "2.db", self.folder / "copy.db")
        self.assertIn("copy.db is shard 2 of 2, and so is 2.db; leave one out", self.refusal("1.db", "2.db", "copy.db"))

    def test_shards_of_another_count(self):
        self.shard("complete.db", "1/1")
        self.assertIn("complete.db is shard 1 of 1, but 1.db is one of 2", self.refusal("1.db", "2.db", "complete.db"))

    def test_shards_of_another_study(self):
        self.shard("seed.db", "2/2", "--seed", "9")
        self.assertIn("seed.db belongs to another study than 1.db: its seed is 9, not 1", self.refusal("1.db", "seed.db"))
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--repetitions", 30, "--shard", "2/2", "--db", "more.db")
        self.assertIn("its number of repetitions is 30, not 20", self.refusal("1.db", "more.db"))

    def test_unfinished_shards(self):
        connection = sqlite3.connect(self.folder / "2.db")
        connection.execute("PRAGMA foreign_keys = ON")
        connection.execute("UPDATE work_unit SET done = 0 WHERE unit_index = 3")
        connection.execute("DELETE FROM sensor_weight WHERE scenario_id = 2")
        connection.execute("DELETE FROM cell WHERE scenario_id = 2")
        connection.execute("DELETE FROM known_direction_bound WHERE scenario_id = 2")
        connection.commit()
        connection.close()
        message = self.refusal("1.db", "2.db")
        self.assertIn("2.db is unfinished: 1 of its 2 units are done; go on with: capstan study run CONFIG "
                      "--shard 2/2 --db 2.db", message)
        self.shard("2.db", "2/2")  # what the message says
        self.run_capstan("study", "merge", "--db", "merged.db", "1.db", "2.db")

    def test_files_that_are_no_shards(self):
        self.run_capstan("study", "run", *self.STUDY, "--db", "study.db")
        self.write("text.db", "not a database, but long enough to be looked at" * 40)
        message = self.refusal("1.db", "study.db", "text.db")
        self.assertIn("study.db is not the file of a shard", message)
        self.assertIn("text.db", message)
        self.assertIn("shard 2 of 2 is missing", message)

    def test_a_result_that_is_there(self):
        self.write("there.db", "mine")
        self.assertIn("there.db exists already",
                      self.run_capstan("study", "merge", "--db", "there.db", "1.db", "2.db", expect=3).stderr)
        self.assertEqual((self.folder / "there.db").read_text(), "mine")

    def test_shard_files_are_no_place_for_other_work(self):
        for words in (("study", "run", *self.STUDY), ("study", "resume")):
            self.assertIn("1.db is the file of shard 1 of 2", self.run_capstan(*words, "--db", "1.db", expect=2).stderr)
        self.run_capstan("study", "run", *self.STUDY, "--db", "study.db")
        for db, text in (("study.db", "holds complete studies"), ("2.db", "is shard 2 of 2, not shard 1 of 2")):
            self.assertIn(text, self.run_capstan("study", "run", *self.STUDY, "--shard", "1/2", "--db", db, expect=3).stderr)
        message = self.run_capstan("study", "run", *self.STUDY, "--seed", "4", "--shard", "1/2", "--db", "1.db", expect=3)
        self.assertIn("1.db is a shard of another study: its seed is 1, not 4", message.stderr)

    def test_impossible_shards(self):
        for text in ("0/2", "3/2", "1", "1/2/3", "a/b", "-1/2", "1/0"):
            message = self.run_capstan("study", "run", *self.STUDY, f"--shard={text}", "--db", "x.db", expect=2).stderr
            self.assertIn("must be I/N", message)
        self.assertIn("there are only 2 parts",
                      self.run_capstan("study", "run", *self.STUDY, "--shard", "1/3", "--db", "x.db", expect=2).stderr)
        self.assertFalse((self.folder / "x.db").exists())


class Plan(CapstanTest):
    def test_counts_are_those_of_the_study(self):
        self.run_capstan("study", "run", *STUDY, "--db", "complete.db")
        plan = json.loads(self.run_capstan("study", "plan", *STUDY, "--json", "--seconds", "0.2", "--shards", 8).stdout)
        tables = self.tables("complete.db")
        self.assertEqual(plan["cells"], len(tables["cell"]))
        self.assertEqual(plan["parts"], 28)
        self.assertEqual(plan["readings"], 28 * 100 * 11)
        self.assertGreater(plan["core_hours"], plan["one_run_core_hours"])
        self.assertGreater(plan["one_run_core_hours"], 0)

    def test_predicted_intervals_are_those_of_the_study(self):
        """The pilot sees all parts, a quarter of the repetitions: widths agree to the noise of a standard error."""
        config = (CONFIGS / "quick.toml", "--repetitions", "800")
        self.run_capstan("study", "run", *config, "--db", "complete.db")
        plan = json.loads(self.run_capstan("study", "plan", *config, "--json", "--seconds", "1000").stdout)
        connection = sqlite3.connect(self.folder / "complete.db")
        self.addCleanup(connection.close)
        widths = sorted(row[0] for row in connection.execute("SELECT (interval_high_N - interval_low_N) / 2 FROM cell"))
        self.assertEqual(plan["pilot_parts"], plan["parts"])
        self.assertAlmostEqual(plan["median_half_width_N"] / widths[len(widths) // 2], 1, delta=0.15)

    def test_nothing_is_written(self):
        self.run_capstan("study", "plan", *STUDY, "--seconds", "0")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_too_many_shards(self):
        self.assertIn("there are only 28 parts", self.run_capstan("study", "plan", *STUDY, "--shards", 29, expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
