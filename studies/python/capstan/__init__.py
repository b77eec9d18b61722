"""Cable-conduit transmissions: simulate them, place sensors on them, find why a bench disagrees with its model.

Everything here is the library of the program `capstan`, with the same bits. Physical quantities are in SI units, and
their names end in the unit. Long calls release the GIL, use all processors unless `jobs` says otherwise, and stop
with Ctrl-C. Wrong input raises `Error`, whose `problems` list everything that is wrong.
"""

import atexit

from capstan import _core
from capstan.answer import Answer
from capstan.cable import Bend, Blocked, Cable, Moved, Path, Spring, Weight
from capstan.diagnosis import Cause, Closed, Diagnosis, Experiment, FittedNumber, Interval, diagnose
from capstan.errors import Error
from capstan.model import Model, Prediction, read_model
from capstan.observer import Observer, RateFriction
from capstan.recording import Recording, Run, read_recording
from capstan.study import Study, place

__version__ = _core.version
__all__ = [
    "Answer",
    "Bend",
    "Blocked",
    "Cable",
    "Cause",
    "Closed",
    "Diagnosis",
    "Error",
    "Experiment",
    "FittedNumber",
    "Interval",
    "Model",
    "Moved",
    "Observer",
    "Path",
    "Prediction",
    "RateFriction",
    "Recording",
    "Run",
    "Spring",
    "Study",
    "Weight",
    "diagnose",
    "place",
    "read_model",
    "read_recording",
]

atexit.register(_core.wait_for_interrupted_calls)
