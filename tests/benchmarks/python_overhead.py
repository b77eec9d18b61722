"""What a call from Python costs beyond the same call from C++ (processor time, which other work on the machine changes
little), how two threads compare with one, and how long Ctrl-C takes. Run by hand: PYTHONPATH=build/python /usr/bin/python3 tests/benchmarks/python_overhead.py build"""

import math
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np

import capstan as cp

ROUNDS = 9


def shortest_s(times, work, clock=time.perf_counter):
    best = math.inf
    for _ in range(times):
        start = clock()
        work()
        best = min(best, clock() - start)
    return best


def batch():
    cable = cp.Cable(length_m=2.0, bends=[cp.Bend(90, 0.08, 0.6)], axial_stiffness_N=9e3, friction=0.12, pretension_N=20.0)
    motor_m = 0.01 * np.sin(0.02 * np.arange(1000))
    friction = 0.05 + 0.001 * np.arange(128)
    return lambda: cable.simulate(motor_m=motor_m, load=cp.Spring(3000.0), friction=friction, jobs=1)


def update_s():
    cable = cp.Cable(length_m=1.2, bends=[cp.Bend(180, 0.1, 0.3)], axial_stiffness_N=9e3, friction=0.1, pretension_N=20.0, segments=12)
    samples = [(float(k), [0.002 * math.sin(0.01 * k), 20.0 + 5.0 * math.sin(0.01 * k)]) for k in range(2000)]

    def work():
        update = cp.Observer(cable, sensors=[("tension", 0.0)], noise_N=0.2).update
        for time_s, readings in samples:
            update(time_s, readings)

    return shortest_s(15, work, time.process_time) / len(samples)


def in_two_threads(work):
    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def interrupted_s(call):
    """From the signal to the KeyboardInterrupt."""
    sent = []

    def interrupt():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Timer(1.0, interrupt).start()
    try:
        while True:
            call()
    except KeyboardInterrupt:
        return time.perf_counter() - sent[0]


def study(name, repetitions):
    with tempfile.TemporaryDirectory() as folder:
        cp.Study(f"configs/{name}.toml").run(db=f"{folder}/results.db", repetitions=repetitions)


def main(build):
    work = batch()
    pairs = []
    for _ in range(ROUNDS):  # side by side, so that what else runs on the machine meets both
        cpp = [float(s) for s in subprocess.run([f"{build}/tests/benchmarks/cable_calls"], capture_output=True, text=True, check=True).stdout.split()]
        pairs.append((cpp, [shortest_s(15, work, time.process_time), update_s()]))
    for name, of in (("least", min), ("median", statistics.median)):
        cpp, python = (tuple(of(pair[side][k] for pair in pairs) for k in (0, 1)) for side in (0, 1))
        print(f"{name} of {ROUNDS}: batch of 128 draws x 1000 times x 41 nodes, one thread: C++ {1e3 * cpp[0]:.1f} ms, Python {1e3 * python[0]:.1f} ms, {100 * (python[0] / cpp[0] - 1):+.1f}%")
        print(f"{name} of {ROUNDS}: observer update, 12 segments, 32 members: C++ {1e6 * cpp[1]:.2f} us, Python {1e6 * python[1]:.2f} us, {1e6 * (python[1] - cpp[1]):+.2f} us")
    many = lambda: [work() for _ in range(12)]  # 0.5 s: threads that begin may share a processor for a moment
    # In turn, and the shortest of many: other work on the machine leaves both processors free now and then.
    turns = [(shortest_s(1, many), shortest_s(1, lambda: in_two_threads(many))) for _ in range(25)]
    one, two = (min(turn[k] for turn in turns) for k in (0, 1))
    print(f"two threads in Python: {2 * one / two:.2f} times one ({os.cpu_count()} processors)")
    for name, call in (
        ("diagnose", lambda: cp.diagnose("configs/recordings/viscous-pair.csv")),
        ("place", lambda: cp.place("configs/wrist-exosuit.toml", repetitions=10000)),
        ("place at instants", lambda: cp.place("configs/paper.toml", repetitions=10000)),
        ("simulate", work),
        ("study.run over worlds", lambda: study("wrist-exosuit", 10000)),
        ("study.run at instants", lambda: study("noise-instants", 100000)),
        ("study.run of long units", lambda: study("atlas", 100000)),
    ):
        print(f"Ctrl-C in {name}: {1e3 * max(interrupted_s(call) for _ in range(3)):.0f} ms, the longest of 3")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "build")
