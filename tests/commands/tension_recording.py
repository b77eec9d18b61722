"""A recording of one cable with three tension sensors, whose readings are the model's own tensions and noise.

usage: tension_recording.py CAPSTAN FOLDER writes FOLDER/b.csv and FOLDER/b.json
"""

import csv
import json
import math
import pathlib
import random
import subprocess
import sys

SENSORS = {"tension_1": 0.2, "tension_2": 1.1, "tension_3": 1.8}
SIDECAR = {
    "case": "three sensors", "schema": 1, "mode": "single_cable", "sample_rate_hz": 100,
    "units": {"t": "s", "motor_angle": "rad"} | {name: "N" for name in SENSORS},
    "nominal": {"L": 2.0, "R_profile": [{"s0": 0, "s1": 2, "R": 0.8}], "r_input": 0.02, "r_load": 0.104, "K": 2000.0,
                "mu_d": 0.21, "mu_s": 0.21},
    "nominal_units": {"L": "m", "R": "m", "r_input": "m", "r_load": "m", "K": "N/m (end to end, one cable)", "T0": "N"},
    "noise_std": {name: 0.25 for name in SENSORS},
    "encoder_step": {"motor_angle": 0.00016},
    "tension_sensors": [{"channel": name, "cable": "A", "s": place} for name, place in SENSORS.items()],
    "runs": [{"run": 1, "protocol": "single_sine", "t_session_start": 0.0, "duration": 6.0, "T0": 25,
              "output": "locked", "driven": ["motor_angle"]}],
}
HEAD = ["run", "t", "motor_angle", *SENSORS]


def write(folder, rows, sidecar=SIDECAR):
    lines = [",".join(HEAD)] + [",".join(f"{value:.6g}" for value in row) for row in rows]
    (folder / "b.csv").write_text("\n".join(lines) + "\n")
    (folder / "b.json").write_text(json.dumps(sidecar))


def make(program, folder):
    angles = [0.2 * math.sin(2 * math.pi * k / 200) for k in range(600)]
    write(folder, [[1, k / 100, angle, 25 + 0.1 * (k % 2), 25 + 0.1 * (k % 5), 25 + 0.1 * (k % 3)] for k, angle in enumerate(angles)])
    subprocess.run([program, "simulate", "b.csv", "-o", "model.csv"], cwd=folder, check=True, capture_output=True)
    with open(folder / "model.csv", newline="") as lines:
        model = list(csv.DictReader(lines))
    noise = random.Random(7)
    write(folder, [[1, k / 100, angles[k], *(float(row[name]) + noise.gauss(0, 0.25) for name in SENSORS)]
                   for k, row in enumerate(model)])


if __name__ == "__main__":
    make(sys.argv[1], pathlib.Path(sys.argv[2]))
