"""What the program writes as MATLAB file and MCAP is read back, number by number with its unit, by our readers and by others'."""
import csv
import json
import os
import shutil
import subprocess
import unittest
from pathlib import Path

import test_mcap_files  # installs @mcap/core
from written_log import WrittenLogTest, read_log

CAPSTAN = os.environ["CAPSTAN"]
RECORDINGS = Path(os.environ["CAPSTAN_CONFIGS"]) / "recordings"
ROS_TOPIC = r"^(/[A-Za-z_][A-Za-z0-9_]*)+$"  # by design.ros2.org/articles/topic_and_service_names.html, for "/topic.field" in a plot
UNITS = {"motor_torque": "N m", "motor_angle": "rad", "load_torque": "N m", "load_angle": "rad"}


def capstan(*words):
    run = subprocess.run([CAPSTAN, *map(str, words)], capture_output=True, text=True)
    if run.returncode != 0:
        raise AssertionError(run.stderr)
    return run.stdout


def columns_of(path):
    """Of each run: name -> numbers."""
    runs = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            name = f"run_{row.pop('run')}" + (f"/cable_{row.pop('cable')}" if "cable" in row else "")
            for column, value in row.items():
                runs.setdefault(name, {}).setdefault(column, []).append(float(value))
    return runs


class SeriesFiles(WrittenLogTest):
    def assert_close(self, got, expected, digits, what):
        """Texts have fewer digits than the files."""
        self.assertEqual(len(got), len(expected), what)
        for one, other in zip(got, expected):
            self.assertLessEqual(abs(one - other), 10.0 ** -digits * abs(other) + 1e-14, what)

    def matlab(self, path):
        try:
            from scipy.io import loadmat
        except ImportError:
            self.skipTest("python3-scipy is missing")
        return {name: value for name, value in loadmat(path, simplify_cells=True).items() if not name.startswith("__")}

    def mcap(self, path):
        test_mcap_files.install()
        shutil.copy(Path(__file__).resolve().parent / "read_mcap.mjs", test_mcap_files.WORK)
        run = subprocess.run(["node", str(test_mcap_files.WORK / "read_mcap.mjs"), str(path)], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def written(self, ending):
        """The model's prediction as text and in another form."""
        text, other = self.folder / "model.csv", self.folder / f"model.{ending}"
        for path in (text, other):
            capstan("simulate", RECORDINGS / "viscous-pair.csv", "-o", path)
        return columns_of(text), other

    def test_a_prediction_in_matlab(self):
        expected, path = self.written("mat")
        own = read_log(path)
        self.assertEqual(own.remarks, "")
        read = self.matlab(path)
        self.assertEqual(list(read), ["run_1", "run_2"])
        for run, columns in expected.items():
            self.assertEqual(set(read[run]), {*columns, "units"})
            self.assertEqual(read[run]["units"], {"t": "s", **UNITS})
            self.assertEqual(own.units[run], {"t": "s", **UNITS})
            for name, values in columns.items():
                self.assert_close(list(read[run][name]), values, 8, name)
                self.assertEqual(own.tables[run][name], list(read[run][name]), name)

    def test_a_prediction_in_mcap(self):
        expected, path = self.written("mcap")
        own = read_log(path)
        self.assertEqual(own.remarks, "")
        for run, columns in expected.items():
            for name in UNITS:
                topic = f"/{run}/{name}"
                self.assertEqual(own.units[topic], {"log_time": "", "data": UNITS[name]})
                self.assert_close(own.tables[topic]["data"], columns[name], 8, topic)
                self.assert_close(own.tables[topic]["log_time"], columns["t"], 9, topic)
        read = self.mcap(path)
        self.assertEqual(set(read["topics"]), set(own.tables))
        for name, topic in read["topics"].items():
            self.assertEqual((topic["schema"], topic["definition"], topic["encoding"]), ("std_msgs/msg/Float64", "ros2msg", "cdr"))
            self.assertRegex(name, ROS_TOPIC)
            self.assertEqual(topic["unit"], UNITS[name.split("/")[-1]])
            self.assertEqual(topic["value"], own.tables[name]["data"])
            self.assertEqual(topic["counted"], len(topic["value"]))
            self.assert_close(own.tables[name]["log_time"], [time / 1e9 for time in topic["time_ns"]], 15, name)
        self.assertEqual(read["profile"], "ros2")
        self.assertEqual(read["messages"], sum(topic["counted"] for topic in read["topics"].values()))
        self.assertEqual((read["first_ns"], read["last_ns"]), (0, round(1e9 * max(max(columns["t"]) for columns in expected.values()))))

    def test_a_long_file_has_several_chunks(self):
        path = self.folder / "tensions.mcap"
        capstan("estimate", RECORDINGS / "single-cable.csv", "--members", 8, "--segments", 40, "-o", path)
        read = self.mcap(path)
        self.assertGreater(read["chunks"], 1)
        own = read_log(path)
        for name, topic in read["topics"].items():
            self.assertEqual(topic["unit"], "N")
            self.assertRegex(name, ROS_TOPIC)
            self.assertEqual(topic["value"], own.tables[name]["data"])

    def test_estimated_tensions(self):
        text = self.folder / "tensions.csv"
        files = {ending: self.folder / f"tensions.{ending}" for ending in ("mat", "mcap")}
        for path in (text, *files.values()):
            capstan("estimate", RECORDINGS / "single-cable.csv", "--members", 8, "--segments", 6, "-o", path)
        mat, mcap = read_log(files["mat"]), read_log(files["mcap"])
        seen = 0
        for run, columns in columns_of(text).items():
            variable = run.replace("/", "_").replace(" ", "_")
            self.assertEqual(set(mat.units[variable].values()), {"s", "N"})
            for name, values in columns.items():
                if name == "t":
                    continue
                channel = name.removesuffix("_N")
                topic = mcap.tables[f"/{run}/{channel.replace('.', '_')}"]["data"]
                self.assert_close(topic, values, 5 if channel.startswith("tension") else 3, channel)
                self.assertEqual(mat.tables[variable][channel.replace(".", "_")], topic, channel)
                seen += 1
        self.assertEqual(seen, 14)

    def test_the_corrected_prediction_of_a_diagnosis(self):
        files = {ending: self.folder / f"prediction.{ending}" for ending in ("csv", "mat", "mcap")}
        answers = [capstan("diagnose", RECORDINGS / "viscous-pair.csv", "--prediction", path, "--progress", "none") for path in files.values()]
        self.assertIn("iscous", answers[0])
        mat, mcap = read_log(files["mat"]), read_log(files["mcap"])
        for run, columns in columns_of(files["csv"]).items():
            self.assertEqual(set(columns), {"t", "motor_angle", "load_torque"})
            for name in ("motor_angle", "load_torque"):
                self.assert_close(mat.tables[run][name], columns[name], 8, name)
                self.assertEqual(mcap.tables[f"/{run}/{name}"]["data"], mat.tables[run][name])
                self.assertEqual((mat.units[run][name], mcap.units[f"/{run}/{name}"]["data"]), (UNITS[name], UNITS[name]))

    def test_the_same_bytes_again_and_nothing_where_it_fails(self):
        for ending in ("mat", "mcap"):
            _, path = self.written(ending)
            first = path.read_bytes()
            self.written(ending)
            self.assertEqual(path.read_bytes(), first, ending)
            nowhere = self.folder / "absent" / f"model.{ending}"
            run = subprocess.run([CAPSTAN, "simulate", RECORDINGS / "viscous-pair.csv", "-o", nowhere], capture_output=True, text=True)
            self.assertNotEqual(run.returncode, 0)
            self.assertIn("absent", run.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir() if path.suffix == ".part"], [])


del WrittenLogTest  # its tests are those of the classes that are made of it
if __name__ == "__main__":
    unittest.main()
