"""Recordings as people meet them: templates, checks, keys, and a log of one's own brought in by the messages alone."""

import json
import math
import unittest

from capstan_program import CONFIGS, CapstanTest

KINDS = ("pull_pull", "single_cable", "lumped_drive", "band")


class Described(CapstanTest):
    def samples(self, columns):
        rows = [[1, k / 200] + [math.sin(k / 40 + j) for j in range(len(columns))] for k in range(400)]
        return "run,t," + ",".join(columns) + "\n" + "".join(",".join(map(str, row)) + "\n" for row in rows)

    def test_every_template_is_a_valid_recording_once_there_are_samples(self):
        for kind in KINDS:
            with self.subTest(kind):
                self.run_capstan("recording", "template", "--kind", kind, "-o", "bench.json")
                sidecar = json.loads((self.folder / "bench.json").read_text())
                self.write("bench.csv", self.samples([name for name in sidecar["units"] if name != "t"]))
                self.assertIn("can be used", self.run_capstan("recording", "check", "bench").stdout)

    def test_a_missing_key_with_a_default_takes_it_and_says_so(self):
        self.write("bench.csv", self.samples(["motor_angle", "motor_torque", "load_angle", "load_torque"]))
        self.write("bench.json", '{"mode": "lumped_drive"}')
        said = self.run_capstan("recording", "check", "bench", "--json").stdout
        assumed = json.loads(said)["assumptions"]
        for key in ("sample_rate_hz", "units", "runs"):
            self.assertTrue(any(key in words for words in assumed), (key, assumed))

    def test_stiffness_is_stated_as_ea_or_end_to_end_or_sought_but_not_stated_twice(self):
        template = json.loads(self.run_capstan("recording", "template").stdout)
        self.write("bench.csv", self.samples([name for name in template["units"] if name != "t"]))
        template["nominal"]["K"] = 4500
        self.write("bench.json", json.dumps(template))
        self.assertIn("both stated", self.run_capstan("recording", "check", "bench", expect=2).stdout)
        del template["nominal"]["K"], template["nominal"]["EA"]
        self.write("bench.json", json.dumps(template))
        self.assertIn("nominal.K or nominal.EA is missing; EA is taken as 15811 N; a diagnosis seeks it from 500 to 500000 N", self.run_capstan("recording", "check", "bench").stdout)

    def test_what_takes_nominal_numbers_as_they_are_refuses_ranges(self):
        template = json.loads(self.run_capstan("recording", "template").stdout)
        self.write("bench.csv", self.samples([name for name in template["units"] if name != "t"]))
        template["nominal"]["mu_d"] = [0.05, 0.2]
        self.write("bench.json", json.dumps(template))
        for command, instead in (("simulate", "--parameters"), ("duty", "--parameters"), ("estimate", "--model")):
            said = self.run_capstan(command, "bench.csv", expect=2).stderr
            self.assertIn("the sidecar gives no value of nominal.mu_d", said)
            self.assertIn(instead, said)

    def test_equal_problems_are_told_once(self):
        self.write("bench.json", '{"mode": "lumped_drive", "runs": [{"run": 2}]}')
        self.write("bench.csv", self.samples(["motor_angle", "motor_torque", "load_angle", "load_torque"]))
        said = self.run_capstan("recording", "check", "bench", expect=2).stdout
        self.assertIn("400 lines", said)
        self.assertLess(len(said.splitlines()), 16)

    def test_a_table_without_a_description_says_how_to_get_one(self):
        self.write("bench.csv", self.samples(["motor_angle"]))
        for command in (("calibrate",), ("diagnose",), ("duty",), ("estimate",), ("simulate",)):
            said = self.run_capstan(*command, "bench.csv", expect=2).stderr
            self.assertIn("capstan recording template", said)
            self.assertIn("capstan import", said)

    def test_the_page_of_keys_is_the_programs(self):
        self.assertEqual(self.run_capstan("recording", "keys", "--format", "md").stdout.rstrip(),
                         (CONFIGS / "recordings" / "KEYS.md").read_text().rstrip())

    def test_the_schema_knows_every_key(self):
        schema = json.loads(self.run_capstan("recording", "schema").stdout)
        keys = json.loads(self.run_capstan("recording", "keys", "--json").stdout)["keys"]
        self.assertEqual({key["name"] for key in keys if key["section"] == "top"}, set(schema["properties"]))
        self.assertIn("mode", schema["required"])


