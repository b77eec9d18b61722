"""The night of tests: its parts in sequence, gone on with after a kill, stopped at its end, on a page that keeps its date."""

import json
import os
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(os.environ["CAPSTAN_SOURCE"]) / "tests"))
import night  # noqa: E402

CTEST = "50% tests passed, 1 tests failed out of 2\n\nThe following tests FAILED:\n\t  7 - commands.golden (Failed)\n"


class NightOfTests(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "nights"
        self.begun = []

    def command(self, part):
        self.begun.append(part)
        return {"slow": ["sh", "-c", "sleep 60"], "fuzz": ["sh", "-c", f"printf '%s' '{CTEST}'; exit 8"]}.get(part, ["true"])

    def run_night(self, hours=1.0):
        of_tests = night.Night(self.folder, hours)
        of_tests.end = min(of_tests.end, night.time.monotonic() + 3600 * hours)
        return of_tests, of_tests.run(self.command)

    def test_every_part_is_on_the_page(self):
        of_tests, passed = self.run_night(hours=2 / 3600)
        self.assertFalse(passed)
        self.assertEqual(self.begun, list(night.PARTS))
        parts = of_tests.state["parts"]
        self.assertEqual({part: done["result"] for part, done in parts.items()},
                         {**{part: "passed" for part in night.PARTS}, "fuzz": "failed", "slow": "stopped"})
        self.assertEqual((parts["fuzz"]["tests"], parts["fuzz"]["failures"]), ("1 of 2 tests", ["commands.golden"]))
        page = (self.folder / f"{of_tests.state['date']}.html").read_text()
        for text in ("commands.golden", "5 of 7 parts passed", f'href="{of_tests.state["date"]}/fuzz.log"'):
            self.assertIn(text, page)

    def test_a_killed_night_goes_on_and_a_complete_one_is_kept(self):
        night.Night(self.folder, 1).run_part("release", ["true"])
        self.command = lambda part: self.begun.append(part) or ["true"]
        first, passed = self.run_night()
        self.assertTrue(passed)
        self.assertEqual(self.begun, [part for part in night.PARTS if part != "release"])
        second, _ = self.run_night()
        self.assertNotEqual(first.state["date"], second.state["date"])
        self.assertEqual(len(list(self.folder.glob("*.html"))), 2)

    def test_other_sources_begin_a_new_night(self):
        of_tests = night.Night(self.folder, 1)
        of_tests.run_part("release", ["true"])
        state = self.folder / of_tests.state["date"] / "state.json"
        state.write_text(json.dumps({**json.loads(state.read_text()), "commit": "of other sources"}))
        self.assertEqual(night.Night(self.folder, 1).state["parts"], {})


if __name__ == "__main__":
    unittest.main()
