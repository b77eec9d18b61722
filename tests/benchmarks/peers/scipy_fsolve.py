#!/usr/bin/env python3
"""Races SciPy's fsolve on the steps of `capstan simulate` motions: steps a second, share converged, and
how far its tensions are from capstan's. See README.md.

    scipy_fsolve.py [--seconds S] CASE=MOTION.csv ...
"""
import argparse
import csv
import time
import warnings

import numpy as np
from scipy.optimize import fsolve

# The paper's Sec. III.B: Table I, 40 N of preload, a 40 N/m spring between the distal end and a wall.
LENGTH_M = 2.0
BEND_RADIUS_M = 0.28
AXIAL_STIFFNESS_N = 2000.0
DYNAMIC_FRICTION = 0.21
STATIC_FRICTION = 0.63
PRELOAD_N = 40.0
SPRING_N_PER_M = 40.0

CONVERGED_N = 1e-9
FIRST_STEP = 1001  # the second cycle, after the first has settled
STEPS_PER_CYCLE = 1000
STRIDE = 619  # prime to the cycle, near its golden section: any few steps lie evenly


class Motion:
    """States before and after every step, and which segments slid."""

    def __init__(self, path):
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        tension_columns = [name for name in rows[0] if name.startswith("tension_")]
        displacement_columns = [name for name in rows[0] if name.startswith("displacement_")]
        self.tension_N = np.array([[float(row[name]) for name in tension_columns] for row in rows])
        self.displacement_m = np.array([[float(row[name]) for name in displacement_columns] for row in rows])
        self.segments = len(tension_columns) - 1
        self.slid = np.zeros((len(rows), self.segments), dtype=bool)
        for slid, row in zip(self.slid, rows):
            slid[: max(int(row["proximal_moving_nodes"]) - 1, 0)] = True
            slid[self.segments - max(int(row["distal_moving_nodes"]) - 1, 0) :] = True


class Step:
    """One step as a nonlinear system: unknowns y_i, the shift of the middle of segment i over 2 h, in newtons.

    As engine/reference/generic_solver.h, without its treatment of E7 and E8.
    """

    def __init__(self, motion, step):
        segments = motion.segments
        self.before_N = motion.tension_N[step - 1]
        self.half_compliance_m_per_N = 0.5 * LENGTH_M / segments / AXIAL_STIFFNESS_N
        self.moved_m = motion.displacement_m[step, 0] - motion.displacement_m[step - 1, 0]
        wrap_rad = LENGTH_M / segments / BEND_RADIUS_M
        self.sliding_limit = np.tanh(0.5 * DYNAMIC_FRICTION * wrap_rad)
        breakaway_limit = np.tanh(0.5 * STATIC_FRICTION * wrap_rad)
        self.limit = np.where(motion.slid[step - 1], self.sliding_limit, breakaway_limit)
        self.spring_off_N = PRELOAD_N - SPRING_N_PER_M * motion.displacement_m[step - 1, -1] - self.before_N[-1]

    def tension_N(self, y_N):
        h = self.half_compliance_m_per_N
        change_N = np.empty(len(y_N) + 1)
        change_N[0] = 2.0 * y_N[0] - self.moved_m / h
        change_N[1:-1] = y_N[1:] - y_N[:-1]
        change_N[-1] = (self.spring_off_N - 2.0 * h * SPRING_N_PER_M * y_N[-1]) / (1.0 + h * SPRING_N_PER_M)
        return self.before_N + change_N

    def friction(self, y_N):
        tension_N = self.tension_N(y_N)
        return tension_N[1:] - tension_N[:-1], self.limit * (tension_N[1:] + tension_N[:-1])

    def residual_N(self, y_N):
        friction_N, most_N = self.friction(y_N)
        return friction_N - np.minimum(np.maximum(friction_N + y_N, -most_N), most_N)

    def start_N(self, start):
        segments = len(self.before_N) - 1
        if start == "warm":
            return np.zeros(segments)
        share = 1.0 - (np.arange(segments) + 0.5) / segments
        return share * self.moved_m / (2.0 * self.half_compliance_m_per_N)

    def solve(self, start):
        """Tensions, or None where fsolve does not converge."""
        y_N = self.start_N(start)
        while True:
            y_N, information, _, _ = fsolve(self.residual_N, y_N, xtol=1e-14, full_output=True)
            if not np.max(np.abs(information["fvec"])) <= CONVERGED_N:
                return None
            # Held by mu_s and yet sliding: mu_d from now on, and again.
            friction_N, most_N = self.friction(y_N)
            released = (np.abs(friction_N + y_N) >= most_N) & (self.limit > self.sliding_limit)
            if not released.any():
                return self.tension_N(y_N)
            self.limit[released] = self.sliding_limit


def race(motion, start, seconds):
    offset = steps = converged = 0
    spent_s = largest_difference_N = 0.0
    while spent_s < seconds:
        number = FIRST_STEP + offset
        step = Step(motion, number)
        began = time.perf_counter()
        with np.errstate(all="ignore"):
            tension_N = step.solve(start)
        spent_s += time.perf_counter() - began
        steps += 1
        offset = (offset + STRIDE) % STEPS_PER_CYCLE
        if tension_N is None:
            continue
        converged += 1
        difference_N = np.max(np.abs(tension_N - motion.tension_N[number]))
        largest_difference_N = max(largest_difference_N, difference_N)
    return steps / spent_s, converged / steps, largest_difference_N


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=2.0, help="for each case and start")
    parser.add_argument("motion", nargs="+", metavar="CASE=MOTION.csv")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    print("Steps a second of SciPy fsolve; share converged to 1e-9 N; largest difference to capstan.\n")
    print(f"{'case':5}  {'segments':>8}  {'start':>5}  {'steps/s':>11}  {'converged':>9}  {'difference':>12}")
    for named in arguments.motion:
        name, path = named.split("=", 1)
        motion = Motion(path)
        for start in ("warm", "kick"):
            rate, share, difference_N = race(motion, start, arguments.seconds)
            print(f"{name:5}  {motion.segments:>8}  {start:>5}  {rate:>11.3g}  {share:>9.1%}  {difference_N:>10.1e} N")


if __name__ == "__main__":
    main()
