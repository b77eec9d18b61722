"""How far a long call is."""

import sys
from collections.abc import Callable
from typing import Union

Progress = Union[bool, Callable[[str, float], object]]
"""False, True for a line that is written again and again, or a function of the activity and the fraction done."""


class _Line:
    """One line on standard error, in a notebook or a terminal."""

    def __init__(self) -> None:
        self.width = 0

    def __call__(self, activity: str, fraction: float) -> None:
        words = f"{activity}: {100.0 * fraction:.0f}%" if fraction > 0.0 else activity
        print("\r" + words.ljust(self.width), end="", file=sys.stderr, flush=True)
        self.width = len(words)

    def end(self) -> None:
        if self.width > 0:
            print("\r" + " " * self.width, end="\r", file=sys.stderr, flush=True)


class shown:
    """Gives what a long call reports to, and ends the line however the call ends."""

    def __init__(self, progress: Progress) -> None:
        self.line = _Line() if progress is True else None
        self.report = progress if callable(progress) else self.line

    def __enter__(self) -> Callable[[str, float], object] | None:
        return self.report

    def __exit__(self, *_: object) -> None:
        if self.line is not None:
            self.line.end()
