"""A cable in its conduit, and how it moves."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Union

import numpy as np
import numpy.typing as npt

from capstan import _core
from capstan.errors import Error

Numbers = Union[npt.ArrayLike, Sequence[float]]
"""An array of one dimension, of any stride, byte order and kind of real number; or a sequence of numbers."""


class Bend(NamedTuple):
    """A bend of the conduit: its angle, its radius, and where it begins, from the motor."""

    angle_deg: float
    radius_m: float
    at_m: float


@dataclass(frozen=True)
class Blocked:
    """The load end does not move."""


@dataclass(frozen=True)
class Spring:
    """A spring between the load end and a wall. At rest it pulls as the cable's pretension does."""

    stiffness_N_per_m: float


@dataclass(frozen=True)
class Weight:
    """A constant pull on the load end."""

    tension_N: float


@dataclass(frozen=True)
class Moved:
    """The load end is moved by this much from its place at rest (times), positive away from the motor."""

    displacement_m: Numbers


Load = Union[Blocked, Spring, Weight, Moved]


class Path:
    """The motion of a cable: arrays of the shape (draws, times, nodes).

    `tension_N` and `displacement_m` own their memory. Displacements are positive towards the load, and 0 at the
    load end at rest; the cable's stretch under its pretension is in them. `places_m` are the nodes' places from the
    motor. `unverified_steps` counts steps whose motion passed none of the model's checks (0 in nearly every case).
    """

    def __init__(
        self,
        tension_N: npt.NDArray[np.float64],
        displacement_m: npt.NDArray[np.float64],
        places_m: npt.NDArray[np.float64],
        unverified_steps: int,
    ) -> None:
        self.tension_N = tension_N
        self.displacement_m = displacement_m
        self.places_m = places_m
        self.unverified_steps = unverified_steps

    def __repr__(self) -> str:
        draws, times, nodes = self.tension_N.shape
        low, high = (float(self.tension_N.min()), float(self.tension_N.max())) if self.tension_N.size else (0.0, 0.0)
        return f"Path(draws={draws}, times={times}, nodes={nodes}, tension {low:.4g} to {high:.4g} N)"


class Cable:
    """A cable in its conduit, cut into segments of equal length.

    `axial_stiffness_N` is EA: force per unit strain. `friction` is the coefficient of a sliding cable,
    `static_friction` that of one about to slide; the same where it is left out. All bends lie between 0 and `length_m`.

    >>> import numpy as np
    >>> import capstan as cp
    >>> cable = cp.Cable(length_m=2.0, bends=[cp.Bend(angle_deg=90, radius_m=0.08, at_m=0.6)],
    ...                  axial_stiffness_N=9e3, friction=0.12, segments=40)
    >>> cable
    Cable(length_m=2.0, bends=1, axial_stiffness_N=9000.0, friction=0.12, segments=40)
    """

    def __init__(
        self,
        *,
        length_m: float,
        bends: Sequence[Bend | tuple[float, float, float]] = (),
        axial_stiffness_N: float,
        friction: float,
        static_friction: float | None = None,
        pretension_N: float = 0.0,
        segments: int = 40,
    ) -> None:
        self.bends = tuple(Bend(*bend) for bend in bends)
        self._core = _core.Cable(
            length_m, self.bends, axial_stiffness_N, friction, static_friction, pretension_N, segments
        )
        self.length_m = float(length_m)
        self.axial_stiffness_N = float(axial_stiffness_N)
        self.friction = float(friction)
        self.static_friction = float(friction if static_friction is None else static_friction)
        self.pretension_N = float(pretension_N)
        self.segments = int(segments)

    @property
    def places_m(self) -> npt.NDArray[np.float64]:
        """Where the nodes are, from the motor (segments + 1)."""
        return self._core.places_m

    def simulate(
        self,
        *,
        motor_m: Numbers,
        load: Load = Blocked(),
        friction: Numbers | float | None = None,
        axial_stiffness_N: Numbers | float | None = None,
        pretension_N: Numbers | float | None = None,
        jobs: int = 0,
    ) -> Path:
        """Moves the motor's end, and gives the tension and displacement at every node.

        `motor_m` says how much cable the motor has reeled in at each time; positive pulls. Before the first time the
        cable rests. `friction`, `axial_stiffness_N` and `pretension_N` may be one number for each draw. Draws run side
        by side on `jobs` threads (0: all processors), without the GIL; a draw depends on no other.

        >>> import numpy as np
        >>> import capstan as cp
        >>> cable = cp.Cable(length_m=2.0, bends=[cp.Bend(90, 0.08, 0.6)], axial_stiffness_N=9e3, friction=0.12)
        >>> stroke = 0.01 * (1 - np.cos(np.linspace(0, 2 * np.pi, 200)))
        >>> path = cable.simulate(motor_m=stroke, load=cp.Spring(3000.0), friction=[0.05, 0.1, 0.2])
        >>> path.tension_N.shape
        (3, 200, 41)
        >>> bool(np.all(path.tension_N[0, 99, -1] > path.tension_N[2, 99, -1]))  # friction takes from the load
        True
        """
        kind, number = _load(load)
        tension_N, displacement_m, unverified = self._core.simulate(
            motor_m, kind, number, friction, axial_stiffness_N, pretension_N, jobs
        )
        return Path(tension_N, displacement_m, self.places_m, unverified)

    def __reduce__(self) -> tuple[Any, ...]:
        names = ("length_m", "bends", "axial_stiffness_N", "friction", "static_friction", "pretension_N", "segments")
        return _made, ({name: getattr(self, name) for name in names},)

    def __repr__(self) -> str:
        more = "".join(
            f", {name}={value}"
            for name, value, usual in (
                ("static_friction", self.static_friction, self.friction),
                ("pretension_N", self.pretension_N, 0.0),
            )
            if value != usual
        )
        return (
            f"Cable(length_m={self.length_m}, bends={len(self.bends)}, axial_stiffness_N={self.axial_stiffness_N}, "
            f"friction={self.friction}{more}, segments={self.segments})"
        )


def _made(numbers: dict[str, Any]) -> Cable:
    return Cable(**numbers)


def _load(load: Load) -> tuple[str, Any]:
    match load:
        case Blocked():
            return "blocked", None
        case Spring(stiffness_N_per_m):
            return "spring", stiffness_N_per_m
        case Weight(tension_N):
            return "weight", tension_N
        case Moved(displacement_m):
            return "moved", displacement_m
    raise Error([f"load: is {load!r:.80}, but must be Blocked(), Spring(...), Weight(...) or Moved(...)"])
