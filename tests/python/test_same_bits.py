"""What Python gets is what the shell prints, to the bit."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import capstan as cp
from surroundings import CONFIGS, RECORDINGS, shell

LOG = RECORDINGS / "viscous-pair.csv"


class SameBits(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_a_study_and_everything_that_it_stores(self) -> None:
        study = cp.Study(CONFIGS / "quick.toml").run(db=self.folder / "python.db", repetitions=40)
        words = ("study", "run", CONFIGS / "quick.toml", "--repetitions", 40, "--progress", "none", "--json")
        self.assertEqual(study.recommend().json(), shell(*words, "--db", self.folder / "shell.db"))
        for view in ("v_best_method", "v_error_by_layout", "v_recommendation"):
            sql = f"SELECT * FROM {view}"
            rows = [shell("query", sql, "--format", "csv", "--db", self.folder / name) for name in ("python.db", "shell.db")]
            self.assertEqual(*rows)

    def test_a_sweep(self) -> None:
        config = self.folder / "sweep.toml"
        config.write_text((CONFIGS / "quick.toml").read_text() + "\n[sweep]\nfriction_ratio = [0.5, 1]\n")
        study = cp.Study(config).run(db=self.folder / "python.db", repetitions=10)
        shell("study", "run", config, "--repetitions", 10, "--progress", "none", "--db", self.folder / "shell.db")
        self.assertEqual(len(study.study_ids), 2)
        with self.assertRaises(cp.Error):
            study.recommend()
        for study_id in study.study_ids:
            printed = shell("recommend", study_id, "--db", self.folder / "shell.db", "--json")
            self.assertEqual(study.recommend(study_id).json(), printed)

    def test_a_study_over_worlds(self) -> None:
        text = (CONFIGS / "wrist-exosuit.toml").read_text().replace("samples = 300", "samples = 40").replace("stop_s = 2.0", "stop_s = 0.3")
        config = self.folder / "short.toml"
        config.write_text(text)
        study = cp.Study(text).run(db=self.folder / "python.db", repetitions=20)
        words = ("study", "run", config, "--repetitions", 20, "--progress", "none", "--json")
        self.assertEqual(study.recommend().json(), shell(*words, "--db", self.folder / "shell.db"))

    def test_a_search_of_all_layouts(self) -> None:
        answer = cp.place(CONFIGS / "quick.toml", repetitions=40, runners_up=5)
        words = ("place", CONFIGS / "quick.toml", "--repetitions", 40, "--runners-up", 5)
        self.assertEqual(answer.json(), shell(*words, "--json"))
        self.assertEqual(answer.text(), shell(*words))

    def test_a_diagnosis_of_all_runs_and_an_advice_about_what_it_found(self) -> None:
        found = cp.diagnose(LOG)
        self.assertEqual(found.json(), shell("diagnose", LOG, "--json", "--progress", "none"))
        found.store(self.folder / "found.db", log=LOG)
        config = self.folder / "short.toml"
        text = (CONFIGS / "elbow-exosuit.toml").read_text()
        config.write_text(text.replace("samples = 300", "samples = 40").replace("segments = 22", "segments = 8"))
        answer = cp.place(config, world=found, repetitions=20)
        words = ("place", config, "--from-diagnosis", 1, "--repetitions", 20)
        self.assertEqual(answer.json(), shell(*words, "--db", self.folder / "found.db", "--progress", "none", "--json"))

    def test_a_diagnosis_of_some_runs_its_model_and_what_it_predicts(self) -> None:
        recording = cp.read_recording(LOG)
        held_out = cp.diagnose(recording, fit_runs=[1], hold_runs=[2])
        files = ("--corrected", self.folder / "corrected.toml", "--save", self.folder / "shell.toml")
        printed = shell("diagnose", LOG, "--fit", 1, "--hold", 2, "--json", *files, "--progress", "none")
        self.assertEqual(held_out.json(), printed)
        self.assertEqual(held_out.corrected_model(), (self.folder / "corrected.toml").read_text())
        self.assertEqual(held_out.model.text(), (self.folder / "shell.toml").read_text())
        held_out.model.save(self.folder / "python.toml")
        for judge in (held_out.model, cp.read_model(self.folder / "python.toml")):
            judged = judge.predict(recording, runs=[2])
            words = ("simulate", LOG, "--model", self.folder / "shell.toml", "--runs", 2)
            self.assertEqual(judged.json(), shell(*words, "--json"))

    def test_an_import(self) -> None:
        log = self.folder / "log.csv"
        log.write_bytes((RECORDINGS / "viscous-pair.csv").read_bytes())
        mapping = self.folder / "import.toml"
        shell("import", "--suggest", log, "--kind", "pull_pull", "-o", mapping)
        imported = cp.read_recording(log, mapping=mapping)
        shell("import", log, "--mapping", mapping, "-o", self.folder / "bench")
        by_shell = cp.read_recording(self.folder / "bench")
        self.assertEqual(imported.channels, by_shell.channels)
        for run in by_shell.runs:
            for channel in by_shell.channels:
                self.assertEqual(run[channel].tobytes(), imported.run(run.number)[channel].tobytes())

    def test_an_observer_in_c(self) -> None:
        cable = cp.Cable(
            length_m=1.2, bends=[cp.Bend(90, 0.08, 0.2), cp.Bend(120, 0.1, 0.6)], axial_stiffness_N=9e3, friction=0.12,
            static_friction=0.15, pretension_N=20.0, segments=12,
        )
        sensors: list[cp.observer.Sensor] = [("tension", 0.05), ("displacement", "load"), ("tension", 1.2)]
        observer = cp.Observer(cable, sensors=sensors, noise_N=0.25)
        printed = subprocess.run([os.environ["CAPSTAN_PRINT_ESTIMATES"]], capture_output=True, text=True, check=True)
        of_c = np.array([[float.fromhex(word) for word in line.split()] for line in printed.stdout.splitlines()])
        for sample in range(1, 201):
            turn = (sample % 100) / 100.0
            readings = [0.003 * turn * (1.0 - turn), 20.0 + 30.0 * turn * (1.0 - turn), 0.0002 * turn, 19.0 + 12.0 * turn]
            estimate = observer.update(sample / 500.0, readings)
            self.assertTrue(np.array_equal(np.array(estimate).T, of_c[13 * (sample - 1) : 13 * sample]), sample)


if __name__ == "__main__":
    unittest.main()
