"""`study extend`: a larger study with the bits of one run from the start, however often it is killed."""

import signal
import unittest

from capstan_program import CONFIGS, CapstanTest

STUDY = ("study", "run", CONFIGS / "quick.toml", "--repetitions")


class Extend(CapstanTest):
    def both_run(self, few, many):
        self.run_capstan(*STUDY, few, "--db", "both.db")
        self.run_capstan(*STUDY, many, "--db", "both.db")
        return self.tables("both.db")

    def test_same_bits_as_from_the_start(self):
        expected = self.both_run(50, 130)
        self.run_capstan(*STUDY, 50, "--db", "a.db")
        done = self.run_capstan("study", "extend", "--repetitions", 130, "--db", "a.db", "--jobs", 2)
        self.assertIn("130 repetitions", done.stderr)
        self.assertIn("Recommendations", done.stdout)
        self.assert_same_bits(expected, self.tables("a.db"))

    def test_killed_and_called_again(self):
        expected = self.both_run(50, 4000)
        self.run_capstan(*STUDY, 50, "--db", "a.db")
        words = ("study", "extend", "--repetitions", 4000, "--db", "a.db", "--progress", "json")
        process = self.start_capstan(*words)
        for line in process.stderr:
            if '"done":2,' in line:
                break
        process.send_signal(signal.SIGKILL)
        process.communicate()
        self.run_capstan("recommend", "--db", "a.db", expect=3)  # not complete
        self.run_capstan(*words)
        self.assert_same_bits(expected, self.tables("a.db"))

    def test_until_resolved(self):
        self.run_capstan(*STUDY, 50, "--db", "a.db")
        done = self.run_capstan("study", "extend", "--until-resolved", 0.2, "--db", "a.db")
        self.assertIn("50 repetitions: another layout may still be better by up to", done.stderr)
        self.assertIn("With 95 % certainty no layout is better", done.stderr)
        done = self.run_capstan("study", "extend", "--until-resolved", 1e-6, "--max-repetitions", 100, "--db", "a.db")
        self.assertIn("not within the tolerance", done.stderr)

    def test_says_what_is_missing(self):
        self.run_capstan(*STUDY, 50)
        self.assertIn("give either --repetitions", self.run_capstan("study", "extend", expect=2).stderr)
        self.assertIn("50 repetitions already",
                      self.run_capstan("study", "extend", "--repetitions", 50, expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
