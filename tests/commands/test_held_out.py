"""`capstan diagnose --fit --hold --baselines`: a diagnosis judged on runs that it never saw, beside simple models."""

import json
import unittest

from capstan_program import CONFIGS, CapstanTest

PAIR = CONFIGS / "recordings" / "viscous-pair.csv"  # two runs


class HeldOut(CapstanTest):
    def diagnose(self, *words, expect=0):
        return self.run_capstan("diagnose", PAIR, *words, "--progress", "none", expect=expect)

    def test_the_held_out_run_is_not_diagnosed(self):
        told = json.loads(self.diagnose("--fit", "1", "--baselines", "--json").stdout)
        self.assertEqual(told["comparison"]["splits"], [{"fit": [1], "hold": [2]}])
        alone = json.loads(self.diagnose("--runs", "1", "--json").stdout)
        self.assertEqual(told["ranked"], alone["ranked"])
        self.assertEqual(told["causes"], alone["causes"])
        models = {(each["channel"], each["model"]): each for each in told["comparison"]["models"]}
        self.assertEqual({name for _, name in models},
                         {"constant", "linear", "closed_form", "prandtl_ishlinskii", "elastic_plastic", "nominal",
                          "corrected", "corrected_with_law"})
        for left in told["left_over"]:
            corrected = models[left["channel"], "corrected"]
            # Simulated again from the numbers that the diagnosis states, on all runs.
            self.assertAlmostEqual(corrected["rms_fitted"], left["rms"], delta=1e-3 * left["rms"])
            self.assertEqual([each["run"] for each in corrected["runs_held_out"]], [2])
            self.assertEqual(corrected["rms_held_out"], corrected["runs_held_out"][0]["rms"])
            # Viscous friction, which the nominal model lacks, is there in the other run too.
            self.assertLess(corrected["rms_held_out"], models[left["channel"], "nominal"]["rms_held_out"])

    def test_the_errors_of_all_models_are_printed(self):
        text = self.diagnose("--fit", "1", "--hold", "2", "--baselines").stdout
        for part in ("Every model is fitted to run 1 and judged on run 2.", "Prandtl-Ishlinskii times load",
                     "nominal model of the bench", "RMS of each held-out run, load torque [N m]"):
            self.assertIn(part, text)

    def test_runs_that_cannot_be_split_are_rejected(self):
        self.assertIn("run 1 is both in fit and in hold", self.diagnose("--fit", "1,2", "--hold", "1", expect=2).stderr)
        self.assertIn("there is no run 7", self.diagnose("--fit", "1", "--hold", "7", expect=2).stderr)
        self.assertIn("leaves no run to fit", self.diagnose("--hold", "1,2", expect=2).stderr)
        self.assertIn("does not go with", self.diagnose("--fit", "1", "--runs", "1", expect=2).stderr)
        self.assertIn("is not a run number", self.diagnose("--fit", "one", expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
