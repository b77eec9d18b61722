"""Why a bench disagrees with its model."""

import os
from collections.abc import Sequence
from typing import NamedTuple

from capstan import _core
from capstan.answer import Answer
from capstan.model import Model
from capstan.progress import Progress, shown
from capstan.recording import FileName, Recording


class Interval(NamedTuple):
    """A 95% interval."""

    low: float
    high: float


class FittedNumber(NamedTuple):
    """A number of a cause; without an interval where the recording itself gave it."""

    value: float
    unit: str
    interval_95: Interval | None


class Cause(NamedTuple):
    """A cause that a diagnosis names, and where it is. `numbers` are by name."""

    effect: str
    variant: str | None
    component: str
    position_m: float | None
    probability: float
    numbers: dict[str, FittedNumber]


class Closed(NamedTuple):
    """The fraction of a channel's gap beyond noise that the corrected model closes on data that it was not fitted to."""

    fraction: float
    interval_95: Interval | None


class Experiment(NamedTuple):
    """A recording to make next. With `discrimination_probability` it would name the right one of two explanations."""

    description: str
    discrimination_probability: float


class Diagnosis(Answer):
    """The causes of a recording's gap, as `capstan diagnose` finds them; `diagnose` gives one."""

    def __init__(self, diagnosis: _core.Diagnosis) -> None:
        super().__init__(diagnosis.answer())
        self._diagnosis = diagnosis

    @property
    def probabilities(self) -> dict[str, float]:
        """How probable each effect is as the leading cause, most probable first; they sum to 1."""
        return {each["effect"]: each["probability"] for each in self.values["effects"]}

    @property
    def causes(self) -> list[Cause]:
        """The causes that act together, the clearest first; empty where the model needs none, or none is known."""
        values = self.values
        present = {each["effect"]: each["present"] for each in values["effects"]}
        return [
            Cause(
                each["effect"],
                each["variant"],
                each["component"],
                each["position_m"],
                present.get(each["effect"], 0.0),
                {
                    name: FittedNumber(number["value"], number["unit"], _interval(number["interval_95"]))
                    for name, number in each["numbers"].items()
                },
            )
            for each in values["causes"]
        ]

    @property
    def closed(self) -> dict[str, Closed]:
        """How far each channel's gap shrinks, where it exceeds the noise."""
        return {
            each["channel"]: Closed(each["closed_fraction"], _interval(each["closed_interval_95"]))
            for each in self.values["channels"]
            if each["closed_fraction"] is not None
        }

    @property
    def next_experiment(self) -> Experiment | None:
        """The experiment that best distinguishes explanations that compete; None where none competes or none would."""
        experiments = self.values["non_identifiable"]["experiments"]
        if not experiments:
            return None
        return Experiment(experiments[0]["description"], experiments[0]["discrimination_probability"])

    @property
    def model(self) -> Model:
        """What was found, as a model of the bench that predicts other runs."""
        return Model(_core.model_of(self._diagnosis))

    def corrected_model(self) -> str:
        """The corrected model of the cable as text, for `capstan study run CONFIG --truth FILE`."""
        return self._diagnosis.corrected_model()

    def store(self, db: FileName, *, log: FileName = "") -> int:
        """Stores the diagnosis in a results database and gives its number there; `log` is the diagnosed file."""
        return self._diagnosis.store(os.fspath(db), os.fspath(log))


def _interval(limits: list[float] | None) -> Interval | None:
    return None if limits is None else Interval(*limits)


def diagnose(
    recording: Recording | FileName,
    *,
    fit_runs: Sequence[int] = (),
    hold_runs: Sequence[int] = (),
    runs: Sequence[int] = (),
    calibrate_on: Sequence[int] = (),
    baselines: bool = False,
    time_limit_s: float | None = None,
    jobs: int = 0,
    progress: Progress = False,
) -> Diagnosis:
    """Finds which unmodelled effects, wrong numbers or sensor faults make a recording disagree with its model.

    The causes are fitted to `fit_runs`, and the corrected model is judged on `hold_runs`; without them all runs are
    fitted, or those of `runs`. `baselines` adds the errors of simple models that know nothing of the bench. A drive
    of unknown geometry is calibrated to `calibrate_on`. After `time_limit_s` no further cause is tried.
    Takes seconds to minutes; Ctrl-C stops it.

    >>> import capstan as cp
    >>> recording = cp.read_recording("configs/recordings/viscous-pair.csv")
    >>> found = cp.diagnose(recording)
    >>> [cause.effect for cause in found.causes]
    ['viscous_friction']
    """
    if not isinstance(recording, Recording):
        recording = Recording(_core.Recording(os.fspath(recording)))
    with shown(progress) as report:
        return Diagnosis(
            _core.diagnose(
                recording._core,
                list(runs),
                list(calibrate_on),
                list(fit_runs),
                list(hold_runs),
                baselines,
                time_limit_s,
                jobs,
                report,
            )
        )
