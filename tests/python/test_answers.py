"""What the objects of the module say of themselves, and what they hold."""

import json
import pickle
import tempfile
import unittest
from typing import Any

import numpy as np

import capstan as cp
from surroundings import CONFIGS, RECORDINGS, small_cable


class Answers(unittest.TestCase):
    folder: Any
    study: cp.Study
    found: cp.Diagnosis

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.study = cp.Study(CONFIGS / "quick.toml").run(db=cls.folder.name + "/results.db", repetitions=20)
        cls.found = cp.diagnose(RECORDINGS / "viscous-pair.csv")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.folder.cleanup()

    def test_every_object_says_what_it_is(self) -> None:
        path = small_cable().simulate(motor_m=[0.0, 0.001], friction=[0.1, 0.2])
        observer = cp.Observer(small_cable(), sensors=[("tension", 0.0)], noise_N=0.1)
        recording = cp.read_recording(RECORDINGS / "single-cable")
        for value, words in (
            (small_cable(), "Cable(length_m=1.2, bends=1"),
            (path, "Path(draws=2, times=2, nodes=13, tension"),
            (observer, "Observer(sensors=[('tension', 0.0)])"),
            (recording, "Recording('single-cable', single_cable, 1 run at"),
            (recording.runs[0], "Run(1, samples="),
            (self.study, "Study('"),
            (cp.Study(CONFIGS / "quick.toml"), "not run"),
            (self.study.recommend(), self.study.recommend().headline),
            (self.found, "viscous friction"),
        ):
            self.assertIn(words, repr(value))

    def test_a_notebook_shows_the_page_of_the_report(self) -> None:
        shown = self.found._repr_html_()
        self.assertTrue(shown.startswith("<iframe srcdoc="))
        self.assertNotIn('"', shown[len('<iframe srcdoc="') : shown.rindex('" style=')])
        self.assertIn("<html", self.found.html())

    def test_an_answer_has_every_form(self) -> None:
        answer = self.study.recommend()
        self.assertEqual(json.loads(answer.json()), answer.values)
        self.assertIn("|", answer.markdown())
        self.assertIn(",", answer.csv())
        self.assertEqual(str(answer), answer.text())

    def test_a_view_is_a_table_of_pandas(self) -> None:
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is missing")
        best = self.study.frame("v_best_method")
        self.assertIsInstance(best, pandas.DataFrame)
        self.assertEqual(set(best["study_id"]), set(self.study.study_ids))
        counted = self.study.frame("SELECT count(*) AS n FROM v_best_method")
        self.assertEqual(list(counted["n"]), [len(best)])

    def test_the_best_methods_of_uncertain_worlds_are_their_sets_of_sensors(self) -> None:
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("pandas is missing")
        with tempfile.TemporaryDirectory() as folder:
            study = cp.Study(CONFIGS / "noise-sweep.toml").run(db=f"{folder}/results.db", repetitions=20)
            best = study.frame("v_best_method")
        self.assertEqual(set(best["method"]), {"ensemble_filter"})
        self.assertEqual(list(best["family"][best["sensor_count"] == 0]), ["no sensor"])
        self.assertTrue((best["interval_low_N"] <= best["mean_abs_error_N"]).all())

    def test_a_query_changes_nothing(self) -> None:
        with self.assertRaises(cp.Error):
            self.study.query("DELETE FROM study")

    def test_a_diagnosis_names_its_causes(self) -> None:
        cause = self.found.causes[0]
        self.assertEqual((cause.effect, cause.component), ("viscous_friction", "conduit"))
        self.assertGreater(cause.probability, 0.5)
        drag = cause.numbers["drag"]
        assert drag.interval_95 is not None
        self.assertTrue(drag.interval_95.low < drag.value < drag.interval_95.high)
        self.assertAlmostEqual(sum(self.found.probabilities.values()), 1.0, places=9)
        for closed in self.found.closed.values():
            self.assertLessEqual(closed.fraction, 1.0)

    def test_a_recording_gives_its_samples_without_a_copy(self) -> None:
        recording = cp.read_recording(RECORDINGS / "viscous-pair.csv")
        angle_rad = recording.runs[0]["motor_angle"]
        self.assertFalse(angle_rad.flags.owndata or angle_rad.flags.writeable)
        again = recording.run(recording.runs[0].number)["motor_angle"]
        self.assertEqual(angle_rad.__array_interface__["data"], again.__array_interface__["data"])
        before = angle_rad.copy()
        del recording, again
        np.testing.assert_array_equal(angle_rad, before)  # the array keeps the recording

    def test_errors_say_where_and_what(self) -> None:
        recording = cp.read_recording(RECORDINGS / "viscous-pair.csv")
        for call, words in (
            (lambda: cp.read_recording("nowhere.csv"), "nowhere"),
            (lambda: recording.run(99), "there is no run 99"),
            (lambda: recording.runs[0]["tilt"], "there is no channel 'tilt'"),
            (lambda: cp.Study("nowhere.toml"), "nowhere.toml"),
            (lambda: cp.Study("[cable]\nlenght = 1\n"), "the text:"),
            (lambda: cp.Study(CONFIGS / "quick.toml").recommend(), "has not been run"),
            (lambda: cp.diagnose(recording, fit_runs=[1], hold_runs=[1]), "run 1 is both in fit and in hold"),
            (lambda: cp.diagnose(recording, runs=[99]), "there is no run 99"),
            (lambda: cp.place(CONFIGS / "quick.toml", noise="loud"), "no noise level 'loud'"),
            (lambda: cp.place(CONFIGS / "quick.toml", world=self.found), "needs a configuration with [uncertainty]"),
            (lambda: small_cable().simulate(motor_m=[0.0], load="spring"), "load: is 'spring'"),  # type: ignore[arg-type]
            (lambda: small_cable().simulate(motor_m=[0.0], jobs=-1), "jobs: is -1, but must be 0 to 1024"),
        ):
            with self.assertRaises(cp.Error) as refused:
                call()
            self.assertIn(words, str(refused.exception))
            self.assertTrue(refused.exception.problems)

    def test_a_cable_can_be_sent_to_another_process(self) -> None:
        cable = pickle.loads(pickle.dumps(small_cable(static_friction=0.2)))
        self.assertEqual(repr(cable), repr(small_cable(static_friction=0.2)))
        one, two = (each.simulate(motor_m=[0.001, 0.003]) for each in (cable, small_cable(static_friction=0.2)))
        self.assertEqual(one.tension_N.tobytes(), two.tension_N.tobytes())

    def test_an_error_can_be_sent_to_another_process(self) -> None:
        error = pickle.loads(pickle.dumps(cp.Error(["one", "two"])))
        self.assertEqual(error.problems, ["one", "two"])


    def test_a_model_predicts_channels_and_makes_a_cable(self) -> None:
        recording = cp.read_recording(RECORDINGS / "viscous-pair.csv")
        model = self.found.model
        judged = model.predict(recording)
        run = recording.runs[0]
        predicted = judged.samples(run.number, "load_torque")
        nominal = judged.samples(run.number, "load_torque", of="nominal")
        assert predicted is not None and nominal is not None
        measured = run["load_torque"]
        self.assertLess(np.std(predicted - measured), np.std(nominal - measured))
        self.assertIsNone(judged.samples(run.number, "load_angle"))  # it drives the model
        self.assertGreater(model.cable(pretension_N=30.0).places_m[-1], 0.1)
        observer = model.observer(sensors=[("tension", 0.0), ("displacement", "load")], noise_N=0.2, pretension_N=30.0)
        mean_N, low_N, high_N = observer.update(time_s=0.0, readings=[0.0, 30.0, 0.0])
        self.assertEqual(mean_N.shape, (13,))

    def test_an_observer_of_a_model_needs_nothing_but_its_sensors(self) -> None:
        observer = self.found.model.observer(sensors=[("tension", 0.0), ("displacement", "load")])
        mean_N, low_N, high_N = observer.update(0.0, [0.0, 30.0, 0.0])
        self.assertTrue((low_N < mean_N).all() and (mean_N < high_N).all())
        # The pretension is that of the recording's runs as the model corrects it, the noise that of its torques.
        stated_N = json.loads((RECORDINGS / "viscous-pair.json").read_text())["runs"][0]["T0"]
        self.assertAlmostEqual(self.found.model.cable().pretension_N, self.found.model.cable(pretension_N=stated_N).pretension_N, places=9)
        self.assertEqual(observer.not_used, ())

    def test_an_observer_of_a_model_has_its_friction_and_says_what_it_leaves_out(self) -> None:
        def observer(speed_dependent: bool) -> cp.Observer:
            return self.found.model.observer(
                sensors=[("displacement", "load")], load_wander_m=0.0, speed_dependent=speed_dependent
            )

        plain, by_speed = observer(False), observer(True)
        self.assertIn("viscous friction", plain.not_used)
        self.assertIn("not_used", repr(plain))
        # A load that moves away fast, its drag on the way: less tension reaches the motor than in a plain cable.
        ends_N = []
        for each in (plain, by_speed):
            for sample in range(5):
                mean_N = each.update(0.01 * sample, [-0.001 * sample, 0.0012 * sample])[0]
            ends_N.append(mean_N[-1] - mean_N[0])
        self.assertGreater(ends_N[1], ends_N[0] + 0.01)

    def test_a_model_without_a_noise_asks_for_one(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/model.toml"
            self.found.model.save(file)
            with open(file) as saved:
                text = [line for line in saved if not line.startswith("tension_noise_N")]
            with open(file, "w") as changed:
                changed.writelines(text)
            model = cp.read_model(file)
        with self.assertRaises(cp.Error) as refused:
            model.observer(sensors=[("tension", 0.0)])
        self.assertIn("noise_N", str(refused.exception))

    def test_friction_that_depends_on_speed_is_checked(self) -> None:
        with self.assertRaises(cp.Error) as refused:
            cp.Observer(
                small_cable(), sensors=[("tension", 0.0)], noise_N=0.1,
                rate_friction=cp.RateFriction(drag_N_s_per_m2=-5.0, extra_friction=0.05, speed_m_per_s=0.0),
            )
        self.assertEqual(len(refused.exception.problems), 2)


class Observers(unittest.TestCase):
    def test_a_sensor_corrects_the_tension_where_it_is(self) -> None:
        motor_m = 0.004 * np.sin(np.arange(400) / 40.0)
        truth_N = small_cable(friction=0.15).simulate(motor_m=motor_m).tension_N[0]
        model = small_cable(friction=0.10)
        model_N = model.simulate(motor_m=motor_m).tension_N[0]
        observer = cp.Observer(
            model, sensors=[("tension", 1.2), ("displacement", "load")], noise_N=0.1, motor_wander_m=1e-5
        )
        error_N = []
        for time, position_m in enumerate(motor_m):
            mean_N, low_N, high_N = observer.update(0.001 * time, [position_m, truth_N[time, -1], 0.0])
            self.assertTrue((low_N <= mean_N).all() and (mean_N <= high_N).all())
            error_N.append(abs(mean_N[-1] - truth_N[time, -1]))
        self.assertLess(np.mean(error_N), 0.1 * np.mean(np.abs(model_N - truth_N)[:, -1]))

    def test_what_it_gave_stays(self) -> None:
        observer = cp.Observer(small_cable(), sensors=[("tension", 0.0)], noise_N=0.1)
        first = observer.update(0.0, (0.001, 21.0))[0]
        before = first.copy()
        observer.update(1.0, np.array([0.003, 25.0]))
        np.testing.assert_array_equal(first, before)

    def test_bad_samples_are_refused_and_change_nothing(self) -> None:
        observer, other = (cp.Observer(small_cable(), sensors=[("tension", 0.0)], noise_N=0.1) for _ in range(2))
        observer.update(0.0, [0.001, 21.0])
        other.update(0.0, [0.001, 21.0])
        nan = float("nan")
        for time_s, readings in ((0.0, [0.0, 1.0]), (nan, [0.0, 1.0]), (1.0, [nan, 1.0]), (1.0, [0.0]), (1.0, "ab")):
            with self.assertRaises(cp.Error):
                observer.update(time_s, readings)
        for one, two in zip(observer.update(1.0, [0.002, 23.0]), other.update(1.0, [0.002, 23.0]), strict=True):
            np.testing.assert_array_equal(one, two)


if __name__ == "__main__":
    unittest.main()
