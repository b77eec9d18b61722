"""The bench of the gallery: every cause in every experiment, simulated by the program."""

import csv
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

# mu_s = mu_d: the model with effects has no stiction.
BENCH = """kind = "bench"
name = "gallery"
sample_rate_Hz = 100
duration_s = {duration_s}

[cable]
segments = 30
pretension_N = {pretension_N}
dynamic_friction = {friction}
static_friction = {friction}
axial_stiffness_N = {stiffness_N}

[[cable.curvature]]
length_m = 0.4

[[cable.curvature]]
angle_deg = 165
bend_radius_m = 0.12

[[cable.curvature]]
length_m = 0.45

[pulleys]
motor_radius_m = 0.02
load_radius_m = 0.02
"""
NUMBERS = {"duration_s": 8.0, "pretension_N": 20.0, "friction": 0.12, "stiffness_N": 9000.0}
SLOW = 'input = "angle"\nwaveform = "sines"\namplitudes_rad = [0.5]\nfrequencies_Hz = [0.25]\nphases_rad = [0.0]\n'
SPRING = 'input = "spring"\nstiffness_Nm_per_rad = 0.6\nwaveform = "constant"\nlevel_rad = 0.0\n'
# title -> (motor, load, other numbers), in the order of the tables; the first is what a laboratory records first.
EXPERIMENTS = {
    "slow cycles against a spring": (SLOW, SPRING, {}),
    "fast cycles against a spring": (SLOW.replace("0.25", "2.0"), SPRING, {}),
    "strokes of changing length": (
        'input = "angle"\nwaveform = "sines"\namplitudes_rad = [0.3, 0.2]\nfrequencies_Hz = [0.5, 0.375]\nphases_rad = [0.0, 0.0]\n',
        SPRING, {}),
    "steps with dwells": ('input = "angle"\nwaveform = "steps"\nlevels_rad = [0.25, 0.5, 0.0, -0.5]\nhold_s = 2.0\n', SPRING, {}),
    "slow cycles, load locked": (SLOW, 'input = "locked"\n', {}),
    "the hand moves the load, motor held": (
        'input = "angle"\nwaveform = "constant"\nlevel_rad = 0.0\n',
        'input = "handle"\nwaveform = "sines"\namplitudes_rad = [0.3]\nfrequencies_Hz = [0.5]\nphases_rad = [0.0]\n', {}),
    "slow cycles, 1.5 times the pretension": (SLOW, SPRING, {"pretension_N": 30.0}),
    "slow cycles for 40 s": (SLOW, SPRING, {"duration_s": 40.0}),
}
FIRST = next(iter(EXPERIMENTS))
OUTPUTS = ("motor_torque", "load_torque", "load_angle")
WRONG_NUMBERS = {"param_mu": ("friction", 1.3), "param_K": ("stiffness_N", 0.7), "param_T0": ("pretension_N", 0.85)}
# The same solver without an effect: an effect that does nothing.
NOTHING = "\n[effect.viscous_friction]\ndrag_N_s_per_m2 = 1e-9\n"


def section_of(effect, factor=1.0):
    """The effect at so many times its typical size, as a configuration has it."""
    lines = [f"[{effect['section']}]"]
    for parameter in effect["parameters"]:
        value = parameter["typical"]
        if parameter["is_size"]:
            value = parameter["absent"] + factor * (value - parameter["absent"])
            value = max(value, parameter["low"] if parameter["low"] is not None else value)
            value = min(value, parameter["high"] if parameter["high"] is not None else value)
        lines.append(f"{parameter['key']} = {value:g}")
    return "\n" + "\n".join(lines) + "\n"


def config(experiment, effect="", numbers=None):
    motor, load, others = EXPERIMENTS[experiment]
    values = {**NUMBERS, **others}
    for name, factor in (numbers or {}).items():
        values[name] *= factor
    viscous = "" if "[effect.viscous_friction]" in effect else NOTHING
    return BENCH.format(**values) + "\n[motor]\n" + motor + "\n[load]\n" + load + viscous + effect


class Bench:
    """Simulates; a result is {channel: array (times)}."""

    def __init__(self, program, folder):
        self.program, self.folder = program, Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def simulate(self, name, text):
        file = self.folder / f"{name}.toml"
        file.write_text(text)
        done = subprocess.run([self.program, "simulate", file], capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{file}: {done.stderr}")
        rows = list(csv.reader(done.stdout.splitlines()))
        return {name: np.array([float(row[k]) for row in rows[1:]]) for k, name in enumerate(rows[0])}

    def resized(self, experiment, cause, effect, size):
        """An experiment with a cause at `size` times the size that all() gave it; `effect` is None for a wrong number."""
        if effect is None:
            number, factor = WRONG_NUMBERS[cause]
            text = config(experiment, numbers={number: min(max(1.0 + size * (factor - 1.0), 0.1), 10.0)})
        else:
            text = config(experiment, section_of(effect, size * effect["factor"]))
        return self.simulate(f"resized-{cause}-{list(EXPERIMENTS).index(experiment)}-{size:.6g}", text)

    def all(self, effects):
        """{experiment: {cause: channels}}; the cause "" is the bench without one. Causes are sections or names. An effect gets a "factor"
        of its typical size at which its loop is seen."""
        causes = {"": {}}
        causes.update({effect["section"]: {"effect": section_of(effect)} for effect in effects})
        causes.update({name: {"numbers": {number: factor}} for name, (number, factor) in WRONG_NUMBERS.items()})
        results = self.simulations(causes)
        larger = {}
        for effect in effects:
            effect["factor"] = factor_to_see(results, effect["section"])
            if effect["factor"] != 1.0:
                larger[effect["section"]] = {"effect": section_of(effect, effect["factor"])}
        for experiment, found in self.simulations(larger).items():
            results[experiment].update(found)
        return results

    def simulations(self, causes):
        jobs = [(e, cause) for e in EXPERIMENTS for cause in causes]
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            found = list(pool.map(lambda job: self.simulate(
                f"{list(EXPERIMENTS).index(job[0])}-{job[1] or 'ideal'}", config(job[0], **causes[job[1]])), jobs))
        results = {experiment: {} for experiment in EXPERIMENTS}
        for (experiment, cause), channels in zip(jobs, found):
            results[experiment][cause] = channels
        return results


def factor_to_see(results, cause, visible=0.05):
    """1, 3, 10, ...: the first at which some channel changes by a twentieth of its span (RMS) in some experiment."""
    change = 0.0
    for causes in results.values():
        for channel in OUTPUTS:
            span = float(np.ptp(causes[""][channel]))
            if span > 1e-9:
                change = max(change, float(np.std(causes[cause][channel] - causes[""][channel])) / span)
    return next((factor for factor in (1.0, 3.0, 10.0, 30.0) if factor * change >= visible), 30.0)
