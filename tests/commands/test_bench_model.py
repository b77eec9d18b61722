"""A diagnosis is a model: saved by `capstan diagnose --save`, judged on other runs by `capstan simulate --model`."""

import csv
import json
import math
import unittest

from capstan_program import CONFIGS, CapstanTest

PAIR = CONFIGS / "recordings" / "viscous-pair.csv"  # two runs
SINGLE = CONFIGS / "recordings" / "single-cable.csv"  # one run, five tension sensors
DRIVE = CONFIGS / "recordings" / "lumped-drive.csv"

ARM = """
name = "arm"
repetitions = 24
[transmission]
segments = 8
axial_stiffness_N = 9000
dynamic_friction = 0.12
static_friction = 0.16
pretension_N = 15
[[transmission.curvature]]
length_m = 0.8
bend_radius_m = 0.3
[motion]
sample_rate_Hz = 100
samples = 60
[motion.proximal]
amplitude_m = 0.002
[uncertainty]
far_end_range_m = 0.001
members = 32
[[sensor]]
kind = "tension"
noise_ratio = 0.03
noise_N = 0.1
[layouts]
families = "all"
counts = [1, 2]
"""


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

    def test_the_estimator_takes_its_cable_from_the_model(self):
        text, _ = self.saved_model(SINGLE, "1")
        without = json.loads(self.run_capstan("estimate", SINGLE, "--leave-out", "tension_3", "--json").stdout)
        # A model with twice the friction predicts worse, and the estimator takes it at its word.
        line = next(line for line in text.splitlines() if line.startswith("friction_ratio = "))
        self.write("model.toml", text.replace(line, "friction_ratio = 2.0") +
                   "\n[effect.viscous_friction]\ndrag_N_s_per_m2 = 0.001\n\n[effect.bending_stiffness]\ndrag_N_per_m = 0.001\n")
        told = json.loads(self.run_capstan("estimate", SINGLE, "--leave-out", "tension_3", "--model", "model.toml",
                                           "--json").stdout)
        self.assertEqual(told["model"]["recording"], "single-cable")
        self.assertEqual(told["model"]["not_used"], ["bending stiffness"])  # it uses viscous friction
        self.assertGreater(told["channels"][0]["model_alone_rms_N"], 2 * without["channels"][0]["model_alone_rms_N"])
        stated = self.run_capstan("estimate", SINGLE, "--model", "model.toml", "-o", "tensions.csv").stderr
        self.assertIn("The estimator cannot use one part of the model: bending stiffness.", stated)
        self.assertIn("--model is for recordings", self.run_capstan("estimate", CONFIGS / "paper.toml", "--model",
                                                                    "model.toml", expect=2).stderr)

    def test_a_calibration_starts_at_the_model_and_stands_beside_it(self):
        self.saved_model(PAIR, "1")
        told = json.loads(self.run_capstan("calibrate", PAIR, "--runs", "2", "--model", "model.toml", "--json").stdout)
        self.assertEqual({row["run"] for row in told["channels"]}, {2})
        rows = {row["name"]: row for row in told["model"]["parameters"]}
        self.assertEqual(set(rows), {row["name"] for row in told["parameters"]})
        low, high = rows["axial_stiffness"]["model_interval_95"]
        self.assertTrue(low < rows["axial_stiffness"]["model"] < high)
        self.assertIn("a model predicts recordings of its own bench",
                      self.run_capstan("calibrate", DRIVE, "--model", "model.toml", expect=2).stderr)

    def test_worlds_lie_about_a_model_as_about_the_same_diagnosis_in_a_database(self):
        self.run_capstan("diagnose", PAIR, "--db", "pair.db", "--save", "model.toml", "--progress", "none")
        self.write("arm.toml", ARM)
        words = ("place", "arm.toml", "--json", "--from-diagnosis")
        stored = self.run_capstan(*words, "1", "--db", "pair.db").stdout
        self.assertEqual(self.run_capstan(*words, "model.toml").stdout, stored)
        text = (self.folder / "model.toml").read_text()
        line = next(line for line in text.splitlines() if line.startswith("friction_ratio = "))
        self.write("model.toml", text.replace(line, "friction_ratio = 1.5"))
        self.assertNotEqual(self.run_capstan(*words, "model.toml").stdout, stored)
        self.assertIn("a model.toml", self.run_capstan(*words, "pair", expect=2).stderr)
        self.assertIn("is not a model of a bench", self.run_capstan(*words, "arm.toml", expect=2).stderr)

    def test_a_pair_is_the_world_of_a_study_of_a_pair(self):
        self.run_capstan("diagnose", PAIR, "--runs", "1", "--save", "model.toml", "--progress", "none")
        self.write("pair.toml", (CONFIGS / "pull-pull-wrist.toml").read_text().replace("samples = 150", "samples = 40"))
        words = ("--from-diagnosis", "model.toml", "--repetitions", "20")
        about = json.loads(self.run_capstan("place", "pair.toml", *words, "--json").stdout)
        self.assertIn("viscous_friction", json.dumps(about))
        self.assertNotEqual(*[row["expected_error_N"] for row in about["recommendations"]])
        spring = self.run_capstan("place", CONFIGS / "wrist-exosuit.toml", *words, expect=2)
        self.assertIn("the diagnosis found viscous_friction", spring.stderr)
        self.assertIn('Make it kind = "position"', spring.stderr)

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
