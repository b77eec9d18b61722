"""Every shipped configuration runs, and every answer can be read: by people, and by programs."""

import csv
import io
import json
import unittest

from capstan_program import CONFIGS, CapstanTest
from small_study import short_worlds


class Configurations(CapstanTest):
    def test_every_configuration_runs(self):
        configs = sorted(path for path in CONFIGS.glob("*.toml") if not path.name.startswith("bench-"))
        self.assertGreaterEqual(len(configs), 4)
        for config in configs:
            with self.subTest(config.name):
                check = json.loads(self.run_capstan("config", "check", config, "--json").stdout)
                if check["studies"] > 1:  # too long for here; test_shards.py runs a shard of it
                    continue
                db = config.stem + ".db"
                if "worlds" in check:
                    config = self.write(config.name, short_worlds(config.stem))
                self.run_capstan("study", "run", config, "--db", db, "--repetitions", 20)
                tables = self.tables(db)
                if tables["world_candidate"]:
                    self.assertEqual(len(tables["world_recommendation"]), 1)
                    continue
                self.assertEqual(len(tables["cell"]), check["cells"])
                self.assertEqual(len(tables["scenario"]), check["scenarios"])

    def test_printed_default_runs(self):
        self.run_capstan("config", "default", "-o", "my.toml")
        self.run_capstan("study", "run", "my.toml", "--repetitions", 10)


class Truth(CapstanTest):
    """A study whose true cable is not the one that the estimators believe in."""

    def test_says_whether_the_advice_changes_and_keeps_both_studies(self):
        self.write("bend.toml", "[truth]\n[truth.local_bend_cable_A]\nangle_rad = 1.5\nmiddle_m = 1.1\n")
        run = self.run_capstan("study", "run", CONFIGS / "paper.toml", "--repetitions", 50, "--truth", "bend.toml",
                               "--db", "both.db", "--json")
        advice = json.loads(run.stdout)
        self.assertEqual({each["regime"] for each in advice}, {"mass", "partial_proximal"})
        for each in advice:
            # The model does not know what it is in for, and nobody does better than the best.
            self.assertGreater(each["model"]["true_error_N"], each["model"]["expected_error_N"])
            self.assertGreaterEqual(each["model"]["true_error_N"], each["truth"]["true_error_N"] - 1e-12)
        names = [study["name"] for study in json.loads(self.run_capstan("study", "list", "--db", "both.db",
                                                                         "--json").stdout)]
        self.assertEqual(sorted(names), ["paper", "paper, truth bend"])

    def test_the_model_as_truth_changes_nothing(self):
        self.write("same.toml", "[truth]\nfriction_ratio = 1.0\n")
        run = self.run_capstan("study", "run", CONFIGS / "quick.toml", "--truth", "same.toml", "--json")
        for each in json.loads(run.stdout):
            self.assertTrue(each["advice_stays"])
            self.assertEqual(each["model"]["true_error_N"], each["model"]["expected_error_N"])


class Answers(CapstanTest):
    def setUp(self):
        super().setUp()
        self.told = self.run_capstan("study", "run", CONFIGS / "quick.toml", "--stats")

    def test_words_on_stdout_progress_on_stderr(self):
        self.assertIn("use ", self.told.stdout)
        self.assertNotIn("units", self.told.stdout)
        self.assertIn("4 of 4 units", self.told.stderr)
        self.assertIn("Processor time", self.told.stderr)
        self.assertEqual(self.told.stdout, self.run_capstan("recommend").stdout)

    def test_json_everywhere_a_program_may_read(self):
        run = self.run_capstan("study", "run", CONFIGS / "quick.toml", "--json", "--progress", "json")
        answer = json.loads(run.stdout)
        self.assertEqual(answer["status"], "complete")
        first = answer["recommendations"][0]
        self.assertEqual(first["sensor_count"], len(first["nodes"]))
        self.assertLess(first["interval_95_N"][0], first["error_N"])
        events = [json.loads(line) for line in run.stderr.splitlines()]
        self.assertEqual(events[-2]["done"], events[-2]["total"])
        self.assertEqual(events[-1]["event"], "complete")
        for words in (("study", "list"), ("study", "show"), ("study", "replay"), ("recommend",), ("report",),
                      ("query", "SELECT * FROM cell"), ("config", "check", CONFIGS / "quick.toml")):
            json.loads(self.run_capstan(*words, "--json").stdout)

    def test_no_progress_when_asked(self):
        self.assertEqual(self.run_capstan("study", "run", CONFIGS / "quick.toml", "--progress", "none").stderr, "")

    def test_query_formats_agree(self):
        sql = "SELECT cell_id, method, mean_abs_error_N, NULL AS missing FROM cell ORDER BY cell_id"
        rows = json.loads(self.run_capstan("query", sql, "--format", "json").stdout)
        table = list(csv.DictReader(io.StringIO(self.run_capstan("query", sql, "--format", "csv").stdout)))
        self.assertEqual(len(rows), len(table))
        for row, line in zip(rows, table):
            self.assertEqual(row["mean_abs_error_N"], float(line["mean_abs_error_N"]))
            self.assertEqual((row["missing"], line["missing"]), (None, ""))
        self.assertIn("CREATE TABLE cell", self.run_capstan("query", "--schema").stdout)

    def test_reports(self):
        for name, begin in (("r.html", "<!"), ("r.md", "#"), ("r.json", "{"), ("r.csv", "")):
            self.run_capstan("report", "-o", name)
            self.assertTrue((self.folder / name).read_text().lstrip().startswith(begin), name)
        self.assertEqual(sorted(p.name for p in self.folder.glob("r.*")), ["r.csv", "r.html", "r.json", "r.md"])

    def test_simulate(self):
        self.run_capstan("simulate", CONFIGS / "quick.toml", "-o", "motion.csv")
        rows = list(csv.DictReader(io.StringIO((self.folder / "motion.csv").read_text())))
        self.assertEqual(len(rows), 101)
        self.assertEqual(float(rows[0]["tension_1_N"]), 10.0)
        self.assertEqual(rows[15]["regime"], "mass")
        self.assertIn("displacement_7_m", rows[0])

    def test_study_life(self):
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--seed", 2)
        self.assertEqual(len(json.loads(self.run_capstan("study", "list", "--json").stdout)), 2)
        self.assertIn("seed 2", self.run_capstan("study", "show").stdout)
        self.assertIn("seed 1", self.run_capstan("study", "show", "1").stdout)
        self.assertIn("complete already", self.run_capstan("study", "resume").stderr)
        self.run_capstan("study", "delete", "1")
        self.run_capstan("study", "show", "1", expect=3)
        self.run_capstan("study", "show", "2")

    def test_another_worthwhile_gain_changes_the_recommendation(self):
        def count(gain):
            answer = self.run_capstan("recommend", "--json", "--worthwhile-gain", gain).stdout
            return json.loads(answer)["recommendations"][0]["sensor_count"]
        self.assertEqual(count(100), 1)
        self.assertGreater(count(0), 1)


if __name__ == "__main__":
    unittest.main()
