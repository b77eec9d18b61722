"""When a study was begun and by which command, notes and tags, the trash; and numbers that are never used twice."""

import json
import re
import unittest

from capstan_program import CONFIGS, CapstanTest


class History(CapstanTest):
    def study(self, *words):
        self.run_capstan("study", "run", CONFIGS / "quick.toml", *words)

    def listed(self, *words):
        return json.loads(self.run_capstan("study", "list", "--json", *words).stdout)

    def test_every_study_says_when_and_by_which_command(self):
        self.study("--repetitions", "20")
        self.assertRegex(self.listed()[0]["begun_utc"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        events = json.loads(self.run_capstan("query", "SELECT event, command FROM history ORDER BY event_id", "--json").stdout)
        self.assertEqual([each["event"] for each in events], ["begun", "completed"])
        self.assertEqual(events[0]["command"], f"capstan study run {CONFIGS}/quick.toml --repetitions 20")

    def test_a_deleted_study_comes_back_with_all_its_bits(self):
        self.study()
        before = self.tables("capstan.db")
        told = self.run_capstan("study", "delete", "1").stderr
        self.assertIn("capstan study restore 1", told)
        self.assertEqual(self.listed(), [])
        self.assertEqual([each["study_id"] for each in self.listed("--deleted")], [1])
        for words in (("recommend",), ("study", "show", "1"), ("report", "quick"), ("study", "delete", "1")):
            self.assertIn("no study", self.run_capstan(*words, expect=3).stderr)
        for table in ("study", "history", "v_best_method", "v_recommendation"):
            self.assertIn("0\n", self.run_capstan("query", f"SELECT count(*) FROM {table}", "--format", "csv").stdout, table)
        self.run_capstan(*told[told.index("capstan study"):].split("`")[0].split()[1:])
        after = self.tables("capstan.db")
        for tables in (before, after):
            tables.pop("study_mark")
        self.assert_same_bits(before, after)
        self.assertEqual(self.run_capstan("study", "restore", "1", expect=3).stderr.count("trash is empty"), 1)

    def test_numbers_are_never_used_twice(self):
        self.study()
        self.study()
        self.run_capstan("study", "delete", "2", "--forever")
        self.study()
        self.assertEqual([each["study_id"] for each in self.listed()], [1, 3])
        self.run_capstan("study", "delete", "3")
        self.run_capstan("study", "delete", "3", "--forever")
        self.assertEqual(self.listed("--deleted"), [])
        self.study()
        self.assertEqual([each["study_id"] for each in self.listed()], [1, 4])

    def test_notes_and_tags(self):
        self.study()
        self.study()
        self.run_capstan("study", "note", "1", "with the new conduit", "--tags", " thesis  chapter-4 thesis ")
        self.run_capstan("study", "note", "2", "--tags", "other")
        self.run_capstan("study", "note", "2", "a note")
        first, second = self.listed()
        self.assertEqual((first["note"], first["tags"]), ("with the new conduit", "thesis chapter-4"))
        self.assertEqual((second["note"], second["tags"]), ("a note", "other"))
        self.assertEqual([each["study_id"] for each in self.listed("--tag", "thesis")], [1])
        self.assertEqual(self.listed("--tag", "thes"), [])
        self.assertIn("with the new conduit", self.run_capstan("study", "list").stdout)
        self.run_capstan("study", "note", "1", expect=2)
        self.run_capstan("study", "note", "9", "x", expect=3)

    def test_the_list_is_read_by_people(self):
        self.study()
        self.assertTrue(re.match(r"study +name +status +units_done +units +begun \(UTC\) +note +tags\n",
                                 self.run_capstan("study", "list").stdout))


if __name__ == "__main__":
    unittest.main()
