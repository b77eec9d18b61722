"""One budget of sensors for several cables: the best distribution of what `place` finds for each."""

import itertools
import json
import re
import unittest

from capstan_program import CONFIGS, CapstanTest
from small_study import short_worlds


class Budget(CapstanTest):
    def setUp(self):
        super().setUp()
        quick = (CONFIGS / "quick.toml").read_text()
        self.write("calm.toml", quick.replace('name = "quick"', 'name = "calm"'))
        self.write("noisy.toml", quick.replace('name = "quick"', 'name = "noisy"').replace("multiplicative_ratio = 0.05", "multiplicative_ratio = 0.2"))

    def errors(self, config):
        """By number of sensors from 1."""
        found = json.loads(self.run_capstan("place", config, "--json", "--progress", "none").stdout)
        return [count["optimum"]["error_N"] for count in found["scopes"][-1]["counts"]]

    def share(self, *words):
        return json.loads(self.run_capstan("budget", "calm.toml", "noisy.toml", "--json", "--progress", "none", *words).stdout)

    def test_is_the_best_of_all_distributions(self):
        errors = [self.errors("calm.toml"), self.errors("noisy.toml")]
        for sensors in (2, 4):
            told = self.share("--sensors", sensors)
            for cable, error_N in zip(told["cables"], errors):
                if cable["sensors"]:
                    self.assertEqual(cable["error_N"], error_N[cable["sensors"] - 1])
                    self.assertEqual(len(cable["places_m"]), cable["sensors"])
            self.assertEqual(told["budgets"][0]["share"], [0, 0])
            largest_N = self.share("--sensors", sensors, "--objective", "largest")["largest_error_N"]
            for calm, noisy in itertools.product(range(1, sensors), repeat=2):
                if calm + noisy <= sensors:
                    self.assertLessEqual(told["mean_error_N"], (errors[0][calm - 1] + errors[1][noisy - 1]) / 2 + 1e-12)
                    self.assertLessEqual(largest_N, max(errors[0][calm - 1], errors[1][noisy - 1]) + 1e-12)

    def test_in_words_and_refusals(self):
        told = self.run_capstan("budget", "calm.toml", "noisy.toml", "--progress", "none", "--html", "b.html").stdout
        self.assertRegex(told, r"use \d sensors?: \d on calm, \d on noisy")
        self.assertIn("Sensors of each cable", (self.folder / "b.html").read_text())
        self.assertIn("only one has [uncertainty]", self.run_capstan("budget", "calm.toml", CONFIGS / "wrist-exosuit.toml", expect=2).stderr)
        self.write("load.toml", (self.folder / "calm.toml").read_text() + '\n[placement]\nobjective = "load_end"\n')
        self.assertIn("all_nodes", self.run_capstan("budget", "load.toml", expect=2).stderr)
        self.write("needs.toml", (self.folder / "calm.toml").read_text() + "\n[placement]\nrequired_nodes = [1, 3]\n")
        self.assertIn("need more sensors than the budget has",
                      self.run_capstan("budget", "needs.toml", "needs.toml", "--sensors", 3, "--progress", "none", expect=2).stderr)

    def test_over_worlds_it_shares_what_place_finds(self):
        """Two drives that are not exactly known: one alone gets its best sets, and both share what helps most."""
        wrist = short_worlds()
        self.write("wrist.toml", wrist)
        self.write("stiff.toml", re.sub(r"^name = .*", 'name = "stiff"', re.sub(r"^axial_stiffness_N = .*", "axial_stiffness_N = 20000", wrist, flags=re.M),
                                        flags=re.M))
        best = {}
        for config in ("wrist.toml", "stiff.toml"):
            found = json.loads(self.run_capstan("place", config, "--repetitions", 20, "--json", "--progress", "none").stdout)
            best[config] = {row["sensor_count"]: row["expected_error_N"] for row in found["prices"] if row["what"] != "baseline"}
        told = json.loads(self.run_capstan("budget", "wrist.toml", "stiff.toml", "--sensors", 3, "--repetitions", 20, "--json", "--progress", "none").stdout)
        for config, cable in zip(best, told["cables"]):
            self.assertEqual(cable["error_N"], best[config][cable["sensors"]])
            self.assertIn("set", cable)
        self.assertLessEqual(sum(cable["sensors"] for cable in told["cables"]), 3)
        for own, other in itertools.product(best["wrist.toml"].items(), best["stiff.toml"].items()):
            if own[0] + other[0] <= 3:
                self.assertLessEqual(told["mean_error_N"], (own[1] + other[1]) / 2 + 1e-12)


if __name__ == "__main__":
    unittest.main()
