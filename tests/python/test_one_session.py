"""One session from a cable to an observer of a bench, in the words in which a laboratory would write it."""

import os
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np

import capstan as cp
from surroundings import CONFIGS, shell

SESSION = """
cable = cp.Cable(length_m=2.0, bends=[cp.Bend(angle_deg=90, radius_m=0.08, at_m=0.6)], axial_stiffness_N=9e3, friction=0.12, segments=40)
path  = cable.simulate(motor_m=stroke, load=cp.Spring(3000.0), friction=mu_draws)
study = cp.Study("configs/wrist-exosuit.toml").run(db="results.db", progress=True)
study.recommend(); study.frame("v_best_method")
rec   = cp.read_recording("run7.mcap", mapping="import.toml"); rec.repairs
found = cp.diagnose(rec, fit_runs=[1, 3], hold_runs=[2, 4]); found.causes, found.closed, found.next_experiment
model = found.model; model.predict(rec); cp.place("my.toml", world=found)
obs   = model.observer(sensors=[("tension", 0.0), ("displacement", "load")]); obs.update(t, readings)
"""

MAPPING = """
[channels]
{channels}
[recording]
mode = "pull_pull"
nominal = {{ L = 1.2, R_profile = [{{ s0 = 0, s1 = 0.4 }}, {{ s0 = 0.4, s1 = 1.2, R = 0.5 }}], r_input = 0.02, r_load = 0.04, EA = 9000, mu_d = 0.12, mu_s = 0.12 }}
{runs}
"""


def shorter(config: str) -> str:
    """A shipped study over worlds with an eighth of the work."""
    text = (CONFIGS / f"{config}.toml").read_text()
    for usual, short in (("samples = 300", "samples = 40"), ("segments = 22", "segments = 8"), ("stop_s = 2.0", "stop_s = 0.3")):
        text = text.replace(usual, short)
    return text + "\n"


class OneSession(unittest.TestCase):
    def setUp(self) -> None:
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("pandas is missing")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        Path("configs").mkdir()
        Path("configs/wrist-exosuit.toml").write_text(shorter("wrist-exosuit"))
        Path("my.toml").write_text(shorter("elbow-exosuit"))
        # One log of eight seconds, whose quarters are the runs.
        shell("simulate", CONFIGS / "bench-viscous-fast.toml", "--sensor-noise", 0.001, "-o", "run7.mcap")
        units = {"motor_angle": "rad", "load_angle": "rad", "motor_torque": "N m", "load_torque": "N m"}
        channels = "".join(f'{name} = {{ table = "/run_1/{name}", column = "data", unit = "{unit}" }}\n' for name, unit in units.items())
        runs = "".join(
            f'[[runs]]\nfrom_s = {2 * k}\nto_s = {2 * k + 1.99}\nT0 = 20\noutput = "handle"\ndriven = ["load_angle", "motor_torque"]\n'
            for k in range(4)
        )
        Path("import.toml").write_text(MAPPING.format(channels=channels, runs=runs))

    def test_every_line_of_it_runs(self) -> None:
        names: dict[str, Any] = {
            "cp": cp,
            "stroke": 0.01 * (1 - np.cos(np.linspace(0, 4 * np.pi, 500))),
            "mu_draws": np.random.default_rng(1).uniform(0.08, 0.16, size=32),
            "t": 0.0,
            "readings": [0.0, 20.0, 0.0],
        }
        exec(SESSION, names)
        self.assertEqual(names["path"].tension_N.shape, (32, 500, 41))
        self.assertEqual([run.number for run in names["rec"].runs], [1, 2, 3, 4])
        self.assertEqual([cause.effect for cause in names["found"].causes], ["viscous_friction"])
        self.assertTrue(names["obs"].slack_members == 0 and names["obs"].not_used == ())


if __name__ == "__main__":
    unittest.main()
