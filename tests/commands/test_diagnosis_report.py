"""A diagnosis that the database keeps is told as when it was made: as a page, Markdown, CSV and JSON, and by the service."""

import csv
import io
import json
import re
import unittest

from capstan_service import ServiceTest


class DiagnosisReport(ServiceTest):
    def setUp(self):
        super().setUp()
        self.run_capstan("gap-trial", "--cases", 1, "--seed", 4, "--length", "short", "--severity", "strong",
                         "--keep", "kept", "--generate-only", "--progress", "none")
        self.log = self.folder / "kept" / "case001.csv"

    def report(self, file_format):
        return self.run_capstan("report", "--diagnosis", "latest", "--format", file_format, "--db", "kept.db").stdout

    def test_a_stored_diagnosis_is_told_as_it_was_made(self):
        made = json.loads(self.run_capstan("diagnose", self.log, "--json", "--db", "kept.db", "--progress", "none").stdout)
        self.assertIn("experiments", made.pop("non_identifiable"))  # no table keeps these two
        self.assertIn("channel", made.pop("left_over")[0])
        self.assertEqual(json.loads(self.report("json")), made)
        self.run_capstan("report", "--diagnosis", 1, "-o", "named.json", "--db", "kept.db")
        self.assertEqual(json.loads((self.folder / "named.json").read_text()), made)

        self.run_capstan("diagnose", self.log, "-o", "again.md", "--progress", "none")
        again = (self.folder / "again.md").read_text().split("\n## What is left")[0]
        self.assertEqual(again.strip(), self.report("md").strip())

        rows = list(csv.DictReader(io.StringIO(self.report("csv"))))
        cells = {(row["table"], row["row"], row["column"]): row["value"] for row in rows}
        count = len(made["effects"])
        self.assertEqual([{"effect": cells["probability", str(k), "effect"],
                           "probability": float(cells["probability", str(k), "probability"]),
                           "present": float(cells["probability", str(k), "present"])} for k in range(1, count + 1)],
                         made["effects"])
        # The canonical list lacks three of the effects, which count as unknown.
        outside = {"directional_friction", "friction_drift", "sensor_clipping", "unknown"}
        ranked = {each["effect"]: each["probability"] for each in made["ranked"]}
        self.assertEqual({each["effect"] for each in made["effects"]} - outside, ranked.keys() - {"unknown"})
        self.assertAlmostEqual(sum(each["probability"] for each in made["effects"] if each["effect"] in outside),
                               ranked["unknown"], places=12)
        for number, channel in enumerate(made["channels"], 1):
            self.assertEqual(float(cells["channels", str(number), "rms_held_out"]), channel["rms_held_out"])

        page = self.report("html")
        for part in ("<h1>case001</h1>", 'id="figure-ranking"', 'id="figure-gap_map"'):
            self.assertIn(part, page)

        # People read titles; JSON and CSV, above, have the names.
        words = self.report("md") + page.partition("<main")[2].partition("</main")[0]
        self.assertEqual(made["ranked"][0]["effect"], "motor_cogging")
        self.assertIn("| motor cogging | 0.9", words)
        self.assertEqual(re.findall(r"\b(?:param|viscous|sensor|motor|load|pulley|time|local)_\w+", words), [])

        self.serve(db="kept.db")
        self.assertEqual(self.get("/api/diagnoses/1"), made)
        self.get("/api/diagnoses/2", expect=404)

        self.assertIn("no diagnosis 7", self.run_capstan("report", "--diagnosis", 7, "--db", "kept.db", expect=3).stderr)
        self.assertIn("neither a number nor latest", self.run_capstan("report", "--diagnosis", "x", "--db", "kept.db", expect=2).stderr)
        self.run_capstan("report", "--diagnosis", 1, "--compare", 1, "--db", "kept.db", expect=2)


if __name__ == "__main__":
    unittest.main()
