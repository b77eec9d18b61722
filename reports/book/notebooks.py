"""The notebooks: sources with cells marked `# %%`, made notebooks, executed, and shown as pages.

An executed notebook is kept beside its page for a laboratory to start from. A figure is drawn with the colours of the page."""

import os
import re
from pathlib import Path

import nbformat
from nbconvert.preprocessors import CellExecutionError, ExecutePreprocessor

import blocks

INK = "#1b2c3d"  # matplotlib draws with it, and the page replaces it by its own ink
STYLE = f"""%matplotlib inline
import matplotlib_inline.backend_inline, matplotlib.pyplot
matplotlib_inline.backend_inline.set_matplotlib_formats("svg")
matplotlib.pyplot.rcParams.update({{name: "{INK}" for name in ("text.color", "axes.labelcolor", "xtick.color", "ytick.color", "axes.edgecolor")}})
matplotlib.pyplot.rcParams.update({{"figure.facecolor": "none", "axes.facecolor": "none", "legend.framealpha": 0.0, "svg.hashsalt": "capstan",
    "svg.fonttype": "none", "figure.figsize": (7, 3.6), "axes.prop_cycle": matplotlib.pyplot.cycler(color=["#3d85c6", "#d97a2b", "#4a9d68", "#b05fb0", "#b8a02e", "#8a8f98", "#c9506a", "#3aa6a6"])}})
"""


def cells_of(text):
    """A notebook of a source: `# %% [markdown]` cells have their text in comments."""
    cells = []
    for part in re.split(r"^# %%", text, flags=re.M)[1:]:
        head, _, body = part.partition("\n")
        body = body.strip("\n")
        if "[markdown]" in head:
            cells.append(nbformat.v4.new_markdown_cell(re.sub(r"^# ?", "", body, flags=re.M)))
        else:
            cells.append(nbformat.v4.new_code_cell(body))
    for k, cell in enumerate(cells):
        cell["id"] = f"cell-{k + 1}"
    return nbformat.v4.new_notebook(cells=cells, metadata={"kernelspec": {
        "name": "python3", "display_name": "Python 3", "language": "python"}})


def write(book, sources):
    kept = book.extra / "notebooks"
    kept.mkdir(parents=True, exist_ok=True)
    names = []
    for source in sorted(Path(sources).glob("*.py")):
        notebook = cells_of(source.read_text())
        execute(notebook, source.name, book)
        nbformat.write(notebook, kept / f"{source.stem}.ipynb")
        book.write(f"notebooks/{source.stem}.md", page(notebook, source.stem))
        names.append(source.stem)
    book.write("notebooks/index.md", "# Notebooks\n\nSix notebooks to start from. Each page is one of them, executed by the build; the file is at its top. They "
               "run in a folder that has `configs`, with the package `capstan`, NumPy, pandas and matplotlib.\n\n```{toctree}\n:maxdepth: 1\n\n"
               + "\n".join(names) + "\n```\n")


def execute(notebook, name, book):
    folder = book.runs / f"notebook-{name}"
    folder.mkdir(parents=True)
    (folder / "configs").symlink_to(book.surroundings.source / "configs")
    first = nbformat.v4.new_code_cell(STYLE)
    notebook.cells.insert(0, first)
    # The kernel inherits the environment of this process.
    os.environ.update({"PYDEVD_DISABLE_FILE_VALIDATION": "1", "PYTHONPATH": book.surroundings.environment["PYTHONPATH"], "PYTHONDONTWRITEBYTECODE": "1",
                       "PATH": book.surroundings.environment["PATH"]})
    try:
        ExecutePreprocessor(timeout=300, kernel_name="python3").preprocess(notebook, {"metadata": {"path": str(folder)}})
    except CellExecutionError as error:
        raise blocks.BlockFailed(f"notebook {name}: {error}") from None
    notebook.cells.remove(first)
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)  # the time of day
    notebook.metadata.pop("language_info", None)


def page(notebook, name):
    text = []
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            text.append(cell.source)
            continue
        text.append(f"```python\n{cell.source}\n```")
        text += [shown for output in cell.outputs if (shown := of_output(output))]
    head, *rest = text
    file = f'```{{raw}} html\n<p><a href="{name}.ipynb" download>This notebook as a file</a></p>\n```'
    return "\n\n".join([head, file, *rest]) + "\n"


def of_output(output):
    """A figure before a table before a text."""
    if output.output_type == "stream":
        return "" if output.name == "stderr" else printed(output.text)
    data = output.get("data", {})
    if "image/svg+xml" in data:
        svg = data["image/svg+xml"]
        svg = re.sub(r"^.*?(?=<svg)", "", svg, flags=re.S).replace(INK, "currentColor")
        svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.S)
        svg = "\n".join(line for line in svg.splitlines() if line.strip())
        return f'```{{raw}} html\n<figure class="drawn" style="max-width: 44rem">{svg}</figure>\n```'
    html = data.get("text/html", "")
    if "<table" in html and "<iframe" not in html:
        table = re.search(r"<table.*</table>", html, re.S).group(0)
        table = re.sub(r"<table[^>]*>", '<table class="docutils align-default">', table).replace(' style="text-align: right;"', "")
        return f'```{{raw}} html\n<div class="table-wrapper">{table}</div>\n```'
    return printed(data["text/plain"]) if "text/plain" in data else ""


def printed(text):
    return f":::{{container}} printed\n````text\n{text.rstrip()}\n````\n:::"
