"""`capstan diagnose` on recordings whose answers are known. They are not part of this repository: where they are not,
the test says so and skips. Three of them by default; with CAPSTAN_ALL_RECORDINGS=1 all, and a table."""

import json
import os
import pathlib
import unittest

from capstan_program import CapstanTest

FOLDER = pathlib.Path(os.environ.get("CAPSTAN_OPEN_RECORDINGS", "/nowhere"))
WHOLE = os.environ.get("CAPSTAN_ALL_RECORDINGS") == "1"
SOME = ["open01", "open06", "open13"]


def shrinkage(before, after):
    return 1.0 - after / before


@unittest.skipUnless((FOLDER / "answers.json").exists(), f"{FOLDER}: no recordings here")
class OpenRecordings(CapstanTest):
    def test_their_causes_are_named(self):
        answers = json.loads((FOLDER / "answers.json").read_text())
        names = sorted(answers) if WHOLE else SOME
        right, rows = 0, []
        for name in names:
            truth = answers[name]
            told = json.loads(self.run_capstan("diagnose", FOLDER / f"{name}.csv", "--json", "--progress",
                                               "none").stdout)
            self.assertEqual(told["case"], name)
            self.assertAlmostEqual(sum(each["probability"] for each in told["ranked"]), 1.0, places=9)
            first = told["ranked"][0]
            right += first["effect"] == truth["effect"]
            rows.append([name, truth["effect"], first["effect"], f"{first['probability']:.2f}"])
            if truth["effect"] == "none":
                self.assertEqual(first["effect"], "none", name)  # no false alarm
                continue
            channel = truth["clearest_channel"]
            ours = next(each for each in told["channels"] if each["channel"] == channel)
            reached = shrinkage(ours["rms_before"], ours["rms_after"])
            possible = shrinkage(truth["rms_before"][channel], truth["rms_after"][channel])
            rows[-1] += [channel, f"{ours['rms_before']:.4g}", f"{ours['rms_after']:.4g}", f"{reached:.2f}",
                         f"{possible:.2f}"]
            self.assertGreater(reached, possible - 0.10, name)
        if WHOLE:
            print(f"\n{'case':8}{'truth':28}{'named':28}{'p':>6}  {'channel':14}{'before':>9}{'after':>9}"
                  f"{'shrinks':>9}{'possible':>9}")
            for row in rows:
                print(f"{row[0]:8}{row[1]:28}{row[2]:28}{row[3]:>6}  " +
                      (f"{row[4]:14}{row[5]:>9}{row[6]:>9}{row[7]:>9}{row[8]:>9}" if len(row) > 4 else ""))
        self.assertGreaterEqual(right, len(names) - 1 if WHOLE else len(names))


if __name__ == "__main__":
    unittest.main()
