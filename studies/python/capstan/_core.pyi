import os
from collections.abc import Callable, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

_File = Union[str, "os.PathLike[str]"]
_Progress = Callable[[str, float], object] | None
_Array = npt.NDArray[np.float64]

version: str

def wait_for_interrupted_calls() -> None: ...

class Answer:
    def __init__(self, *args: object, **kwargs: object) -> None: ...  # only functions make one
    @property
    def kind(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def headline(self) -> str: ...
    def text(self) -> str: ...
    def json(self) -> str: ...
    def csv(self) -> str: ...
    def markdown(self) -> str: ...
    def html(self) -> str: ...

class Cable:
    def __init__(
        self,
        length_m: object,
        bends: Sequence[Any],
        axial_stiffness_N: object,
        friction: object,
        static_friction: object,
        pretension_N: object,
        segments: object,
        /,
    ) -> None: ...
    @property
    def length_m(self) -> float: ...
    @property
    def segments(self) -> int: ...
    @property
    def places_m(self) -> _Array: ...
    def simulate(
        self,
        motor_m: object,
        load_kind: str,
        load_number: object,
        friction: object,
        axial_stiffness_N: object,
        pretension_N: object,
        jobs: object,
        /,
    ) -> tuple[_Array, _Array, int]: ...

class Recording:
    def __init__(self, file: _File, /) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> str: ...
    @property
    def sample_rate_Hz(self) -> float: ...
    @property
    def channels(self) -> dict[str, str]: ...
    @property
    def assumptions(self) -> list[str]: ...
    @property
    def run_numbers(self) -> list[int]: ...
    def conditions(self, run: int, /) -> dict[str, float]: ...
    def samples(self, run: int, channel: str, /) -> _Array: ...

def import_logs(
    logs: Sequence[_File], mapping: _File, name: _File, strict: bool, on_progress: _Progress, /
) -> list[tuple[str, bool]]: ...

class Diagnosis:
    def __init__(self, *args: object, **kwargs: object) -> None: ...  # only functions make one
    def answer(self) -> Answer: ...
    def corrected_model(self) -> str: ...
    def store(self, db: _File, log: _File, /) -> int: ...

def diagnose(
    recording: Recording,
    runs: Sequence[int],
    calibrate_on: Sequence[int],
    fit: Sequence[int],
    hold: Sequence[int],
    baselines: bool,
    time_limit_s: object,
    jobs: object,
    on_progress: _Progress,
    /,
) -> Diagnosis: ...

class Prediction:
    def __init__(self, *args: object, **kwargs: object) -> None: ...  # only functions make one
    def answer(self) -> Answer: ...
    def samples(self, run: int, channel: str, of: str, /) -> _Array | None: ...

class Model:
    def __init__(self, *args: object, **kwargs: object) -> None: ...  # only functions make one
    @staticmethod
    def of(diagnosis: Diagnosis, /) -> Model: ...
    @staticmethod
    def read(file: _File, /) -> Model: ...
    def text(self) -> str: ...
    def save(self, file: _File, /) -> None: ...
    def observed_cable(
        self, name: str, pretension_N: object, session_s: object, conditions: dict[str, float], speed_dependent: bool, /
    ) -> tuple[
        tuple[float, list[tuple[float, float, float]], float, float, float, float],
        tuple[float, float, float, float],
        list[str],
    ]: ...
    @property
    def tension_noise_N(self) -> float: ...
    def predict(self, recording: Recording, runs: Sequence[int], jobs: object, /) -> Prediction: ...

class Config:
    def __init__(self, *args: object, **kwargs: object) -> None: ...  # only functions make one
    @staticmethod
    def read(file: _File, /) -> Config: ...
    @staticmethod
    def parse(toml: str, /) -> Config: ...
    @property
    def name(self) -> str: ...
    def run(
        self, db: _File, seed: object, repetitions: object, jobs: object, on_progress: _Progress, /
    ) -> list[int]: ...
    def place(
        self,
        world: Diagnosis | None,
        noise: str | None,
        runners_up: object,
        resolve_to_N: object,
        seed: object,
        repetitions: object,
        jobs: object,
        on_progress: _Progress,
        /,
    ) -> Answer: ...

def conclusions(db: _File, study_id: int, /) -> Answer: ...
def query(db: _File, sql: str, /) -> tuple[list[str], list[tuple[Any, ...]]]: ...

class Observer:
    def __init__(
        self,
        cable: Cable,
        sensors: Sequence[Any],
        noise_N: object,
        load_wander_m: object,
        motor_wander_m: object,
        members: object,
        seed: object,
        rate_friction: Sequence[float],
        /,
    ) -> None: ...
    def update(self, time_s: object, readings: object) -> tuple[_Array, _Array, _Array]: ...
    @property
    def slack_members(self) -> int: ...
    @property
    def unverified_members(self) -> int: ...
