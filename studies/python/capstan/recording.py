"""Recordings of real benches."""

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path as FilePath
from typing import Union

import numpy as np
import numpy.typing as npt

from capstan import _core
from capstan.errors import Error
from capstan.progress import Progress, shown

FileName = Union[str, "os.PathLike[str]"]


class Run:
    """One run of a recording: `time_s`, and each channel by its name as a read-only array (samples), in SI units."""

    def __init__(self, recording: _core.Recording, number: int) -> None:
        self._core = recording
        self.number = number

    @property
    def time_s(self) -> npt.NDArray[np.float64]:
        """The time of each sample."""
        return self._core.samples(self.number, "time_s")

    @property
    def conditions(self) -> dict[str, float]:
        """What was set for the run and stays during it, as the recording names it."""
        return self._core.conditions(self.number)

    def __getitem__(self, channel: str) -> npt.NDArray[np.float64]:
        return self._core.samples(self.number, channel)

    def __repr__(self) -> str:
        return f"Run({self.number}, samples={self.time_s.size})"


class Recording:
    """A session on a bench: several runs, all with the same channels. `read_recording` gives one.

    `repairs` are sentences on what an import changed, `doubts` on what looks wrong or was assumed.
    """

    def __init__(self, recording: _core.Recording, repairs: Sequence[str] = (), doubts: Sequence[str] = ()) -> None:
        self._core = recording
        self.repairs = list(repairs)
        self.doubts = list(doubts)

    @property
    def name(self) -> str:
        """The name of its file."""
        return self._core.name

    @property
    def kind(self) -> str:
        """The kind of bench: pull_pull, single_cable, lumped_drive or band."""
        return self._core.kind

    @property
    def sample_rate_Hz(self) -> float:
        """Samples in a second."""
        return self._core.sample_rate_Hz

    @property
    def channels(self) -> dict[str, str]:
        """The unit of each channel."""
        return self._core.channels

    @property
    def runs(self) -> list[Run]:
        """All runs, in the order in which they were made."""
        return [Run(self._core, number) for number in self._core.run_numbers]

    def run(self, number: int) -> Run:
        """The run with this number."""
        self._core.conditions(number)  # an error where there is none
        return Run(self._core, number)

    def __repr__(self) -> str:
        runs, channels = len(self._core.run_numbers), ", ".join(self.channels)
        return (
            f"Recording({self.name!r}, {self.kind}, {runs} run{'' if runs == 1 else 's'} at "
            f"{self.sample_rate_Hz:g} Hz, channels {channels})"
        )


def read_recording(
    file: FileName | Sequence[FileName],
    *,
    mapping: FileName | None = None,
    strict: bool = False,
    progress: Progress = False,
) -> Recording:
    """Reads a recording (NAME.csv with NAME.json beside it), or a laboratory's logs by a mapping.

    With a `mapping` (a file as `capstan import --suggest` writes it), `file` is a log of any known format, or several
    that are runs of one session. What was repaired is in `repairs` of the recording; `strict` refuses logs that need it.

    >>> import capstan as cp
    >>> recording = cp.read_recording("configs/recordings/single-cable.csv")
    >>> recording.kind
    'single_cable'
    >>> recording.runs[0]["motor_angle"].size == recording.runs[0].time_s.size
    True
    """
    if mapping is None:
        recording = _core.Recording(os.fspath(file) if isinstance(file, (str, os.PathLike)) else _one(file))
        return Recording(recording, doubts=recording.assumptions)
    files = [file] if isinstance(file, (str, os.PathLike)) else list(file)
    with tempfile.TemporaryDirectory() as folder, shown(progress) as report:
        name = FilePath(folder) / (FilePath(files[0]).stem if files else "recording")
        found = _core.import_logs([os.fspath(each) for each in files], os.fspath(mapping), name, strict, report)
        recording = _core.Recording(name.with_name(name.name + ".csv"))
    return Recording(
        recording,
        [words for words, repaired in found if repaired],
        [words for words, repaired in found if not repaired],
    )


def _one(files: Sequence[FileName]) -> FileName:
    if len(files) != 1:
        raise Error([f"file: is a list of {len(files)} files, but only an import by a mapping takes several"])
    return files[0]
