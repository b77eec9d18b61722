"""The tension along a cable, estimated while it moves."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Union

from capstan import _core
from capstan.cable import Cable
from capstan.errors import Error

Sensor = Union[tuple[str, float], tuple[str, str]]
"""("tension", place in m from the motor), or ("displacement", "load")."""


@dataclass(frozen=True)
class RateFriction:
    """Friction that depends on the sliding speed v (E20, E21): a drag of `drag_N_s_per_m2` v on each metre of cable, and a
    friction coefficient that is higher by `extra_friction` exp(-(v / `speed_m_per_s`)^2), v low-passed with `memory_s`.

    >>> import capstan as cp
    >>> cp.RateFriction(drag_N_s_per_m2=2.0).extra_friction
    0.0
    """

    drag_N_s_per_m2: float = 0.0
    extra_friction: float = 0.0
    speed_m_per_s: float = 0.05
    memory_s: float = 0.04


class Observer(_core.Observer):
    """Estimates the tension at every node from the motor's position and some sensors, one sample at a time.

    The recursive estimator of the library (E36 to E38): `members` cables with states of their own are moved as the
    motor is and pulled towards the readings. `noise_N` is the standard deviation of a tension reading. In each sample
    the load end moves by `load_wander_m` (standard deviation) beyond what is known of it, the motor's end by
    `motor_wander_m`; both also stand for a model that is not quite right, and mean a constant rate of samples.
    With `rate_friction` the friction also depends on the sliding speed (E41), which the samples' times give; with a
    drag an update takes about twice as long.

    `update(time_s, readings)` takes how much cable the motor has reeled in since the start [m; positive pulls], then
    one reading of each sensor: tensions in N, the load's displacement in m, positive away from the motor. It gives
    three arrays over the nodes [N]: the mean, and the limits of the 95% band.

    `not_used` says in words what of a model an observer leaves out, where `Model.observer` made it.

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
        rate_friction: RateFriction = RateFriction(),
    ) -> None:
        self.sensors = tuple(sensors)
        self.not_used: tuple[str, ...] = ()
        if not isinstance(rate_friction, RateFriction):
            raise Error([f"rate_friction: is {str(rate_friction)[:80]}, but must be a RateFriction"])
        rate = rate_friction
        friction = (rate.drag_N_s_per_m2, rate.extra_friction, rate.speed_m_per_s, rate.memory_s)
        super().__init__(cable._core, self.sensors, noise_N, load_wander_m, motor_wander_m, members, seed, friction)

    def __repr__(self) -> str:
        left_out = f", not_used={list(self.not_used)}" if self.not_used else ""
        return f"Observer(sensors={list(self.sensors)}{left_out})"
