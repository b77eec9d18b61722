"""Long calls: other threads run meanwhile, Ctrl-C stops them, progress is told."""

import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import capstan as cp
from surroundings import CONFIGS, RECORDINGS, small_cable

INTERRUPTED = """
import os, signal, sys, threading
import numpy as np
import capstan as cp

signal.signal(signal.SIGINT, signal.default_int_handler)  # it is ignored where the tests run in the background

def interrupt(*_):
    global interrupt
    interrupt = lambda *_: None
    os.kill(os.getpid(), signal.SIGINT)

try:
    {call}
except KeyboardInterrupt:
    print("interrupted")
"""
CALLS = {
    "diagnose": "cp.diagnose('{recordings}/viscous-pair.csv', progress=lambda *_: interrupt())",
    "place": "cp.place('{configs}/wrist-exosuit.toml', repetitions=100000, progress=lambda *_: interrupt())",
    "study": "cp.Study('{configs}/paper.toml').run(db='{folder}/results.db', progress=lambda *_: interrupt())",
    "simulate": "threading.Timer(0.3, lambda: interrupt()).start();"
    " [cp.Cable(length_m=1.0, bends=[(90, 0.1, 0.1)], axial_stiffness_N=9e3, friction=0.1, segments=200).simulate("
    "motor_m=0.01 * np.sin(np.arange(20000)), friction=np.full(16, 0.1)) for _ in range(10**6)]",
}


class LongCalls(unittest.TestCase):
    def test_ctrl_c_stops_each_long_call(self) -> None:
        for name, call in CALLS.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                call = call.format(recordings=RECORDINGS, configs=CONFIGS, folder=folder)
                done = subprocess.run(
                    [sys.executable, "-c", INTERRUPTED.format(call=call)], capture_output=True, text=True, check=False
                )
                self.assertEqual((done.stdout, done.returncode), ("interrupted\n", 0), done.stderr)

    def test_a_study_that_was_interrupted_can_be_resumed(self) -> None:
        def interrupt(*_: object) -> None:
            raise KeyboardInterrupt

        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaises(KeyboardInterrupt):
                cp.Study(CONFIGS / "quick.toml").run(db=f"{folder}/results.db", progress=interrupt)
            done = subprocess.run(
                [os.environ["CAPSTAN"], "study", "resume", "--db", f"{folder}/results.db"],
                capture_output=True, text=True, check=False,
            )
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_an_exception_of_the_progress_function_ends_the_call(self) -> None:
        def fail(activity: str, fraction: float) -> None:
            raise ZeroDivisionError(activity)

        with self.assertRaises(ZeroDivisionError):
            cp.diagnose(RECORDINGS / "viscous-pair.csv", progress=fail)

    def test_progress_rises_to_the_end(self) -> None:
        told: list[tuple[str, float]] = []
        cp.diagnose(RECORDINGS / "viscous-pair.csv", progress=lambda *progress: told.append(progress))
        self.assertGreater(len(told), 2)
        self.assertTrue(all(activity and 0.0 <= fraction <= 1.0 for activity, fraction in told))
        fractions = [fraction for _, fraction in told]
        self.assertEqual(fractions, sorted(fractions))

    def test_two_threads_are_in_long_calls_at_once(self) -> None:
        both = threading.Barrier(2, timeout=600)
        met: list[int] = []

        class Enough(Exception):
            """They have met: neither has to go on to its end."""

        def work() -> None:
            def meet(*_: object) -> None:
                both.wait()
                met.append(1)
                raise Enough

            with self.assertRaises(Enough):
                cp.diagnose(RECORDINGS / "viscous-pair.csv", progress=meet, jobs=1)

        threads = [threading.Thread(target=work) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(met, [1, 1])

    def test_a_simulation_lets_other_threads_run(self) -> None:
        # No thread gives the GIL away by itself: others run only where a call releases it.
        usual = sys.getswitchinterval()
        self.addCleanup(sys.setswitchinterval, usual)
        ticks = 0
        stop = False

        def tick() -> None:
            nonlocal ticks
            while not stop:
                ticks += 1
                time.sleep(0.0005)

        thread = threading.Thread(target=tick)
        thread.start()
        sys.setswitchinterval(1e6)
        for draws in (8, 200):  # in the calling thread, and in one of its own
            before = ticks
            for _ in range(10000):
                small_cable().simulate(motor_m=np.sin(np.arange(900)) / 200.0, friction=np.full(draws, 0.1), jobs=1)
                if ticks > before:
                    break
            self.assertGreater(ticks, before)
        stop = True
        sys.setswitchinterval(usual)
        thread.join()

    def test_threads_that_simulate_side_by_side_get_the_bits_of_one(self) -> None:
        stroke = 0.01 * np.sin(np.arange(2000) / 50.0)
        alone = small_cable().simulate(motor_m=stroke, friction=np.linspace(0.0, 0.3, 64)).tension_N
        results: list[np.ndarray] = []
        threads = [
            threading.Thread(
                target=lambda: results.append(
                    small_cable().simulate(motor_m=stroke, friction=np.linspace(0.0, 0.3, 64)).tension_N
                )
            )
            for _ in range(6)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([each.tobytes() == alone.tobytes() for each in results], [True] * 6)


if __name__ == "__main__":
    unittest.main()
