"""Two studies beside each other: what differs in their settings, their advice, their errors."""

import csv
import io
import json
import unittest

from capstan_program import CONFIGS, CapstanTest


class Compare(CapstanTest):
    def setUp(self):
        super().setUp()
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--progress", "none")
        noisier = (CONFIGS / "quick.toml").read_text().replace("multiplicative_ratio = 0.05", "multiplicative_ratio = 0.2")
        noisier = noisier.replace('name = "quick"', 'name = "noisier"')
        self.run_capstan("study", "run", self.write("noisier.toml", noisier), "--progress", "none")

    def compare(self, *words):
        return self.run_capstan("report", "--compare", 1, 2, *words).stdout

    def test_what_differs_and_nothing_else(self):
        told = json.loads(self.compare("--format", "json"))
        self.assertEqual({row["key"]: (row["first"], row["second"]) for row in told["settings"]},
                         {"name": ('"quick"', '"noisier"'), "noise[1].multiplicative_ratio": ("0.05", "0.2")})
        self.assertEqual({row["series"] for row in told["compared_recommendation"]}, {"first", "second"})

    def test_differences_are_those_of_the_two_reports(self):
        reports = [{(row["regime"], row["family"], row["sensor_count"], row["method"]): row["mean_abs_error_N"]
                    for row in json.loads(self.run_capstan("report", study, "--format", "json").stdout)["error_by_layout"]}
                   for study in (1, 2)]
        rows = list(csv.DictReader(io.StringIO(self.compare("--format", "csv"))))
        self.assertEqual(len(rows), len(reports[0]))
        for row in rows:
            key = (row["regime"], row["family"], int(row["sensor_count"]), row["method"])
            self.assertEqual(float(row["first_error_N"]), reports[0][key])
            self.assertAlmostEqual(float(row["difference_N"]), reports[1][key] - reports[0][key], places=12)
            self.assertLessEqual(float(row["interval_low_N"]), float(row["difference_N"]))

    def test_across_databases(self):
        """The numbers are those of one database; the studies are distinguished by their files."""
        expected = json.loads(self.compare("--format", "json"))
        for file, config in (("a.db", CONFIGS / "quick.toml"), ("b.db", "noisier.toml")):
            self.run_capstan("study", "run", config, "--db", file, "--progress", "none")
        words = ("report", "latest", "--db", "b.db", "--compare", "quick", "--other-db", "a.db")
        told = json.loads(self.run_capstan(*words, "--format", "json").stdout)
        self.assertEqual(told, expected)
        self.assertIn("study 1 (quick) of a.db and study 1 (noisier) of b.db", self.run_capstan(*words, "--format", "md").stdout)
        self.assertIn("--compare OTHER", self.run_capstan("report", "--other-db", "a.db", expect=2).stderr)
        self.assertIn("nothing.db", self.run_capstan("report", "--compare", 1, "--other-db", "nothing.db", expect=3).stderr)
        self.assertFalse((self.folder / "nothing.db").exists())

    def test_in_words_and_as_a_page(self):
        words = self.compare("--format", "md")
        self.assertIn("| noise[1].multiplicative_ratio | 0.05 | 0.2 |", words.replace("\\", ""))
        page = self.compare("--format", "html")
        self.assertIn('<figure id="figure-best"', page)
        self.assertIn("study 1 (quick) and study 2 (noisier)", page)
        self.assertIn('"Mass motion; noise 5 %"', page)
        self.assertLess(len(page), 3e6)
        self.assertIn("no study 'nothing'", self.run_capstan("report", "--compare", "nothing", 2, expect=3).stderr)


if __name__ == "__main__":
    unittest.main()
