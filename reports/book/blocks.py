"""Runs the fenced blocks of a page in an empty folder, in order, and sets what they print below them.

A block of ```sh is run by the shell, one of ```python by the interpreter of the capstan package; all python blocks of
a page are one session. ```toml my.toml becomes that file. ```sh no-run is shown only: it would install something, or
needs a cluster. Lines after a block say what becomes of its output, and are replaced by it:

    <!-- output -->          all of it
    <!-- output: 12 -->      its first 12 lines
    <!-- page: why.html -->  a report that it wrote, within the page
    <!-- file: my.toml -->   a file that it wrote (": 20" after the name: its first lines)
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

FENCE = re.compile(r"^```(sh|python|toml)( no-run| [\w.-]+)?\n(.*?)^```\n((?:\n?<!-- (?:output|page|file)[^\n]* -->\n)*)", re.M | re.S)
ASKED = re.compile(r"<!-- (output|page|file)(?:: (.*?))? -->")
LANGUAGE = {".toml": "toml", ".json": "json", ".csv": "text", ".py": "python"}


class BlockFailed(Exception):
    """A block of a page ended with an error."""


class Page:
    """A page whose blocks are run in a folder that has nothing but build/capstan and configs."""

    def __init__(self, name, text, folder, surroundings):
        self.name, self.text, self.folder, self.surroundings = name, text, folder, surroundings
        self.python = None
        self.reports = []

    def executed(self):
        self.folder.mkdir(parents=True)
        (self.folder / "build").mkdir()
        (self.folder / "build" / "capstan").symlink_to(self.surroundings.program)
        (self.folder / "configs").symlink_to(self.surroundings.source / "configs")
        try:
            return FENCE.sub(self._replaced, self.text)
        finally:
            if self.python:
                self.python.kill()
                self.python.communicate()

    def _replaced(self, block):
        language, option, code, asked = block.groups()
        fence = f"```{language}\n{code}```\n"
        if option == " no-run" or (language == "toml" and not option):
            return fence
        if language == "toml":
            (self.folder / option.strip()).write_text(code)
            return fence
        line = self.text.count("\n", 0, block.start()) + 1
        printed = self._shell(code, line) if language == "sh" else self._session(code, line)
        return fence + "".join("\n" + self._shown(what, words, printed) for what, words in ASKED.findall(asked))

    def _shown(self, what, words, printed):
        if what == "output":
            return _printed(_first(printed, words))
        if what == "page":
            return self._report(words.strip())
        name, _, lines = words.partition(":")
        path = self.folder / name.strip()
        return _printed(_first(path.read_text(), lines), LANGUAGE.get(path.suffix, "text"))

    def _shell(self, code, line):
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", code], cwd=self.folder, capture_output=True, text=True,
                              env=self.surroundings.environment)
        if done.returncode != 0:
            raise BlockFailed(f"{self.name}:{line}: a block ends with exit code {done.returncode}:\n{code}\n{done.stderr}")
        return done.stdout

    def _session(self, code, line):
        if self.python is None:
            self.python = subprocess.Popen(
                [sys.executable, "-c", SESSION], cwd=self.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                stderr=subprocess.PIPE, text=True, env=self.surroundings.environment)
        self.python.stdin.write(repr(code) + "\n")
        self.python.stdin.flush()
        printed = []
        for text in self.python.stdout:
            if text == END:
                return "".join(printed)
            printed.append(text)
        raise BlockFailed(f"{self.name}:{line}: a block fails:\n{code}\n{self.python.stderr.read()}")

    def _report(self, file):
        kept = f"{self.name.removesuffix('.md').replace('/', '-')}-{file}"
        shutil.copy(self.folder / file, self.surroundings.extra / kept)
        up = "../" * self.name.count("/")
        return (f'```{{raw}} html\n<iframe class="report" src="{up}reports/{kept}" loading="lazy" title="{file}"></iframe>\n'
                f'<p class="page-alone"><a href="{up}reports/{kept}">The page alone</a></p>\n```\n')


END = "\x04 end of block\n"
SESSION = f"""
import ast, sys
names = {{"__name__": "__main__"}}
for line in sys.stdin:
    tree = ast.parse(ast.literal_eval(line))
    last = tree.body.pop().value if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "<block>", "exec"), names)
    if last is not None:
        value = eval(compile(ast.Expression(last), "<block>", "eval"), names)
        if value is not None:
            print(repr(value))
    sys.stdout.write({END!r})
    sys.stdout.flush()
"""


def _first(text, lines):
    kept = text.splitlines()
    if lines and lines.strip() and len(kept) > int(lines):
        kept = kept[:int(lines)] + ["..."]
    return "\n".join(kept)


def _printed(text, language="text"):
    return f":::{{container}} printed\n````{language}\n{text}\n````\n:::\n"


class Surroundings:
    """What the blocks of every page find."""

    def __init__(self, source, build, extra):
        self.source, self.extra = source, extra
        self.program = build / "capstan"
        extra.mkdir(parents=True, exist_ok=True)
        self.environment = {**os.environ, "PYTHONPATH": str(build / "python"), "PATH": f"{build}:{os.environ['PATH']}",
                            "MPLBACKEND": "svg", "PYTHONDONTWRITEBYTECODE": "1"}


def executed(name, text, folder, surroundings):
    """The page with what its blocks printed."""
    return Page(name, text, Path(folder), surroundings).executed() if FENCE.search(text) else text
