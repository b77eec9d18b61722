"""Which sensors, and where: studies and searches of placements."""

import os
import re
from typing import TYPE_CHECKING, Any

from capstan import _core
from capstan.answer import Answer
from capstan.diagnosis import Diagnosis
from capstan.errors import Error
from capstan.progress import Progress, shown
from capstan.recording import FileName

if TYPE_CHECKING:
    import pandas  # type: ignore[import]  # Debian's has no types


def _config(config: FileName) -> _core.Config:
    text = os.fspath(config)
    return _core.parse_config(text) if "\n" in text else _core.read_config(text)


class Study:
    """A study of sensor placement, from a configuration: a file, or its text.

    >>> import capstan as cp, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     study = cp.Study("configs/quick.toml").run(db=f"{folder}/results.db", repetitions=20)
    ...     best = study.query("SELECT count(*) FROM v_best_method")[1][0][0]
    >>> best > 0
    True
    """

    def __init__(self, config: FileName) -> None:
        self._config = _config(config)
        self.db: str | None = None
        self.study_ids: list[int] = []

    @property
    def name(self) -> str:
        """The name of the study."""
        return self._config.name

    def run(
        self,
        *,
        db: FileName = "capstan.db",
        seed: int | None = None,
        repetitions: int | None = None,
        jobs: int = 0,
        progress: Progress = False,
    ) -> "Study":
        """Runs the study into a results database, with the same bits as `capstan study run`, and gives the study.

        A configuration with a [sweep] gives several studies; `study_ids` has their numbers in the database. Ctrl-C
        stops; `capstan study resume` goes on.
        """
        with shown(progress) as report:
            ids = self._config.run(os.fspath(db), seed, repetitions, jobs, report)
        self.db, self.study_ids = os.fspath(db), ids
        return self

    def recommend(self, study_id: int | None = None) -> Answer:
        """The recommendation of the study; of a sweep that of one of `study_ids`."""
        return Answer(_core.conclusions(self._database(), self._one(study_id)))

    def query(self, sql: str) -> tuple[list[str], list[tuple[Any, ...]]]:
        """The column names and the rows of one SELECT on the results database, which changes nothing."""
        return _core.query(self._database(), sql)

    def frame(self, view: str) -> "pandas.DataFrame":
        """The rows of a view or table that belong to this study (such as v_best_method), or of a SELECT, as a table of pandas."""
        import pandas

        sql = view
        if re.fullmatch(r"\w+", view):
            columns, _ = self.query(f"SELECT * FROM {view} LIMIT 0")
            sql = f"SELECT * FROM {view}"
            if "study_id" in columns:
                sql += f" WHERE study_id IN ({', '.join(map(str, self.study_ids))})"
        columns, rows = self.query(sql)
        return pandas.DataFrame.from_records(rows, columns=columns)

    def _database(self) -> str:
        if self.db is None:
            raise Error([f"{self.name}: the study has not been run; call run(db=...) first"])
        return self.db

    def _one(self, study_id: int | None) -> int:
        if study_id is not None:
            return study_id
        if len(self.study_ids) > 1:
            raise Error([f"{self.name}: is a sweep of studies {self.study_ids}; say which with study_id"])
        return self.study_ids[0]

    def __repr__(self) -> str:
        state = "not run" if self.db is None else f"studies {self.study_ids} in {self.db!r}"
        return f"Study({self.name!r}, {state})"


def place(
    config: FileName,
    *,
    world: Diagnosis | None = None,
    noise: str | None = None,
    runners_up: int = 3,
    resolve_to_N: float | None = None,
    seed: int | None = None,
    repetitions: int | None = None,
    jobs: int = 0,
    progress: Progress = False,
) -> Answer:
    """Searches all layouts that the configuration allows, with the same bits as `capstan place`.

    With a configuration that has [uncertainty], `world` is a diagnosis: the answer says whether the advice changes
    where the worlds lie about what it found. Otherwise `noise` names a noise level, and repetitions are added until
    no layout can be better by more than `resolve_to_N`.

    >>> import capstan as cp
    >>> answer = cp.place("configs/quick.toml", repetitions=20)
    >>> answer.values["scopes"][0]["counts"][0]["sensor_count"]
    1
    """
    with shown(progress) as report:
        found = None if world is None else world._diagnosis
        return Answer(
            _config(config).place(found, noise, runners_up, resolve_to_N, seed, repetitions, jobs, report)
        )
