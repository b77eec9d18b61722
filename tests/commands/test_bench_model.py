"""A diagnosis is a model: saved by `capstan diagnose --save`, judged on other runs by `capstan simulate --model`."""

import csv
import json
import math
import unittest

from capstan_program import CONFIGS, CapstanTest

PAIR = CONFIGS / "recordings" / "viscous-pair.csv"  # two runs
DRIVE = CONFIGS / "recordings" / "lumped-drive.csv"


class BenchModel(CapstanTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.saved = {}

    def saved_model(self, recording, fitted):
        """The text of the model and the JSON of the diagnosis; each diagnosis runs once."""
        if (recording, fitted) not in self.saved:
            told = self.run_capstan("diagnose", recording, "--fit", fitted, "--save", "new.toml", "--json", "--progress",
                                    "none").stdout
            self.saved[recording, fitted] = (self.folder / "new.toml").read_text(), json.loads(told)
        text, told = self.saved[recording, fitted]
        self.write("model.toml", text)
        return text, told

    def test_the_errors_are_those_that_the_diagnosis_reports_of_runs_held_out(self):
        _, told = self.saved_model(PAIR, "1")
        judged = json.loads(self.run_capstan("simulate", PAIR, "--model", "model.toml", "--runs", "2", "--json").stdout)
        models = {(each["channel"], each["model"]): each["rms_held_out"] for each in told["comparison"]["models"]}
        self.assertEqual({row["run"] for row in judged["runs"]}, {2})
        for row in judged["channels"]:
            self.assertFalse(row["fitted"])
            for name, value in (("nominal", row["rms_nominal"]), ("corrected", row["rms_model"]),
                                ("corrected_with_law", row["rms_with_law"] or row["rms_model"])):
                # The same numbers drive the same model: not a digit differs.
                self.assertEqual(value, models[row["channel"], name], (row["channel"], name))

    def test_the_model_is_better_than_the_nominal_bench_on_runs_it_never_saw(self):
        self.saved_model(PAIR, "1")
        judged = json.loads(self.run_capstan("simulate", PAIR, "--model", "model.toml", "--json").stdout)
        unseen = [row for row in judged["channels"] if not row["fitted"]]
        self.assertEqual({row["channel"] for row in unseen}, {"motor_angle", "load_torque"})
        for row in unseen:
            self.assertLess(row["rms_model"], row["rms_nominal"], row)

    def test_predicted_and_measured_channels_stand_side_by_side(self):
        self.saved_model(PAIR, "1")
        judged = json.loads(self.run_capstan("simulate", PAIR, "--model", "model.toml", "--csv", "both.csv", "--html",
                                             "page.html", "--json").stdout)
        with open(self.folder / "both.csv", newline="") as file:
            rows = [{key: float(value) for key, value in row.items() if value} for row in csv.DictReader(file)]
        for judged_row in judged["runs"]:
            run = [row for row in rows if row["run"] == judged_row["run"]]
            scored = [row for row in run if row["time_s"] - run[0]["time_s"] >= 1.0]
            unit = "_" + judged_row["unit"].replace(" ", "")
            off = [row[judged_row["channel"] + "_measured" + unit] - row[judged_row["channel"] + "_model" + unit]
                   for row in scored]
            rms = math.sqrt(sum(each * each for each in off) / len(off))
            self.assertAlmostEqual(rms, judged_row["rms_model"], delta=1e-12)
        page = (self.folder / "page.html").read_text()
        for part in ("Measured and predicted", "Loops", "without the diagnosis"):
            self.assertIn(part, page)

    def test_a_model_replaces_a_model_and_no_other_file(self):
        text, _ = self.saved_model(PAIR, "1")
        study = self.write("study.toml", "[motion]\n")
        refused = self.run_capstan("diagnose", PAIR, "--save", study, expect=2)
        self.assertIn("is not overwritten", refused.stderr)
        self.assertEqual((self.folder / study).read_text(), "[motion]\n")
        self.assertIn("ends in .toml", self.run_capstan("diagnose", PAIR, "--save", "model.json", expect=2).stderr)
        self.assertIn("bench_model_format = 1", text)

    def test_wrong_models_are_rejected_with_file_line_and_key(self):
        text, _ = self.saved_model(PAIR, "1")
        line = 1 + text[:text.index("motor_radius_m")].count("\n")
        self.write("wrong.toml", text.replace("motor_radius_m = ", "motor_radius_m = -", 1))
        self.assertIn(f"wrong.toml:{line}: bench.motor_radius_m: ",
                      self.run_capstan("simulate", PAIR, "--model", "wrong.toml", expect=2).stderr)
        config = CONFIGS / "paper.toml"
        for words, part in (((PAIR, "--model", config), "is not a model of a bench"),
                            ((PAIR, "--model", "none.toml"), "no such file"),
                            ((DRIVE, "--model", "model.toml"), "a model predicts recordings of its own bench"),
                            ((config, "--model", "model.toml"), "needs a recording"),
                            ((PAIR, "--json"), "goes with --model"),
                            ((PAIR, "--model", "model.toml", "--seed", "3"), "--seed does not go with --model"),
                            ((PAIR, "--model", "model.toml", "--runs", "7"), "there is no run 7")):
            self.assertIn(part, self.run_capstan("simulate", *words, expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
