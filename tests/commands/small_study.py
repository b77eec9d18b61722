"""A study of a few dozen units that runs in a moment, for tests that run it again and again."""

import re
import sqlite3

from capstan_program import CONFIGS

UNITS = 24  # of the study below: two stages, twelve pairs of an instant and a noise level

SMALL_STUDY = """
name = "small"
repetitions = 20
seed = {seed}

[transmission]
segments = 6
axial_stiffness_N = 2000
dynamic_friction = 0.2
static_friction = 0.3
pretension_N = 10

[[transmission.curvature]]
length_m = 0.7
bend_radius_m = 0.2

[motion]
sample_rate_Hz = 100
samples = 100

[motion.proximal]
amplitude_m = 0.003
frequency_Hz = 1

[[regime]]
name = "mass"
samples = [15, 18, 21, 39, 42, 45]
duty_fraction = 1

[[noise]]
label = "5 %"
multiplicative_ratio = 0.05

[[noise]]
label = "0.2 N"
additive_N = 0.2

[layouts]
families = "all"
counts = [1, 2, 3]
"""


def short_worlds(config="wrist-exosuit", samples=40):
    """A shipped study over worlds with a shorter motion, an eighth of the work: what changes a bit changes it early."""
    text = (CONFIGS / f"{config}.toml").read_text()
    return re.sub(r"^stop_s = .*", "stop_s = 0.3", re.sub(r"^samples = .*", f"samples = {samples}", text, flags=re.M), flags=re.M)


def integrity(path):
    """What SQLite says of the file, after it has played back what a killed writer left."""
    connection = sqlite3.connect(path, timeout=60)
    try:
        return [row[0] for row in connection.execute("PRAGMA integrity_check")] + \
               [str(row) for row in connection.execute("PRAGMA foreign_key_check")]
    finally:
        connection.close()
