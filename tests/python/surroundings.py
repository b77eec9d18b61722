"""What the tests of the Python module share."""

import os
import subprocess
from pathlib import Path
from typing import Any

import capstan as cp

SOURCE = Path(os.environ["CAPSTAN_SOURCE"])
CONFIGS = SOURCE / "configs"
RECORDINGS = CONFIGS / "recordings"


def shell(*words: object, folder: object = None) -> str:
    """What the program prints for these words."""
    done = subprocess.run(
        [os.environ["CAPSTAN"], *map(str, words)], capture_output=True, text=True, cwd=folder, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def small_cable(**changed: Any) -> cp.Cable:
    """A bent cable of 12 segments."""
    numbers: dict[str, Any] = {
        "length_m": 1.2,
        "bends": [cp.Bend(angle_deg=180, radius_m=0.1, at_m=0.3)],
        "axial_stiffness_N": 9e3,
        "friction": 0.12,
        "pretension_N": 20.0,
        "segments": 12,
    }
    return cp.Cable(**{**numbers, **changed})
