"""Placement for a cable that is not exactly known, as its user runs it."""

import json
import math
import signal
import unittest

from capstan_program import CONFIGS, CapstanTest

ARM = """
name = "arm"
repetitions = 24

[transmission]
segments = 8
axial_stiffness_N = 9000
dynamic_friction = 0.12
static_friction = 0.16
pretension_N = 15

[[transmission.curvature]]
length_m = 0.4

[[transmission.curvature]]
length_m = 0.4
bend_radius_m = 0.15

[motion]
sample_rate_Hz = 100
samples = 60

[motion.proximal]
amplitude_m = 0.002

[uncertainty]
far_end_range_m = 0.001
members = 32

[[sensor]]
kind = "tension"
noise_ratio = 0.03
noise_N = 0.1

[[sensor]]
kind = "load_displacement"
noise_m = 0.0001
price = 2.0

[layouts]
families = "all"
counts = [1, 2]
"""
CONSTRAINTS = """
[placement]
search = "all"
max_sensors = 2
forbidden_m = [0.0, 0.3]
required_m = [0.8]
"""

# A sensor at the motor whose noise is a tenth of a large tension, and segments that stick.
STICKING = """
name = "sticking"
repetitions = 20

[transmission]
segments = 4
cut = "even"
axial_stiffness_N = 7300
dynamic_friction = 0.36
static_friction = 0.69
pretension_N = 21

[[transmission.curvature]]
length_m = 2.6
bend_radius_m = 0.35

[motion]
sample_rate_Hz = 100
samples = 120

[motion.proximal]
amplitude_m = 0.0013
frequency_Hz = 1

[uncertainty]
far_end_range_m = 0.002
stiffness_fraction = 0.15
pretension_fraction = 0.3

[[sensor]]
kind = "tension"
places_m = [0.0]
noise_ratio = 0.1
noise_N = 0.1
zero_N = 0.13

[layouts]
families = "all"
counts = [1]
"""


