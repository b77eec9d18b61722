"""The model of a bench that a diagnosis found."""

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from capstan import _core
from capstan.answer import Answer
from capstan.cable import Bend, Cable
from capstan.observer import Observer, RateFriction, Sensor
from capstan.recording import FileName, Recording


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

    def cable(self, *, pretension_N: float, segments: int = 40) -> Cable:
        """A cable with the model's routing, stiffness and friction. `pretension_N` is what the bench is said to have; the
        model corrects it. Effects beyond these numbers are not in it."""
        length_m, bends, axial_stiffness_N, friction, static_friction, ratio = self._model.cable_numbers()
        return Cable(
            length_m=length_m,
            bends=[Bend(*bend) for bend in bends],
            axial_stiffness_N=axial_stiffness_N,
            friction=friction,
            static_friction=static_friction,
            pretension_N=ratio * pretension_N,
            segments=segments,
        )

    def observer(
        self,
        *,
        sensors: Sequence[Sensor],
        noise_N: float,
        pretension_N: float,
        segments: int = 12,
        interval_s: float | None = None,
        **settings: Any,
    ) -> Observer:
        """An observer of `cable(...)`; `settings` are those of `Observer`. With `interval_s`, the time between samples, it
        also has the model's viscous and Stribeck friction. Its `not_used` names what of the model it leaves out, such as
        other effects, and zeros of sensors, which the caller can take off the readings."""
        cable = self.cable(pretension_N=pretension_N, segments=segments)
        friction = RateFriction(*self._model.rate_friction()) if interval_s is not None else RateFriction()
        observer = Observer(cable, sensors=sensors, noise_N=noise_N, rate_friction=friction, interval_s=interval_s, **settings)
        observer.not_used = tuple(self._model.not_used_by_observer(interval_s or 0.0))
        return observer

    def __repr__(self) -> str:
        length_m, bends, axial_stiffness_N, friction, _, _ = self._model.cable_numbers()
        return f"Model({length_m:g} m of cable, bends={len(bends)}, EA={axial_stiffness_N:.4g} N, friction={friction:.3g})"


def read_model(file: FileName) -> Model:
    """Reads a model that `Model.save` or `capstan diagnose --save` wrote."""
    return Model(_core.Model.read(os.fspath(file)))
