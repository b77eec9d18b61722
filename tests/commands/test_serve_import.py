"""From a laboratory's log to a verdict through the service: a mapping is proposed, edited, tried and used."""

import csv
import glob
import json
import math
import os
import tempfile
import unittest

from capstan_program import CONFIGS
from capstan_service import ServiceTest

RECORDING = CONFIGS / "recordings" / "viscous-pair"
NOMINAL = json.loads(RECORDING.with_suffix(".json").read_text())


def laboratory_logs():
    """The runs of the recording as a laboratory has them: other names, degrees and milliseconds."""
    logs = {}
    with open(RECORDING.with_suffix(".csv"), newline="") as file:
        for row in csv.DictReader(file):
            text = logs.setdefault(f"run_{row['run']}.csv", ["Zeit [ms],Motor torque (Nm),Motor position [deg],"
                                                             "Joint torque (Nm),Joint position [deg]"])
            text.append(f"{1000 * float(row['t']):.3f},{row['motor_torque']},"
                        f"{math.degrees(float(row['motor_angle'])):.10g},"
                        f"{row['load_torque']},{math.degrees(float(row['load_angle'])):.10g}")
    return [("log", (name, ("\n".join(lines) + "\n").encode())) for name, lines in logs.items()]


def toml_value(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml_value(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    return json.dumps(value)


def with_the_bench(mapping):
    """The mapping with the numbers of the bench instead of placeholders, as a person enters them."""
    lines = [line for line in mapping.splitlines() if not line.startswith(("nominal", "T0"))]
    at = lines.index("[recording]")
    lines.insert(at + 1, "nominal = " + toml_value(NOMINAL["nominal"]))
    lines.insert(at + 2, "noise_std = " + toml_value(NOMINAL["noise_std"]))
    text = "\n".join(lines) + "\n"
    for run in ("run_1.csv", "run_2.csv"):
        text = text.replace(f'file = "{run}"', f'file = "{run}"\nT0 = 20.0\noutput = "handle"\n'
                                               'driven = ["motor_torque", "load_angle"]')
    return text


class ServeImport(ServiceTest):
    def setUp(self):
        super().setUp()
        self.serve()
        self.logs = laboratory_logs()

    def suggest(self, logs, kind="pull_pull", expect=200):
        return self.upload([*logs, ("kind", ("", kind.encode()))], expect, "/api/import/suggestion")

    def edit(self, mapping, expect=200, **change):
        return self.post("/api/import/mapping", {"mapping": mapping, "edit": change}, expect)

    def test_the_suggestion_shows_columns_and_guesses(self):
        suggested = self.suggest(self.logs)
        self.assertEqual([(file["file"], file["same_columns_as"]) for file in suggested["files"]],
                         [("run_1.csv", ""), ("run_2.csv", "run_1.csv")])
        columns = {column["column"]: column for column in suggested["columns"]}
        self.assertEqual(columns["Motor position"]["unit"], "deg")
        self.assertEqual(columns["Zeit"]["rows"], 801)
        for column in columns.values():
            self.assertTrue(10 < len(column["drawn_row"]) == len(column["drawn_value"]) <= 500, column["column"])
            self.assertEqual((min(column["drawn_value"]), max(column["drawn_value"])),
                             (column["smallest"], column["largest"]))
        channels = {channel["name"]: (channel["column"], channel["unit"]) for channel in suggested["channels"]}
        self.assertEqual(channels, {"motor_angle": ("Motor position", "deg"), "load_angle": ("Joint position", "deg"),
                                    "motor_torque": ("Motor torque", "N m"), "load_torque": ("Joint torque", "N m")})
        self.assertTrue(all(guess["reason"] and guess["doubt"] in ("note", "likely", "doubtful")
                            for guess in suggested["guesses"]))
        self.assertIn("motor_angle", [guess["about"] for guess in suggested["guesses"]])
        self.assertIn("load_angle", [role["name"] for role in suggested["roles"]])
        self.assertIn("deg", suggested["units"])
        self.assertEqual(suggested["problems"], [])
        at_the_shell = []
        for _, (name, content) in self.logs:
            at_the_shell.append(self.write(name, content.decode()))
        words = self.run_capstan("import", "--suggest", *at_the_shell, "--kind", "pull_pull").stdout
        self.assertEqual(suggested["mapping"], words)

    def test_an_edit_changes_one_channel_and_keeps_comments(self):
        mapping = self.suggest(self.logs)["mapping"]
        by_hand = mapping.replace("[recording]\n", "# measured on Monday\n[recording]\n") + "# the end\n"
        by_hand = by_hand.replace("load_torque = ", "# DOUBTFUL: the sign\n# of a cell by hand\nload_torque = ")
        by_hand = by_hand.replace("\n\n", "\n# DOUBTFUL: a trial import fails: without a channel\n\n", 1)
        edited = self.edit(by_hand, channel="load_torque", sign=-1, zero=0.25)
        load = [channel for channel in edited["channels"] if channel["name"] == "load_torque"][0]
        self.assertEqual((load["column"], load["sign"], load["zero"]), ("Joint torque", -1, 0.25))
        changed = set(edited["mapping"].splitlines()) ^ set(by_hand.splitlines())
        gone = {line for line in changed if line.startswith("# ")}  # the guesses that it answers
        self.assertEqual({line.split(" = ")[0] for line in changed - gone}, {"load_torque"})
        self.assertTrue({"# DOUBTFUL: the sign", "# DOUBTFUL: a trial import fails: without a channel"} <= gone, gone)
        self.assertTrue(all(line in by_hand and line not in edited["mapping"] for line in gone), gone)
        self.assertIn("# of a cell by hand\nload_torque", edited["mapping"])
        self.assertIn('the name "Motor position" fits', edited["mapping"])
        self.assertEqual(self.post("/api/import/mapping", {"mapping": edited["mapping"]}), edited)

        swapped = self.edit(by_hand, channel="motor_angle", column="Joint position", table="", file="")
        motor = [channel for channel in swapped["channels"] if channel["name"] == "motor_angle"][0]
        self.assertEqual((motor["column"], motor["unit"]), ("Joint position", "deg"))
        self.assertNotIn('the name "Motor position" fits', swapped["mapping"])

        text = by_hand
        for channel in ("motor_angle", "load_angle", "motor_torque", "load_torque"):
            last = self.edit(text, channel=channel, remove=True)
            text = last["mapping"]
        self.assertTrue(last["problems"])  # a mapping without a channel can be edited, but not used
        again = self.edit(text, channel="tension_1", column="Joint torque", unit="N")
        self.assertEqual([channel["name"] for channel in again["channels"]], ["tension_1"])
        self.assertIn("# measured on Monday", again["mapping"])

        clock = self.edit(by_hand, channel="time", column="Zeit", unit="s")
        self.assertEqual(clock["time"], {"column": "Zeit", "unit": "s"})

    def test_a_mapping_that_cannot_be_read_says_why(self):
        read = self.post("/api/import/mapping", {"mapping": "[channels]\nmotor_angle = { column = 'a', units = 'deg' }\n"})
        self.assertRegex(read["problems"][0], r"^import\.toml:2: channels\.motor_angle\.units")
        self.edit("this is no TOML", expect=400, channel="motor_angle", column="a")
        for change in ({"channel": ""}, {"channel": "a", "sign": 2}, {"channel": "a", "column": 3}, {"column": "a"}):
            self.post("/api/import/mapping", {"mapping": "", "edit": change}, 400)

    def test_a_trial_is_that_of_the_shell(self):
        mapping = with_the_bench(self.suggest(self.logs)["mapping"])
        tried = self.upload([*self.logs, ("mapping", ("", mapping.encode()))], 200, "/api/import/trial")
        files = [self.write(name, content.decode()) for _, (name, content) in self.logs]
        shell = json.loads(self.run_capstan("import", *files, "--mapping", self.write("import.toml", mapping), "--try",
                                            "--json").stdout)
        for key in ("runs", "channels", "samples", "sample_rate_hz"):
            self.assertEqual(tried[key], shell[key], key)
        self.assertEqual({(curve["run"], curve["channel"]) for curve in tried["curves"]},
                         {(run, channel) for run in (1, 2) for channel in shell["channels"]})
        self.assertEqual([run["samples"] for run in tried["runs"]], [801, 801])

        bad = mapping.replace("Motor position", "Motor angle").replace("Joint position", "Joint angle")
        refused = self.upload([*self.logs, ("mapping", ("", bad.encode()))], 400, "/api/import/trial")["error"]
        self.assertEqual(len(refused.splitlines()), 4, refused)  # two channels in two files
        self.assertTrue(all("Motor position" in line or "Joint position" in line for line in refused.splitlines()), refused)
        self.assertNotIn(tempfile.gettempdir(), refused)

    def test_from_a_log_to_a_verdict(self):
        mapping = with_the_bench(self.suggest(self.logs)["mapping"])
        job = self.upload([*self.logs, ("mapping", ("", mapping.encode()))], 202, "/api/import/diagnosis")
        self.assertEqual((job["kind"], job["title"]), ("diagnosis", "run_1.csv"))
        done = self.await_job(job["job"], "done")
        diagnosis = self.get("/api/diagnoses")[0]
        self.assertEqual(diagnosis["diagnosis_id"], done["diagnosis_id"])
        self.assertEqual(diagnosis["verdict"], "viscous_friction", diagnosis)

    def test_files_stay_in_their_folder_and_are_removed(self):
        name, content = self.logs[0][1]
        for given in (f"../../{name}", f"/etc/{name}", f"..\\{name}"):
            listed = self.suggest([("log", (given, content))])["files"]
            self.assertEqual([file["file"] for file in listed], [name])
        hidden = self.suggest([("log", (".hidden*.csv", content))])["files"]
        self.assertEqual(hidden[0]["file"], "_hidden_.csv")
        self.suggest([("log", (name, content)), ("log", ("elsewhere/" + name, content))], expect=400)
        self.suggest([("log", (f"{k}.csv", content)) for k in range(33)], expect=413)
        self.suggest([], expect=400)
        self.suggest([("log", ("a.bin", bytes(range(256)) * 20))], expect=400)
        self.suggest([("log", (name, content))], kind="--strict", expect=200)
        self.upload(self.logs, 400, "/api/import/trial")
        left = glob.glob(os.path.join(tempfile.gettempdir(), "capstan-import-*"))
        self.assertEqual(left, [])


if __name__ == "__main__":
    unittest.main()
