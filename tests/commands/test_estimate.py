"""The tension everywhere from a recording's few sensors: CSV, channels left out in turn, refusals."""

import csv
import io
import json
import math
import random
import unittest

from capstan_program import CONFIGS, CapstanTest

SENSORS = {"tension_1": 0.2, "tension_2": 1.1, "tension_3": 1.8}
SIDECAR = {
    "case": "b", "schema": 1, "mode": "single_cable", "sample_rate_hz": 100,
    "units": {"t": "s", "motor_angle": "rad"} | {name: "N" for name in SENSORS},
    "nominal": {"L": 2.0, "R_profile": [{"s0": 0, "s1": 2, "R": 0.8}], "r_input": 0.02, "r_load": 0.104, "K": 2000.0,
                "mu_d": 0.21, "mu_s": 0.21},
    "nominal_units": {"L": "m", "R": "m", "r_input": "m", "r_load": "m", "K": "N/m (end to end, one cable)", "T0": "N"},
    "noise_std": {name: 0.25 for name in SENSORS},
    "encoder_step": {"motor_angle": 0.00016},
    "tension_sensors": [{"channel": name, "cable": "A", "s": place} for name, place in SENSORS.items()],
    "runs": [{"run": 1, "protocol": "single_sine", "t_session_start": 0.0, "duration": 6.0, "T0": 25,
              "output": "locked", "driven": ["motor_angle"]}],
}
HEAD = ["run", "t", "motor_angle", *SENSORS]


class Estimates(CapstanTest):
    def setUp(self):
        """A recording whose readings are the model's own tensions and noise."""
        super().setUp()
        angles = [0.2 * math.sin(2 * math.pi * k / 200) for k in range(600)]
        self.record([[1, k / 100, angle, 25 + 0.1 * (k % 2), 25 + 0.1 * (k % 5), 25 + 0.1 * (k % 3)] for k, angle in enumerate(angles)])
        self.run_capstan("simulate", "b.csv", "-o", "model.csv")
        with open(self.folder / "model.csv", newline="") as lines:
            model = list(csv.DictReader(lines))
        noise = random.Random(7)
        self.record([[1, k / 100, angles[k], *(float(row[name]) + noise.gauss(0, 0.25) for name in SENSORS)]
                     for k, row in enumerate(model)])

    def record(self, rows, sidecar=SIDECAR):
        lines = [",".join(HEAD)] + [",".join(f"{value:.6g}" for value in row) for row in rows]
        self.write("b.csv", "\n".join(lines) + "\n")
        self.write("b.json", json.dumps(sidecar))

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
