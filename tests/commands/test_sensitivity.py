"""`capstan sensitivity`: the advice for, the same whatever the threads."""

import json
import unittest

from capstan_program import CONFIGS, CapstanTest

SMALL = "\n[sensitivity]\nrepetitions = 80\ntrajectories = 2\nsensors = 1\n"


class Sensitivity(CapstanTest):
    def small(self, more=""):
        return self.write("small.toml", (CONFIGS / "quick.toml").read_text() + SMALL + more)

    def test_same_bits_for_any_number_of_threads(self):
        answers = {self.run_capstan("sensitivity", self.small(), "--json", "--jobs", jobs).stdout for jobs in (1, 2, 7, 16)}
        self.assertEqual(len(answers), 1)
        answer = json.loads(answers.pop())
        self.assertEqual([p["name"] for p in answer["parameters"]],
                         ["friction", "curvature", "stiffness", "pretension", "noise"])
        self.assertEqual(answer["screened"], 12)

    def test_words_and_page(self):
        words = self.run_capstan("sensitivity", self.small(), "--html", "advice.html").stdout
        self.assertIn("the advice for", words)
        self.assertIn("friction coefficient", words)
        self.assertIn("the advice changes", words)
        self.assertIn("Regret of the advice along each parameter", (self.folder / "advice.html").read_text())

    def test_refuses_a_range_without_the_configured_value(self):
        refused = self.run_capstan("sensitivity", self.small("friction_ratio = [1.1, 1.5]\n"), expect=2).stderr
        self.assertIn("sensitivity.friction_ratio", refused)


if __name__ == "__main__":
    unittest.main()
