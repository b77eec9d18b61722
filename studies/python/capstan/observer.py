"""The tension along a cable, estimated while it moves."""

from collections.abc import Sequence
from typing import Union

from capstan import _core
from capstan.cable import Cable

Sensor = Union[tuple[str, float], tuple[str, str]]
"""("tension", place in m from the motor), or ("displacement", "load")."""


class Observer(_core.Observer):
    """Estimates the tension at every node from the motor's position and some sensors, one sample at a time.

    The recursive estimator of the library (E36 to E38): `members` cables with states of their own are moved as the
    motor is and pulled towards the readings. `noise_N` is the standard deviation of a tension reading. In each sample
    the load end moves by `load_wander_m` (standard deviation) beyond what is known of it, the motor's end by
    `motor_wander_m`; both also stand for a model that is not quite right. The time only serves to reject samples
    that are out of order: sample at a constant rate.

    `update(time_s, readings)` takes how much cable the motor has reeled in since the start [m; positive pulls], then
    one reading of each sensor: tensions in N, the load's displacement in m, positive away from the motor. It gives
    three arrays over the nodes [N]: the mean, and the limits of the 95% band.

    >>> import capstan as cp
    >>> cable = cp.Cable(length_m=1.2, bends=[cp.Bend(180, 0.1, 0.3)], axial_stiffness_N=9e3, friction=0.1,
    ...                  pretension_N=20.0, segments=12)
    >>> observer = cp.Observer(cable, sensors=[("tension", 0.0), ("displacement", "load")], noise_N=0.2)
    >>> mean_N, low_N, high_N = observer.update(0.001, [0.0, 20.3, 0.0])
    >>> mean_N.shape
    (13,)
    >>> bool((low_N <= mean_N).all() and (mean_N <= high_N).all())
    True
    """

    def __init__(
        self,
        cable: Cable,
        *,
        sensors: Sequence[Sensor],
        noise_N: float,
        load_wander_m: float = 1e-4,
        motor_wander_m: float = 0.0,
        members: int = 32,
        seed: int = 1,
    ) -> None:
        self.sensors = tuple(sensors)
        super().__init__(cable._core, self.sensors, noise_N, load_wander_m, motor_wander_m, members, seed)

    def __repr__(self) -> str:
        return f"Observer(sensors={list(self.sensors)})"
