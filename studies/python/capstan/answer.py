"""What a study, a search or a diagnosis says."""

import html
import json
from typing import Any

from capstan import _core


class Answer:
    """An answer in every form in which the program `capstan` prints it, with the same bits.

    `repr` is the answer in a sentence, `print` shows what the terminal shows, and a notebook the page of the report with
    its tables and figures.
    """

    def __init__(self, answer: _core.Answer) -> None:
        self._answer = answer

    @property
    def title(self) -> str:
        """What the answer is about: the name of a study or a recording."""
        return self._answer.title

    @property
    def headline(self) -> str:
        """The answer in one sentence."""
        return self._answer.headline

    @property
    def values(self) -> dict[str, Any]:
        """All numbers of the answer: what --json prints."""
        values: dict[str, Any] = json.loads(self.json())
        return values

    def text(self) -> str:
        """The answer as the terminal shows it."""
        return self._answer.text()

    def json(self) -> str:
        """The answer as --json prints it."""
        return self._answer.json()

    def csv(self) -> str:
        """Its tables in full precision."""
        return self._answer.csv()

    def markdown(self) -> str:
        """The answer with its tables in Markdown."""
        return self._answer.markdown()

    def html(self) -> str:
        """One page with all tables and figures, which needs no network; write it to a file."""
        return self._answer.html()

    def __repr__(self) -> str:
        return f"{self._answer.kind}: {self.title}\n{self.headline}"

    def __str__(self) -> str:
        return self.text()

    def _repr_html_(self) -> str:
        page = html.escape(self.html(), quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 40em; border: 0"></iframe>'
