"""Statistics with a known answer, asked of the program as its users ask: how errors shrink with more repetitions, how often an
interval covers, what is left of each method's error when the sensors have next to no noise."""

import collections
import contextlib
import math
import sqlite3
import unittest

from capstan_program import CONFIGS, CapstanTest

CALM = """
name = "calm sensors"
repetitions = 40
[motion.proximal]
amplitude_m = 0.01
[[regime]]
name = "mass"
samples = [50]
duty_fraction = 0.5
[[regime]]
name = "partial_proximal"
samples = [6]
duty_fraction = 0.5
[layouts]
explicit = [[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]]
[estimation]
curve_points = {points}
[[noise]]
label = "tiny"
additive_N = {noise_N}
"""
MOVING = """
name = "moving output"
repetitions = 20
[motion.proximal]
amplitude_m = 0.02
[motion.distal]
amplitude_m = 0.01
[[regime]]
name = "mass"
samples = [35, 48, 62, 98, 143]
duty_fraction = 1
[estimation]
distal_side = "admitted"
curve_points = 1024
[[noise]]
label = "tiny"
additive_N = 1e-7
"""
# Of the feasible curve, whose methods need no guess at directions.
CURVE_METHODS = ("maximum_likelihood", "posterior_mean")


class KnownAnswers(CapstanTest):
    def cells(self, db, columns):
        """{(regime, noise, nodes, method): row}"""
        with contextlib.closing(sqlite3.connect(self.folder / db)) as connection:
            rows = connection.execute(
                f"SELECT scenario_index, noise_index, nodes, method, {columns} FROM cell JOIN scenario USING (scenario_id) "
                "JOIN noise_level USING (noise_level_id) JOIN sensor_set USING (sensor_set_id)").fetchall()
        return {row[:4]: row[4:] for row in rows}

    def run_quick(self, repetitions, seed):
        db = f"quick-{repetitions}-{seed}.db"
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--repetitions", repetitions, "--seed", seed, "--db", db)
        return self.cells(db, "mean_abs_error_N, standard_error_N, interval_low_N, interval_high_N")

    def test_errors_scatter_with_one_over_the_root_of_repetitions(self):
        """From seed to seed, and by the program's own standard error, which agree with each other."""
        seeds = range(1, 31)
        scatter, stated = {}, {}
        for repetitions in (50, 200, 800):
            studies = [self.run_quick(repetitions, seed) for seed in seeds]
            variances, own = [], []
            for key in studies[0]:
                means = [study[key][0] for study in studies]
                average = sum(means) / len(means)
                variances.append(sum((mean - average) ** 2 for mean in means) / (len(means) - 1))
                own.append(sum(study[key][1] ** 2 for study in studies) / len(studies))
            scatter[repetitions] = sum(variances) / len(variances)
            stated[repetitions] = sum(own) / len(own)
            print(f"{repetitions} repetitions: scatter of a mean {math.sqrt(scatter[repetitions]):.5f} N, "
                  f"stated {math.sqrt(stated[repetitions]):.5f} N")
        # A variance from 30 seeds is known to a quarter, if all cells moved as one; they do not quite.
        for few, many in ((50, 200), (200, 800)):
            self.assertLess(abs(math.log(scatter[few] / scatter[many] / 4)), math.log(1.8))
            self.assertLess(abs(math.log(stated[few] / stated[many] / 4)), math.log(1.1))
        for repetitions in scatter:
            self.assertLess(abs(math.log(scatter[repetitions] / stated[repetitions])), math.log(1.6))

    def test_intervals_cover(self):
        truth = self.run_quick(40000, 1000)
        covered = total = 0
        by_method = collections.Counter()
        for seed in range(1, 61):
            for key, (_, _, low, high) in self.run_quick(200, seed).items():
                total += 1
                inside = low <= truth[key][0] <= high
                covered += inside
                by_method[key[3], inside] += 1
        print(f"{covered} of {total} intervals at 95% cover: {covered / total:.3f}")
        for method in sorted({method for method, _ in by_method}):
            share = by_method[method, True] / (by_method[method, True] + by_method[method, False])
            print(f"  {method}: {share:.3f}")
            self.assertGreater(share, 0.90, method)
        # Cells of one study share their readings, so that 60 seeds count, not all cells: 95% give or take 2.8% at two sigma.
        self.assertGreater(covered / total, 0.92)
        self.assertLess(covered / total, 0.98)

    def calm(self, noise_N, points=128):
        db = f"calm-{noise_N}-{points}.db"
        config = self.write(f"{db}.toml", CALM.format(noise_N=noise_N, points=points))
        self.run_capstan("study", "run", config, "--db", db)
        return self.cells(db, "mean_abs_error_N, cell.bias_N, unverified_fraction, ambiguous_fraction")

    def test_with_the_directions_known_the_error_goes_with_the_noise(self):
        before = None
        for noise_N in (1e-2, 1e-4, 1e-6):
            errors = [row[0] for key, row in self.calm(noise_N).items() if key[0] == 0 and key[3] == "mean_known"]
            print(f"noise {noise_N} N, direction known: {max(errors):.2e} N at worst over {len(errors)} layouts")
            self.assertLess(max(errors), 3 * noise_N)
            if before:
                self.assertAlmostEqual(max(errors) * 100 / before, 1, delta=0.02)  # 100 times less noise
            before = max(errors)
        for key, row in self.calm(0.0).items():
            if key[0] == 0 and key[3] == "mean_known":
                self.assertLess(row[0], 1e-9, key)

    def test_on_the_feasible_curve_only_its_grid_is_left(self):
        """With a sensor at every node, eight times the points leave an eighth of the error; no method is better than its model."""
        every_node = "[1,2,3,4,5,6,7,8,9,10,11]"
        for method in CURVE_METHODS:
            for instant, regime in enumerate(("mass", "partial_proximal")):
                errors = []
                for points in (128, 1024, 8192):
                    errors.append(self.calm(1e-7, points)[instant, 0, every_node, method][0])
                print(f"{method}, {regime}: {', '.join(f'{error:.1e}' for error in errors)} N with 128, 1024, 8192 points")
                self.assertLess(errors[2], 2e-3)
                self.assertLess(errors[2], max(errors[0] / 16, 1e-6))

    def test_a_moving_output_leaves_no_method_biased(self):
        """Where the whole cable slides and its output too, every guess at directions is verified and plain, and right."""
        config = self.write("moving.toml", MOVING)
        self.run_capstan("study", "run", config, "--db", "moving.db")
        worst = collections.defaultdict(float)
        for (_, _, _, method), (error_N, bias_N, unverified, ambiguous) in self.cells(
                "moving.db", "mean_abs_error_N, cell.bias_N, unverified_fraction, ambiguous_fraction").items():
            self.assertEqual((unverified, ambiguous), (0, 0))
            worst[method] = max(worst[method], error_N)
        for method, error_N in sorted(worst.items()):
            print(f"{method}: {error_N:.1e} N at worst with noise of 1e-7 N")
            self.assertLess(error_N, 1e-2 if method in CURVE_METHODS else 1e-6, method)

    def test_what_is_left_of_each_method_without_noise(self):
        """At a blocked output the published methods keep an error that no better sensor takes away; the tables flag each such cell."""
        cells = self.calm(1e-7, 8192)
        worst = collections.defaultdict(float)
        for (instant, _, _, method), (error_N, bias_N, unverified, ambiguous) in cells.items():
            worst[method, instant] = max(worst[method, instant], abs(bias_N))
            if method in ("mean", "mean_r", "w_mean", "w_mean_r") and error_N > 1e-4:
                self.assertGreater(unverified + ambiguous, 0, f"{instant} {method}")
        for (method, instant), bias_N in sorted(worst.items()):
            print(f"{method}, {('mass', 'partial_proximal')[instant]}: bias at worst {bias_N:.1e} N without noise")


if __name__ == "__main__":
    unittest.main()
