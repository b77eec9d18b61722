"""Arguments of every kind: those that convert safely give the same bits, others an error that says what is wrong."""

import os
import random
import unittest
from collections.abc import Callable
from typing import Any

import numpy as np

import capstan as cp
from surroundings import small_cable

CALLS = int(os.environ.get("CAPSTAN_RANDOM_CALLS", "1000"))
STROKE = 0.005 * np.sin(np.linspace(0.0, 6.0, 40))


def odd_values(numbers: np.ndarray[Any, Any]) -> list[Any]:
    """Values that somebody could pass where numbers are expected; the first ones hold just these numbers."""
    unaligned = np.frombuffer(b"\0" + numbers.astype("<f8").tobytes(), dtype="<f8", offset=1)
    read_only = numbers.copy()
    read_only.flags.writeable = False
    with_nan = numbers.astype(float)
    with_nan[with_nan.size // 2] = np.nan
    masked = np.ma.masked_array(numbers, mask=[True] + [False] * (numbers.size - 1))
    return [
        numbers,
        numbers.astype(">f8"),
        np.repeat(numbers, 3)[::3],
        numbers[::-1][::-1],
        read_only,
        unaligned,
        list(numbers),
        tuple(numbers),
        memoryview(numbers.copy()),
        np.ma.masked_array(numbers),
        np.asfortranarray(np.stack([numbers, numbers], axis=1))[:, 0],
        # other numbers, or none
        numbers.astype("f4"),
        numbers.astype("f2"),
        np.arange(numbers.size, dtype=">i2"),
        np.broadcast_to(np.float64(0.001), numbers.shape),
        with_nan,
        np.full(numbers.shape, np.inf),
        numbers * 1e200,
        -numbers,
        numbers.astype(np.longdouble),
        numbers.astype(complex),
        numbers > 0,
        np.stack([numbers, numbers]),
        numbers[:0],
        numbers[:1],
        np.zeros((0, 3, 0)),
        np.array(list(map(str, numbers))),
        np.array([object()] * 3),
        np.array(["2020-01-01"], dtype="M8[D]"),
        np.zeros(3, dtype=[("a", "f8"), ("b", "i4")]),
        masked,
        [[1.0], [2.0, 3.0]],
        [1.0, None],
        [1.0, "two"],
        [10**400],
        "0.1",
        b"0.1",
        {},
        {0.1, 0.2},
        None,
        object(),
        0.1,
        0,
        -1,
        7,
        float("nan"),
        2**63,
        -(2**70),
        np.float32(0.2),
        np.int8(3),
        True,
        iter([0.1, 0.2]),
        small_cable,
        np.ndarray,
    ]


def tries(choose: random.Random) -> list[tuple[str, Callable[[], object]]]:
    """One call of each kind, with arguments by chance."""

    def value(usual: Any) -> Any:
        if choose.random() < 0.5:
            return usual
        return choose.choice(odd_values(np.asarray(usual, dtype=float) if np.ndim(usual) else STROKE))

    def make() -> cp.Cable:
        return cp.Cable(
            length_m=value(1.2),
            bends=choose.choice([[], [(value(90.0), value(0.1), value(0.2))]]),
            axial_stiffness_N=value(9e3),
            friction=value(0.1),
            static_friction=value(0.2),
            pretension_N=value(20.0),
            segments=value(12),
        )

    def simulate() -> object:
        load = choose.choice([cp.Blocked(), cp.Spring(value(3e3)), cp.Weight(value(10.0)), cp.Moved(value(STROKE)), value(None)])
        return small_cable().simulate(
            motor_m=value(STROKE),
            load=load,
            friction=value(np.full(6, 0.1)),
            axial_stiffness_N=value(None),
            pretension_N=value(np.full(6, 10.0)),
            jobs=value(1),
        )

    def observe() -> object:
        sensors = choose.choice(
            [[("tension", value(0.5))], [("tension", 0.0), ("displacement", "load")], [value(0.1)], [(value("x"), 1)], value(STROKE)]
        )
        observer = cp.Observer(
            small_cable(), sensors=sensors, noise_N=value(0.2), load_wander_m=value(1e-4), members=value(8), seed=value(1),
            rate_friction=choose.choice([cp.RateFriction(), cp.RateFriction(value(2.0), value(0.1)), value(0.1)]),
        )
        for time_s in range(3):
            observer.update(value(float(time_s)), value([0.001, 20.0, 0.0][: 1 + len(sensors)]))
        return observer

    return [("Cable", make), ("simulate", simulate), ("Observer", observe)]


class Arguments(unittest.TestCase):
    def test_what_converts_safely_gives_the_same_bits(self) -> None:
        friction = np.linspace(0.05, 0.2, 6)
        usual = small_cable().simulate(motor_m=STROKE, friction=friction)
        for stroke, drawn in zip(odd_values(STROKE)[:11], odd_values(friction)[:11], strict=True):
            path = small_cable().simulate(motor_m=stroke, friction=drawn)
            self.assertEqual(path.tension_N.tobytes(), usual.tension_N.tobytes(), type(stroke))

    def test_other_arguments_are_refused_by_their_names(self) -> None:
        cable = small_cable()
        for wrong, words in (
            (STROKE.reshape(2, -1), "motor_m: has the shape (2, 20)"),
            (STROKE.astype(complex), "motor_m: holds complex128"),
            (["a"], "motor_m: holds <U1"),
            ([[1.0], [2.0, 3.0]], "motor_m: is a list"),
            ([0.0, float("nan"), float("inf")], "motor_m[1]: is nan, but must be a finite number; so must 1 others"),
            (None, "motor_m: holds object"),
        ):
            with self.assertRaises(cp.Error) as refused:
                cable.simulate(motor_m=wrong)
            self.assertEqual(len(refused.exception.problems), 1)
            self.assertIn(words, refused.exception.problems[0])

    def test_all_problems_are_listed_at_once(self) -> None:
        with self.assertRaises(cp.Error) as refused:
            cp.Cable(length_m=1.0, axial_stiffness_N=-1.0, friction=-0.1, pretension_N=-5.0)
        text = str(refused.exception)
        for key in ("axial_stiffness_N", "dynamic_friction", "pretension_N"):
            self.assertIn(key + ": is", text)

    def test_arguments_are_not_changed_and_not_kept(self) -> None:
        stroke = STROKE.copy()
        first = small_cable().simulate(motor_m=stroke).tension_N.copy()
        self.assertEqual(stroke.tobytes(), STROKE.tobytes())
        path = small_cable().simulate(motor_m=stroke)
        stroke[:] = 0.0
        self.assertEqual(path.tension_N.tobytes(), first.tobytes())

    def test_a_path_owns_its_memory(self) -> None:
        tension_N = small_cable().simulate(motor_m=STROKE).tension_N
        before = tension_N.copy()
        for _ in range(50):
            small_cable().simulate(motor_m=2.0 * STROKE)
        self.assertEqual(tension_N.tobytes(), before.tobytes())
        self.assertTrue(tension_N.flags.writeable and tension_N.flags.c_contiguous)

    def test_random_calls_end_in_an_answer_or_an_exception(self) -> None:
        choose = random.Random(22)
        refused = 0
        for _ in range(CALLS):
            name, call = choose.choice(tries(choose))
            with self.subTest(name), np.errstate(all="ignore"):
                try:
                    call()
                except cp.Error as error:
                    refused += 1
                    self.assertTrue(error.problems and all(error.problems))
                except TypeError:
                    refused += 1
        self.assertGreater(refused, CALLS // 4)
        self.assertLess(refused, CALLS)


if __name__ == "__main__":
    unittest.main()
