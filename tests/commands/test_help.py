"""A newcomer finds the way: help names everything, a slip of the finger gets the nearest name."""

import json
import re
import unittest

import tension_recording
from capstan_program import CONFIGS, PROGRAM, CapstanTest


class Help(CapstanTest):
    def commands(self):
        listing = self.run_capstan("--help").stdout.split("Commands:\n")[1].split("\n\n")[0]
        return [re.match(r"  (\S+(?: \S+)?)  ", line).group(1) for line in listing.splitlines() if line.startswith("  ")
                and not re.match(r"  (help|--version)", line)]

    def test_alone_shows_where_to_begin(self):
        self.assertIn("capstan study run", self.run_capstan().stdout)

    def test_every_command_explains_itself_the_same_way_twice(self):
        names = self.commands()
        self.assertGreaterEqual(len(names), 12)
        for name in names:
            asked = self.run_capstan(*name.split(), "--help").stdout
            self.assertEqual(asked, self.run_capstan("help", *name.split()).stdout)
            for part in ("Usage: capstan " + name, "Options:", "--help", "Exit codes:", "\n  2  "):
                self.assertIn(part, asked)
            codes = asked.split("Exit codes:")[1]
            self.assertEqual("\n  3 " in codes, "--db FILE" in asked, name)
            self.assertEqual("\n  130 " in codes, name in ("study run", "study resume", "study extend", "study merge", "study verify", "study work", "place", "budget", "bands", "sensitivity"), name)

    def test_every_command_says_how_long_it_takes_and_long_ones_show_progress(self):
        """Those without --progress end at once, are given their time, or wait for another program."""
        given_a_time = {"serve", "query", "export", "study replay", "simulate", "study status", "batch"}
        table = []
        for name in self.commands():
            asked = self.run_capstan(*name.split(), "--help").stdout
            words = " ".join(asked.split("\nTime:\n")[1].split("\n\n")[0].split())
            table.append((name, "yes" if "--progress" in asked else "-", words))
            if "time left" in words or "Shows progress" in words:
                self.assertIn("--progress", asked, name)
            elif words != "Less than 2 s.":
                self.assertIn(name, given_a_time, words)
        print("\n" + "\n".join("{:<18} {:<9} {}".format(*row) for row in [("command", "progress", "time")] + table))

    def test_long_work_tells_how_much_is_left(self):
        tension_recording.make(PROGRAM, self.folder)
        self.write("small.toml", (CONFIGS / "quick.toml").read_text().replace("repetitions = ", "repetitions = 2"))
        for words in (("place", "small.toml"), ("sensitivity", "small.toml"), ("estimate", "small.toml"), ("estimate", "b.csv"),
                      ("estimate", "b.csv", "--leave-out", "each"), ("calibrate", CONFIGS / "recordings" / "viscous-pair.csv"),
                      ("duty", CONFIGS / "recordings" / "viscous-pair.csv"), ("paper", "solver", "--seconds", 0.01), ("study", "plan", "small.toml", "--seconds", 1), ("study", "run", "small.toml"),
                      ("study", "extend", 1, "--repetitions", 4200)):
            said = self.run_capstan(*words, "--progress", "json", *(() if "run" in words or "extend" in words else ("-o", "answer"))).stderr
            events = [json.loads(line) for line in said.splitlines() if '"progress"' in line]
            fractions = [event["fraction"] for event in events]
            self.assertEqual(fractions, sorted(fractions), words)  # never goes back
            self.assertEqual((fractions[0] < 0.5, fractions[-1]), (True, 1.0), words)
            for event in events[1:]:
                self.assertIsNotNone(event["seconds_left"], (words, event))

    def test_a_search_of_causes_states_its_time_left_as_a_range(self):
        said = self.run_capstan("diagnose", CONFIGS / "recordings" / "viscous-pair.csv", "--progress", "json", "-o", "answer").stderr
        events = [json.loads(line) for line in said.splitlines() if '"progress"' in line]
        fractions = [event["fraction"] for event in events]
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual((fractions[0] < 0.1, fractions[-1]), (True, 1.0))
        told = [event for event in events[:-1] if event["seconds_left"] is not None]
        self.assertTrue(told)
        for event in told:
            self.assertLessEqual(event["seconds_left"], event["max_seconds_left"], event)

    def test_every_option_in_an_example_is_explained(self):
        for name in self.commands():
            text = self.run_capstan(*name.split(), "--help").stdout
            options, _, examples = text.partition("Examples:")
            for option in re.findall(r"(?<=\s)--[a-z-]+", examples.partition("Exit codes:")[0]):
                self.assertIn(option, options, name)

    def test_slips_get_the_nearest_name(self):
        for words, text in (
            (("reprot",), "did you mean 'report'?"),
            (("study", "rum"), "did you mean 'study run'?"),
            (("studdy",), "did you mean 'study'?"),
            (("study", "run", "x.toml", "--job", "3"), "did you mean '--jobs'?"),
            (("--versoin",), "did you mean '--version'?"),
            (("study",), "study resume"),
            (("study", "run"), "CONFIG is missing"),
            (("study", "delete"), "STUDY is missing"),
            (("query",), "SQL is missing"),
        ):
            done = self.run_capstan(*words, expect=2)
            self.assertIn(text, done.stderr)
            self.assertEqual(done.stdout, "")

    def test_version(self):
        self.assertRegex(self.run_capstan("--version").stdout, r"^capstan \d+\.\d+\.\d+\n$")


if __name__ == "__main__":
    unittest.main()