class OneOwnLog(CapstanTest):
    """The shipped pair, as a laboratory would have logged it: other names, degrees, milliseconds, a sign of its own."""

    def setUp(self):
        super().setUp()
        lines = (CONFIGS / "recordings" / "viscous-pair.csv").read_text().splitlines()
        columns = lines[0].split(",")
        rows = [dict(zip(columns, map(float, line.split(",")))) for line in lines[1:]]
        for run in (1, 2):
            text = "Time (ms);Input torque (mN m);Input angle (deg);Output torque (N m);Output angle (deg)\n"
            for row in rows:
                if row["run"] == run:
                    text += ";".join(f"{value:.6f}" for value in (
                        1e3 * row["t"], 1e3 * row["motor_torque"], math.degrees(row["motor_angle"]), row["load_torque"],
                        -math.degrees(row["load_angle"]))) + "\n"
            self.write(f"run{run}.csv", text)

    def test_the_suggestion_finds_channels_units_and_the_sign(self):
        self.run_capstan("import", "--suggest", "run1.csv", "run2.csv", "--kind", "pull_pull", "-o", "import.toml")
        mapping = (self.folder / "import.toml").read_text()
        self.assertIn('time = { column = "Time", unit = "ms" }', mapping)
        self.assertIn('motor_angle = { column = "Input angle", unit = "deg" }', mapping)
        self.assertIn('load_angle = { column = "Output angle", unit = "deg", sign = -1 }', mapping)
        self.assertIn('motor_torque = { column = "Input torque", unit = "mN m" }', mapping)
        self.assertIn('load_torque = { column = "Output torque", unit = "N m"', mapping)
        self.assertIn("DOUBTFUL: every number of the bench", mapping)

    def test_the_list_of_columns_says_what_was_left_out_and_assumed(self):
        self.write("dates.csv", "when;phase;x\n01.05.2024 10:00:00;go;1\n01.05.2024 10:00:01;stop;2\n")
        listed = self.run_capstan("import", "--list", "dates.csv").stdout
        self.assertIn("A column of text is left out: phase", listed)
        self.assertIn("01.05.2024 10:00:00, taken as 2024-05-01 with the day first: a guess", listed)

    def test_from_the_log_to_the_verdict_of_the_converted_recording(self):
        self.run_capstan("import", "--suggest", "run1.csv", "run2.csv", "--kind", "pull_pull", "-o", "import.toml")
        mapping = (self.folder / "import.toml").read_text()
        # What the person at the bench knows and the program cannot.
        head, bench = mapping.split("[recording]")
        sidecar = json.loads((CONFIGS / "recordings" / "viscous-pair.json").read_text())
        nominal = sidecar["nominal"]
        pieces = ", ".join("{ " + ", ".join(f"{key} = {value}" for key, value in piece.items()) + " }" for piece in nominal["R_profile"])
        numbers = ", ".join(f"{key} = {value}" for key, value in nominal.items() if key != "R_profile")
        runs = bench[bench.index("[[runs]]"):].replace("T0 = 30.0", 'T0 = 20.0\noutput = "handle"')
        head = head.replace("sign = -1, clock_offset_s", "clock_offset_s")
        self.write("import.toml", f'{head}[recording]\nmode = "pull_pull"\nnominal = {{ {numbers}, R_profile = [{pieces}] }}\n\n{runs}')
        report = json.loads(self.run_capstan("import", "run1.csv", "run2.csv", "-o", "mine", "--html", "mine.html", "--json").stdout)
        self.assertIn("the channels of the recording", (self.folder / "mine.html").read_text())
        self.assertFalse([finding for finding in report["findings"] if finding["repaired"]])
        verdict = json.loads(self.run_capstan("diagnose", "mine.csv", "--json", "--progress", "none").stdout)
        converted = json.loads(self.run_capstan("diagnose", CONFIGS / "recordings" / "viscous-pair.csv", "--json", "--progress", "none").stdout)
        for answer in (verdict, converted):  # the log's noise is estimated, the recording's is stated
            self.assertEqual(answer["ranked"][0]["effect"], "viscous_friction")
            self.assertGreater(answer["ranked"][0]["probability"], 0.8)

    def test_without_a_mapping_the_message_says_how_to_get_one(self):
        said = self.run_capstan("import", "run1.csv", "-o", "mine", expect=2).stderr
        self.assertIn("capstan import --suggest", said)
        said = self.run_capstan("import", "--suggest", "run1.csv", "--mapping", "import.toml", expect=2).stderr
        self.assertIn("give one of the two", said)

    def test_strict_repairs_nothing(self):
        text = (self.folder / "run1.csv").read_text().splitlines()
        text.insert(50, text[50])
        self.write("twice.csv", "\n".join(text) + "\n")
        self.run_capstan("import", "--suggest", "twice.csv", "--kind", "lumped_drive", "-o", "import.toml")
        self.run_capstan("import", "twice.csv", "-o", "mine")
        self.assertIn("repairs nothing", self.run_capstan("import", "twice.csv", "-o", "other", "--strict", expect=2).stderr)
        self.assertFalse((self.folder / "other.csv").exists())


if __name__ == "__main__":
    unittest.main()
