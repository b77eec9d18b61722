"""A seed of the blind trial that a README shows is in the ledger of seeds."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def seeds_in_ledger():
    rows = [line.split("|")[1] for line in (ROOT / "tests/trial_ledger.md").read_text().splitlines()
            if line.startswith("| ")]
    return {int(number) for row in rows for number in re.findall(r"\d+", row)}


def seeds_shown(text):
    return {int(number) for number in re.findall(r"gap-trial[^\n|`]*--seed (\d+)", text)}


class TrialLedger(unittest.TestCase):
    def test_every_seed_shown_is_in_the_ledger(self):
        ledger = seeds_in_ledger()
        self.assertIn(7, ledger)
        for name in ("README.md", "studies/README.md"):
            self.assertEqual(seeds_shown((ROOT / name).read_text()) - ledger, set(), name)

    def test_a_seed_that_is_not_in_the_ledger_is_found(self):
        self.assertEqual(seeds_shown("run `capstan gap-trial --cases 9 --seed 987654` twice") - seeds_in_ledger(), {987654})


if __name__ == "__main__":
    unittest.main()
