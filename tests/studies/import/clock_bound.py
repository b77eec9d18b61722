"""How well a log can tell a torque's clock at all: the Cramér-Rao bound of its offset, for each bench of the import's trial.

    CAPSTAN=build/capstan CAPSTAN_CONFIGS=configs python3 tests/studies/import/clock_bound.py

The torque is explained by the other channels through weights that are not known: their values, elastic-plastic elements of
several yields, the speeds of angles. Only the part of the torque's derivative that these cannot explain tells the offset. The
noise is what the fit leaves, counted as fewer samples where it is correlated. The second bound takes the weights as known.
A better law of friction would leave less, and the bound would be lower.
"""

import pathlib
import tempfile

import numpy as np

import import_trial

YIELDS = (0.02, 0.06, 0.15, 0.3, 0.6)


def stop_element(values, limit):
    force = np.zeros_like(values)
    for k in range(1, len(values)):
        force[k] = min(max(force[k - 1] + values[k] - values[k - 1], -limit), limit)
    return force


def features(bench, channel):
    columns = [np.ones(len(bench.time))]
    for name, values in bench.channels.items():
        if name in (channel, "load_angle") or bench.is_constant(name):
            continue
        values = np.array(values)
        columns += [values, *(stop_element(values, part * np.ptp(values)) for part in YIELDS)]
        if import_trial.kind_of(name) == "angle":
            columns.append(np.gradient(values))
    return np.stack([column / (np.abs(column).max() or 1.0) for column in columns], axis=1)


def bounds_in_samples(bench, channel):
    known = features(bench, channel)
    torque = np.array(bench.channels[channel])
    project = lambda values: known @ np.linalg.lstsq(known, values, rcond=1e-9)[0]
    explained = project(torque)
    left = torque - explained
    correlation = np.dot(left[1:], left[:-1]) / np.dot(left, left)
    noise = left.std() / np.sqrt(min(1.0, (1.0 - correlation) / (1.0 + correlation)))
    slope = np.gradient(explained)
    seen = slope - project(slope)
    return noise / np.linalg.norm(seen), noise / np.linalg.norm(slope)


def main():
    with tempfile.TemporaryDirectory() as folder:
        for bench in import_trial.benches(pathlib.Path(folder)):
            unknown, known = bounds_in_samples(bench, "load_torque")
            print(f"{bench.name}: a sample is {1e3 / bench.rate:g} ms; standard deviation of the offset at least {unknown:.3f} samples, "
                  f"{known:.4f} with known weights")


if __name__ == "__main__":
    main()
