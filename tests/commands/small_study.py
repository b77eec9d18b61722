"""A study of a few dozen units that runs in a moment, for tests that run it again and again."""

import sqlite3

from capstan_program import CONFIGS

BACK_TO_VERSION_3 = CONFIGS.parent / "tests" / "storage" / "back_to_version_3.sql"
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


def to_version_1(path):
    """What the first schema had, with the rows as they are: an older file to be migrated."""
    connection = sqlite3.connect(path)
    connection.executescript("PRAGMA foreign_keys = OFF;" + BACK_TO_VERSION_3.read_text())
    connection.execute("DROP VIEW v_diagnosis")
    for (table,) in connection.execute("SELECT name FROM sqlite_schema WHERE type = 'table' AND name LIKE 'diagnosis%'").fetchall():
        connection.execute(f"DROP TABLE {table}")
    connection.execute("DROP TABLE shard")
    for column in ("quantisation_N", "range_N"):
        connection.execute(f"ALTER TABLE noise_level DROP COLUMN {column}")
    connection.execute("PRAGMA user_version = 1")
    connection.commit()
    connection.execute("PRAGMA journal_mode = DELETE")
    connection.close()


def integrity(path):
    """What SQLite says of the file, after it has played back what a killed writer left."""
    connection = sqlite3.connect(path, timeout=60)
    try:
        return [row[0] for row in connection.execute("PRAGMA integrity_check")] + \
               [str(row) for row in connection.execute("PRAGMA foreign_key_check")]
    finally:
        connection.close()
