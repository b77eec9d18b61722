"""The model of a bench that a diagnosis found."""

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from capstan import _core
from capstan.answer import Answer
from capstan.cable import Bend, Cable
from capstan.errors import Error
from capstan.observer import Observer, RateFriction, Sensor
from capstan.recording import FileName, Recording

# Length, bends, stiffness, both frictions, pretension.
_CableNumbers = tuple[float, list[tuple[float, float, float]], float, float, float, float]


class Prediction(Answer):
    """What a model says of a recording, with the errors of the bench before and after the diagnosis."""

    def __init__(self, prediction: _core.Prediction) -> None:
        super().__init__(prediction.answer())
        self._prediction = prediction

    def samples(self, run: int, channel: str, *, of: str = "model") -> npt.NDArray[np.float64] | None:
        """A channel of a run (samples, read-only), as the `model` says, the `nominal` bench, or the model `with_law` of what
        it leaves; None where that says nothing of the channel."""
        return self._prediction.samples(run, channel, of)


class Model:
    """The model of a bench that a diagnosis found: its numbers, effects, sensors, and the law of what is left.

    `Diagnosis.model` gives one, and `read_model` what `save` or `capstan diagnose --save` wrote.

    >>> import capstan as cp
    >>> recording = cp.read_recording("configs/recordings/viscous-pair.csv")
    >>> model = cp.diagnose(recording, fit_runs=[1]).model
    >>> judged = model.predict(recording, runs=[2])
    >>> bool(judged.values["channels"][0]["rms_model"] < judged.values["channels"][0]["rms_nominal"])
    True
    """

    def __init__(self, model: _core.Model) -> None:
        self._model = model

    def text(self) -> str:
        """The model as a file (TOML) with comments."""
        return self._model.text()

    def save(self, file: FileName) -> None:
        """Writes the model, for `capstan simulate LOG --model FILE` and `read_model`."""
        self._model.save(os.fspath(file))

    def predict(self, recording: Recording, *, runs: Sequence[int] = (), jobs: int = 0) -> Prediction:
        """Drives the model with a recording's inputs, of all runs or of these."""
        return Prediction(self._model.predict(recording._core, list(runs), jobs))

    def cable(
        self,
        *,
        pretension_N: float | None = None,
        segments: int = 40,
        name: str = "A",
        session_s: float = 0.0,
        conditions: Mapping[str, float] = {},
    ) -> Cable:
        """A cable with the model's routing, a local bend included, and its stiffness, friction and pretension.

        `pretension_N` is what the bench is said to have, the mean of the recording's runs where it is left out; the model
        corrects it, also by a drift over `session_s`. `name` is A or B of a pair. Numbers that follow a condition of the
        runs are those of `conditions`, or of the middle of the recording's. Other effects are not in it.
        """
        return self._cable(self._observed(name, pretension_N, session_s, conditions)[0], segments)

    def observer(
        self,
        *,
        sensors: Sequence[Sensor],
        noise_N: float | None = None,
        pretension_N: float | None = None,
        segments: int = 12,
        name: str = "A",
        session_s: float = 0.0,
        conditions: Mapping[str, float] = {},
        speed_dependent: bool = True,
        **settings: Any,
    ) -> Observer:
        """An observer of `cable(...)` with the model's viscous and Stribeck friction; `settings` are those of `Observer`.

        Without `noise_N` it is the standard deviation of the recording's noisiest tension sensor, or of its torque
        sensors over the radii of their pulleys. `speed_dependent=False` leaves the friction out that depends on the
        speed, so that an update takes half as long. `not_used` of the observer names what of the model it leaves out,
        such as other effects, and zeros of sensors, which the caller can take off the readings.
        """
        numbers, friction, not_used = self._observed(name, pretension_N, session_s, conditions, speed_dependent)
        if noise_N is None:
            noise_N = self._model.tension_noise_N
            if noise_N == 0.0:
                raise Error(["noise_N: the model does not say how noisy a tension reading is; state it"])
        observer = Observer(
            self._cable(numbers, segments), sensors=sensors, noise_N=noise_N, rate_friction=RateFriction(*friction), **settings
        )
        observer.not_used = tuple(not_used)
        return observer

    def _observed(
        self, name: str, pretension_N: float | None, session_s: float, conditions: Mapping[str, float], speed_dependent: bool = True
    ) -> tuple[_CableNumbers, tuple[float, float, float, float], list[str]]:
        return self._model.observed_cable(name, pretension_N, session_s, dict(conditions), speed_dependent)

    @staticmethod
    def _cable(numbers: _CableNumbers, segments: int) -> Cable:
        length_m, bends, axial_stiffness_N, friction, static_friction, pretension_N = numbers
        return Cable(
            length_m=length_m,
            bends=[Bend(*bend) for bend in bends],
            axial_stiffness_N=axial_stiffness_N,
            friction=friction,
            static_friction=static_friction,
            pretension_N=pretension_N,
            segments=segments,
        )

    def __repr__(self) -> str:
        cable = self.cable()
        return (
            f"Model({cable.length_m:g} m of cable, bends={len(cable.bends)}, EA={cable.axial_stiffness_N:.4g} N, "
            f"friction={cable.friction:.3g})"
        )


def read_model(file: FileName) -> Model:
    """Reads a model that `Model.save` or `capstan diagnose --save` wrote."""
    return Model(_core.read_model(os.fspath(file)))
