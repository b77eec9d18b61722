"""The tension everywhere from a recording's few sensors: CSV, channels left out in turn, refusals."""

import csv
import io
import json
import unittest

import tension_recording
from capstan_program import CONFIGS, PROGRAM, CapstanTest
from tension_recording import SENSORS, SIDECAR


class Estimates(CapstanTest):
    def setUp(self):
        super().setUp()
        tension_recording.make(PROGRAM, self.folder)

    def record(self, rows, sidecar=SIDECAR):
        tension_recording.write(self.folder, rows, sidecar)

    def test_each_channel_is_predicted_to_its_noise_from_the_others(self):
        answer = json.loads(self.run_capstan("estimate", "b.csv", "--leave-out", "each", "--json").stdout)
        self.assertEqual([row["channel"] for row in answer["channels"]], list(SENSORS))
        for row in answer["channels"]:
            self.assertAlmostEqual(row["rms_N"], 0.25, delta=0.05)
            self.assertGreater(row["coverage"], 0.9)
            self.assertGreater(row["paper_mean_rms_N"], row["rms_N"])
        words = self.run_capstan("estimate", "b.csv", "--leave-out", "tension_2", "--html", "b.html").stdout
        self.assertIn("tension_2", words)
        self.assertNotIn("tension_1 ", words)
        self.assertIn("estimate", (self.folder / "b.html").read_text())

    def test_tension_everywhere_with_a_band(self):
        told = self.run_capstan("estimate", "b.csv", "--segments", 20, "--html", "b.html").stdout
        rows = list(csv.DictReader(io.StringIO(told)))
        self.assertEqual(len(rows), 600)
        self.assertEqual(sum(name.startswith("tension_at_") for name in rows[0]), 21)
        for row in rows:
            self.assertGreater(float(row["tension_at_1m_N"]), 0)
            self.assertGreaterEqual(float(row["band_at_1m_N"]), 0)
        self.assertEqual(told, self.run_capstan("estimate", "b.csv", "--segments", 20, "--jobs", 1).stdout)

    def test_refusals(self):
        done = self.run_capstan("estimate", "b.csv", "--leave-out", "tension_9", expect=2)
        self.assertIn("tension_1, tension_2, tension_3", done.stderr)
        done = self.run_capstan("estimate", "b.csv", "--members", 30, expect=2)
        self.assertIn("power of two", done.stderr)
        bare = {key: value for key, value in SIDECAR.items() if key != "tension_sensors"}
        self.write("b.json", json.dumps(bare))
        done = self.run_capstan("estimate", "b.csv", expect=2)
        self.assertIn("no channel measures a tension", done.stderr)
        self.assertEqual(done.stdout, "")

    def test_a_study_scores_its_layouts_over_the_whole_motion(self):
        answer = json.loads(
            self.run_capstan("estimate", CONFIGS / "quick.toml", "--repetitions", 2, "--json").stdout)
        self.assertGreater(len(answer["layouts"]), 1)
        for layout in answer["layouts"]:
            self.assertLess(layout["error_N"], layout["paper_mean_error_N"])


if __name__ == "__main__":
    unittest.main()
