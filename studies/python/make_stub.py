"""Writes the stub of the extension module from the signatures in its docstrings: make_stub.py PACKAGE_FOLDER.

mypy's stubgen reads the signatures. The rules below turn what pybind11 calls a type into what a type checker knows. A
signature that says less than its binding could is an error.
"""

import re
import sys
import tempfile
from pathlib import Path

from mypy import stubgen

MODULE = "capstan._core"
RULES = [
    (r"numpy\.ndarray\[numpy\.(\w+)\]", r"numpy.typing.NDArray[numpy.\1]"),
    (r"\bos\.PathLike\b", 'Union[str, "os.PathLike[str]"]'),
    (r"\btuple\b", "Tuple[Any, ...]"),
    (r"\*args, \*\*kwargs\) -> None", "*args: object, **kwargs: object) -> None"),  # only functions make such an object
    (r"(?<=: )List\[(?=[^\n]*\) ->)", "Sequence["),  # an argument; pybind11 takes any sequence
    (r"^from typing import .*$", "from collections.abc import Callable, Sequence\nfrom typing import Any, Dict, List, Optional, Tuple, Union"),
]
IMPRECISE = r"\b(?:handle|sequence|iterable|tuple|dict|list)\b|-> (?:object|Any)\b|\*args, |\barg\d"


def main() -> None:
    package = Path(sys.argv[1])
    sys.path.insert(0, str(package.parent))
    with tempfile.TemporaryDirectory() as folder:
        stubgen.main(["--quiet", "--module", MODULE, "--output", folder])
        text = Path(folder, *MODULE.split(".")).with_suffix(".pyi").read_text()
    for found, written in RULES:
        text = re.sub(found, written, text, flags=re.MULTILINE)
    imprecise = [line for line in text.splitlines() if re.search(IMPRECISE, line)]
    if imprecise:
        raise SystemExit("These bindings need more precise types (signatures.h):\n" + "\n".join(imprecise))
    stub = package / "_core.pyi"
    stub.unlink(missing_ok=True)  # a link from an older build leads into the sources
    stub.write_text(text)


main()
