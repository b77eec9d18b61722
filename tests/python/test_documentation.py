"""Every example of the documentation runs, and is typed."""

import doctest
import importlib
import os
import pkgutil
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import capstan as cp
from surroundings import SOURCE

DOCUMENTS = [SOURCE / "README.md", SOURCE / "studies/python/README.md"]
PAGES = sorted(SOURCE.glob("reports/book/pages/**/*.md"))  # their blocks run in the test of the book
NOTEBOOKS = sorted(SOURCE.glob("reports/book/notebooks/*.py"))  # and so do they


def modules() -> list[str]:
    names = [each.name for each in pkgutil.iter_modules(cp.__path__, "capstan.")]
    return ["capstan", *(name for name in names if name != "capstan._core")]


def python_blocks(documents: list[Path]) -> list[tuple[str, str]]:
    """The Python blocks of a document, as one program each, with its name."""
    found = []
    for document in documents:
        blocks = re.findall(r"^```python\n(.*?)^```", document.read_text(), re.MULTILINE | re.DOTALL)
        if blocks:
            found.append((str(document.relative_to(SOURCE)), "\n".join(blocks)))
    return found


def docstring_examples() -> list[tuple[str, str]]:
    """The example of each docstring, as a program with its name."""
    docstrings = [each for name in modules() for each in doctest.DocTestFinder().find(importlib.import_module(name))]
    return [(each.name, doctest.script_from_examples(each.docstring)) for each in docstrings if each.examples and each.docstring]


class Documentation(unittest.TestCase):
    def test_each_docstrings_example(self) -> None:
        os.chdir(SOURCE)
        tried = 0
        for name in modules():
            with self.subTest(name):
                result = doctest.testmod(importlib.import_module(name))
                self.assertEqual(result.failed, 0)
                tried += result.attempted
        self.assertGreater(tried, 20)

    def test_everything_public_is_explained(self) -> None:
        for name in cp.__all__:
            self.assertTrue(getattr(cp, name).__doc__, name)

    def test_each_block_runs(self) -> None:
        self.assertEqual(len(python_blocks(DOCUMENTS)), len(DOCUMENTS))
        for name, program in python_blocks(DOCUMENTS):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                os.symlink(SOURCE / "configs", Path(folder) / "configs")
                done = subprocess.run([sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)


@unittest.skipIf("LD_PRELOAD" in os.environ, "the checkers' interpreter has no sanitizer")
@unittest.skipUnless(shutil.which("mypy") and shutil.which("stubtest"), "mypy is missing")
class Types(unittest.TestCase):
    def check(self, *words: str) -> None:
        environment = {**os.environ, "MYPYPATH": os.environ["PYTHONPATH"], "MYPY_CACHE_DIR": self.cache}
        done = subprocess.run(words, capture_output=True, text=True, check=False, env=environment, cwd=self.cache)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.cache = folder.name

    def test_the_package(self) -> None:
        self.check("mypy", "--strict", "--python-executable", sys.executable, "-p", "capstan")

    def test_each_example(self) -> None:
        examples = python_blocks(DOCUMENTS + PAGES) + docstring_examples() + [(each.stem, each.read_text()) for each in NOTEBOOKS]
        self.assertGreater(len(examples), 20)
        for k, (name, program) in enumerate(examples):
            Path(self.cache, f"example_{k}.py").write_text(f"# {name}\n{program}")
        settings = Path(self.cache, "mypy.ini")
        settings.write_text("[mypy]\n[mypy-matplotlib.*]\nignore_missing_imports = True\n")  # Debian's has no types
        files = [f"example_{k}.py" for k in range(len(examples))]
        self.check("mypy", "--strict", "--config-file", str(settings), "--python-executable", sys.executable, *files)

    def test_the_stubs_are_those_of_the_extension(self) -> None:
        allowed = Path(self.cache) / "allowed"
        # Every class of pybind11 has a metaclass that no stub can name.
        classes = [name for name in dir(cp._core) if isinstance(getattr(cp._core, name), type)]
        allowed.write_text("".join(f"capstan._core.{name}\n" for name in classes))
        self.check("stubtest", "capstan._core", "--allowlist", str(allowed))


if __name__ == "__main__":
    unittest.main()