class Worlds(CapstanTest):
    def setUp(self):
        super().setUp()
        self.write("arm.toml", ARM)

    def test_every_way_to_ask_gives_the_same_sensors_and_the_same_bits(self):
        for constraints in ("", CONSTRAINTS):
            with self.subTest(constraints=constraints):
                self.write("arm.toml", ARM + constraints)
                self.ask_in_every_way(constraints)

    def ask_in_every_way(self, constraints):
        (self.folder / "arm.db").unlink(missing_ok=True)
        run = json.loads(self.run_capstan("study", "run", "arm.toml", "--db", "arm.db", "--json").stdout)
        recommended = json.loads(self.run_capstan("recommend", "--db", "arm.db", "--json").stdout)
        self.assertEqual(run, recommended)
        placed = json.loads(self.run_capstan("place", "arm.toml", "--json").stdout)
        self.assertEqual(placed["recommendations"], run["recommendations"])
        self.assertEqual(placed["prices"], run["prices"])
        varied = json.loads(self.run_capstan("sensitivity", "arm.toml", "--json").stdout)
        self.assertEqual(varied["set"], run["recommendations"][0]["set"])
        self.assertEqual(varied["error_N"], run["recommendations"][0]["expected_error_N"])
        self.write("fewer.toml", (ARM + constraints).replace("repetitions = 24", "repetitions = 20"))
        (self.folder / "fewer.db").unlink(missing_ok=True)
        self.run_capstan("study", "run", "fewer.toml", "--db", "fewer.db")
        self.run_capstan("study", "extend", "--repetitions", 24, "--db", "fewer.db")
        extended = json.loads(self.run_capstan("recommend", "--db", "fewer.db", "--json").stdout)
        self.assertEqual(extended["recommendations"], run["recommendations"])
        self.assertEqual(extended["prices"], run["prices"])

    def test_sensitivity_varies_each_stated_number(self):
        self.write("noisy.toml", ARM + "\n[sensitivity]\nvalues = 3\nnoise_ratio = [0.1, 1000]\nfriction_ratio = [1, 1]\n")
        answer = json.loads(self.run_capstan("sensitivity", "noisy.toml", "--json", "--html", "noisy.html").stdout)
        rows = {}
        for row in answer["rows"]:
            rows.setdefault(row["title"], []).append(row)
        for title in ("range of the far end", "bandwidth of the far end", "uncertainty of friction", "pretension"):
            self.assertEqual(len(rows[title]), 3)
        self.assertNotIn("friction coefficient", rows)  # [1, 1]: it is certain
        noise = rows["noise at the pretension"]
        self.assertLess(noise[0]["error_N"], noise[1]["error_N"])
        # Sensors with a thousand times the noise tell nothing, and the answer says so.
        self.assertFalse(noise[2]["beats_no_sensor"])
        self.assertEqual(noise[2]["set"], "no sensor")
        self.assertTrue(noise[2]["advice_changes"])
        # A wider range of the far end is more to find out.
        far_end = rows["range of the far end"]
        self.assertLess(far_end[0]["no_sensor_error_N"], far_end[2]["no_sensor_error_N"])
        self.assertIn("world_sensitivity", (self.folder / "noisy.html").read_text())

    def test_shards_give_the_bits_of_one_run(self):
        self.run_capstan("study", "run", "arm.toml", "--db", "one.db")
        parts = [f"part{number}.db" for number in (1, 2, 3)]
        for number, part in enumerate(parts, 1):
            self.run_capstan("study", "run", "arm.toml", "--shard", f"{number}/3", "--db", part)
        refused = self.run_capstan("study", "merge", "--db", "merged.db", parts[0], parts[2], parts[2], expect=3)
        self.assertIn("Shard 2 of 3 is missing", refused.stderr)
        self.assertIn("leave one out", refused.stderr)
        self.assertFalse((self.folder / "merged.db").exists())
        refused = self.run_capstan("study", "run", "arm.toml", "--shard", "2/3", "--db", parts[0], expect=3)
        self.assertIn("is shard 1 of 3, not shard 2 of 3", refused.stderr)
        self.run_capstan("study", "merge", "--db", "merged.db", *parts)
        self.assert_same_bits(self.tables("one.db"), self.tables("merged.db"))

    def test_instants_say_where_no_sensor_is_as_good(self):
        text = (CONFIGS / "noise-instants.toml").read_text().replace("repetitions = 1000", "repetitions = 60")
        self.write("instants.toml", text)
        answer = json.loads(self.run_capstan("study", "run", "instants.toml", "--db", "i.db", "--json").stdout)
        by_noise = {r["noise"]: r for r in answer["recommendations"] if r["scope"] == "duty_cycle"}
        self.assertTrue(by_noise["1 %"]["beats_no_sensor"])
        self.assertFalse(by_noise["20 %"]["beats_no_sensor"])
        self.assertIn("knows friction", answer["assumptions"])
        for each in answer["recommendations"]:
            if each["beats_no_sensor"] is not None:
                self.assertEqual(each["sentence"].startswith("Use no sensor: "), not each["beats_no_sensor"])

    def test_what_is_advised_beats_no_sensor_or_the_advice_is_none(self):
        """Poor sensors, few segments, a far end that moves little or much; few repetitions."""
        sweep = (CONFIGS / "noise-sweep.toml").read_text().replace("samples = 200", "samples = 60")
        for old, new in (("", ""), ("noise_ratio = 0.05", "noise_ratio = 0.2"), ("segments = 10", "segments = 4"),
                         ("far_end_range_m = 0.001", "far_end_range_m = 0.0002"),
                         ("far_end_range_m = 0.001", "far_end_range_m = 0.006"), ("noise_N = 0.02", "noise_N = 50")):
            self.assertIn(old, sweep)
            self.write("sweep.toml", sweep.replace(old, new))
            for repetitions in (20, 40):
                with self.subTest(new, repetitions=repetitions):
                    answer = json.loads(self.run_capstan("place", "sweep.toml", "--repetitions", repetitions, "--json").stdout)
                    advice = answer["recommendations"][0]
                    self.assertEqual(advice["beats_no_sensor"], new != "noise_N = 50")
                    if advice["beats_no_sensor"]:
                        self.assertLess(advice["monte_carlo_interval_N"][1], advice["no_sensor_error_N"])
                    else:
                        self.assertEqual(advice["sensors"], [])

    def test_a_recommendation_says_what_a_buyer_asks(self):
        answer = json.loads(self.run_capstan("place", "arm.toml", "--json").stdout)
        recommendation = answer["recommendations"][0]
        for key in ("objective", "sensors", "estimator", "expected_error_N", "error_95_N", "monte_carlo_interval_N",
                    "no_sensor_error_N", "beats_no_sensor", "gains"):
            self.assertIn(key, recommendation)
        for sensor in recommendation["sensors"]:
            self.assertEqual(sorted(sensor), ["kind", "node", "place_m"])
        low, high = recommendation["monte_carlo_interval_N"]
        self.assertTrue(low < recommendation["expected_error_N"] < high < recommendation["no_sensor_error_N"])
        gains = {gain["of"] for gain in recommendation["gains"]}
        self.assertIn("calibrating friction", gains)
        words = self.run_capstan("place", "arm.toml").stdout
        self.assertIn("Without any sensor it is", words)

    def test_a_band_that_is_too_narrow_is_named(self):
        self.write("sticking.toml", STICKING)
        self.write("sliding.toml", STICKING.replace("static_friction = 0.69", "static_friction = 0.36"))
        words = {name: " ".join(self.run_capstan("place", f"{name}.toml").stdout.split()) for name in ("sticking", "sliding")}
        self.assertIn("Bands that are too narrow, because they hold less than 93%: 1 of 1", words["sticking"])
        self.assertIn("a segment sticks or slides", words["sticking"])
        self.assertNotIn("too narrow, because", words["sliding"])

    def test_constraints_are_obeyed_and_named_where_they_clash(self):
        self.write("near.toml", ARM + CONSTRAINTS)
        answer = json.loads(self.run_capstan("place", "near.toml", "--json").stdout)
        for price in answer["prices"]:
            places = [sensor["place_m"] for sensor in price["sensors"] if sensor["kind"] == "tension"]
            if price["sensors"]:
                self.assertIn(0.8, [round(place, 9) for place in places])
            self.assertTrue(all(place > 0.3 for place in places))
        self.write("clash.toml", ARM + "\n[placement]\nforbidden_m = [0.7, 0.8]\nrequired_m = [0.8]\n")
        clash = self.run_capstan("place", "clash.toml", expect=2)
        self.assertIn("no set of sensors satisfies all constraints", clash.stderr)

    def test_rows_are_there_to_be_queried(self):
        self.run_capstan("study", "run", "arm.toml", "--db", "arm.db")
        rows = json.loads(self.run_capstan("query", "SELECT words, worlds, mean_abs_error_N FROM v_world_error WHERE condition = "
                                           "'as_stated' ORDER BY mean_abs_error_N", "--db", "arm.db", "--json").stdout)
        self.assertGreater(len(rows), 5)
        self.assertEqual(rows[-1]["words"], "no sensor")
        stored = json.loads(self.run_capstan("query", "SELECT * FROM world_recommendation", "--db", "arm.db", "--json").stdout)
        answer = json.loads(self.run_capstan("recommend", "--db", "arm.db", "--json").stdout)
        self.assertEqual(stored[0]["sentence"], answer["recommendations"][0]["sentence"])

    def test_a_stopped_study_goes_on_to_the_same_bits(self):
        self.run_capstan("study", "run", "arm.toml", "--repetitions", "60", "--db", "complete.db")
        process = self.start_capstan("study", "run", "arm.toml", "--repetitions", "60", "--db", "stopped.db", "--jobs", "1",
                                     "--progress", "json")
        process.stderr.readline()  # the first block of worlds is stored
        process.send_signal(signal.SIGINT)
        process.wait(60)
        self.run_capstan("study", "resume", "--db", "stopped.db")
        self.assert_same_bits(self.tables("complete.db"), self.tables("stopped.db"))

    def test_a_recorded_far_end_is_resumed_without_its_log(self):
        self.write("wrist.csv", "time_s,displacement_m\n" +
                   "".join(f"{0.01 * k:.2f},{0.001 * math.sin(0.05 * k):.7f}\n" for k in range(500)))
        words = self.run_capstan("place", "arm.toml", "--far-end", "wrist.csv").stdout
        self.assertIn("recorded in wrist.csv", " ".join(words.split()))
        self.run_capstan("study", "run", "arm.toml", "--far-end", "wrist.csv", "--db", "complete.db")
        self.write("recorded.toml", ARM.replace("far_end_range_m", 'far_end = "recorded"\nfar_end_log = "wrist.csv"\nfar_end_range_m'))
        process = self.start_capstan("study", "run", "recorded.toml", "--db", "stopped.db", "--jobs", "1", "--progress", "json")
        process.stderr.readline()  # the first block of worlds is stored
        process.send_signal(signal.SIGINT)
        process.wait(60)
        self.write("wrist.csv", "")
        self.run_capstan("study", "resume", "--db", "stopped.db")
        self.assert_same_bits(self.tables("complete.db"), self.tables("stopped.db"))

    def test_bad_values_are_refused_with_their_line(self):
        for key, wrong, message in (("friction_fraction", "-0.1", "friction_fraction"),
                                    ("members", "33", "multiple of 8"),
                                    ("far_end_bandwidth_Hz", "0", "far_end_bandwidth_Hz")):
            self.write("bad.toml", ARM.replace("members = 32", f"{key} = {wrong}"))
            refused = self.run_capstan("place", "bad.toml", expect=2)
            self.assertIn(message, refused.stderr)
            self.assertIn("bad.toml:", refused.stderr)
        self.write("beyond.toml", ARM.replace('noise_ratio = 0.03', 'noise_ratio = 0.03\nplaces_m = [0.9]'))
        self.assertIn("beyond the cable", self.run_capstan("place", "beyond.toml", expect=2).stderr)

    def test_the_shipped_configurations_are_valid(self):
        for name in ("wrist-exosuit", "elbow-exosuit", "flexible-endoscope"):
            self.run_capstan("config", "check", CONFIGS / f"{name}.toml")


if __name__ == "__main__":
    unittest.main()
