"""Documents of the repository that are pages of the book: an idea is written once, and its blocks are run."""

import os
import re
from pathlib import PurePosixPath

import blocks

PAGES = {
    "engine/README.md": "theory/equations.md",
    "studies/README.md": "how-to/studies-in-depth.md",
    "configs/README.md": "how-to/configurations.md",
    "storage/README.md": "reference/database-in-depth.md",
    "reports/README.md": "reference/answers.md",
    "studies/python/README.md": "reference/python-overview.md",
    "studies/matlab/README.md": "how-to/matlab.md",
    "tests/README.md": "reference/promises.md",
    "CONTRIBUTING.md": "how-to/extend.md",
    "CHANGELOG.md": "reference/changes.md",
}
# python.documentation and matlab.example run their blocks.
RUN_BY_OTHER_TESTS = ("studies/python/README.md", "studies/matlab/README.md")
SOURCE = re.compile(r"^<!-- source: (\S+) -->$", re.M)
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)\s]+)\)")
# Titles as the book has them.
TITLES = {
    "engine/README.md": "Equations at a glance",
    "studies/README.md": "Studies in depth",
    "configs/README.md": "Worked configurations",
    "storage/README.md": "The results database in depth",
    "reports/README.md": "Answers and reports",
    "studies/python/README.md": "The Python package at a glance",
    "studies/matlab/README.md": "MATLAB and Octave",
    "tests/README.md": "What is promised, and what shows it",
    "CONTRIBUTING.md": "Extend the program",
    "CHANGELOG.md": "Changes",
}


def write(book, source):
    for document, page in PAGES.items():
        text = (source / document).read_text()
        text = re.sub(r"\A# .*\n", f"# {TITLES[document]}\n", text)
        text = LINK.sub(lambda found, at=document, to=page: _link(found, at, to), text)
        if document == "engine/README.md":
            text = re.sub(r"^\| E(\d+) \|", r"| [E\1](e\1) |", text, flags=re.M)
        if document not in RUN_BY_OTHER_TESTS:
            text = blocks.executed(page, text, book.runs / page.replace("/", "-"), book.surroundings)
        book.write(page, text)


def with_sources(text, source):
    """`<!-- source: PATH -->` becomes that file of the repository."""
    return SOURCE.sub(lambda found: f"```{PurePosixPath(found.group(1)).suffix[1:]}\n{(source / found.group(1)).read_text()}```", text)


def _link(found, document, page):
    """To the page of a document; to a file that is not a page, its name."""
    words, target = found.groups()
    if "://" in target or target.startswith("#"):
        return found.group(0)
    path, _, anchor = target.partition("#")
    named = os.path.normpath(PurePosixPath(document).parent / path)
    if named in PAGES:
        relative = os.path.relpath(PAGES[named], PurePosixPath(page).parent)
        return f"[{words}]({relative}{'#' + anchor if anchor else ''})"
    return words if words == named else f"{words} (`{named}`)"
