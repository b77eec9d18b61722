#!/usr/bin/env python3
"""Builds the book: build_book.py BUILD_FOLDER. Wants a built program and Python package; needs no network.

The pages are copied, their blocks are run, the gallery and the reference are made by the program, the notebooks are
executed; then Sphinx writes BUILD_FOLDER/book/html and Chromium, where it is installed, BUILD_FOLDER/book/capstan.pdf."""

import argparse
import os
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import blocks
import gallery
import gallery_of_layouts
import included
import notebooks
import reference

MATH_FONT = Path("/usr/share/texmf/fonts/opentype/public/tex-gyre-math/texgyretermes-math.otf")  # of fonts-texgyre-math
HERE = Path(__file__).resolve().parent
SOURCE = HERE.parents[1]


class Book:
    """The folders of a build, and the program that makes most pages."""

    def __init__(self, build, doxyfile):
        self.doxyfile = doxyfile
        self.build = build.resolve()
        self.work = self.build / "book"
        self.pages = self.work / "source"
        self.extra = self.pages / "extra"
        self.runs = self.work / "runs"
        self.surroundings = None

    def begin(self):
        shutil.rmtree(self.work, ignore_errors=True)
        shutil.copytree(HERE / "pages", self.pages)
        shutil.copytree(HERE / "static", self.pages / "static")
        (self.pages / "static" / "fonts").mkdir()
        shutil.copy(MATH_FONT, self.pages / "static" / "fonts")
        shutil.copy(HERE / "conf.py", self.pages)
        self.surroundings = blocks.Surroundings(SOURCE, self.build, self.extra / "reports")

    def capstan(self, *words, cwd=None):
        """What the program prints."""
        done = subprocess.run([self.build / "capstan", *map(str, words)], capture_output=True, text=True, cwd=cwd)
        if done.returncode != 0:
            raise RuntimeError(f"capstan {' '.join(map(str, words))}: {done.stderr}")
        return done.stdout

    def write(self, name, text):
        path = self.pages / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def describe_headers(self):
        """The reference of the headers, from Doxygen where it is installed; its folder."""
        if self.doxyfile is None or not self.doxyfile.exists() or not shutil.which("doxygen"):
            return None
        subprocess.run(["doxygen", self.doxyfile], check=True, capture_output=True)
        return self.build / "reference" / "html"

    def run_page(self, path):
        name = str(path.relative_to(self.pages))
        text = included.with_sources(path.read_text(), SOURCE)
        path.write_text(blocks.executed(name, text, self.runs / name.replace("/", "-"), self.surroundings))

    def make_pages(self):
        """Two at a time: some blocks keep all processors busy, most do not."""
        paths = sorted(self.pages.rglob("*.md"))
        with ThreadPoolExecutor(2) as pool:
            tasks = [pool.submit(gallery.write, self), pool.submit(gallery_of_layouts.write, self),
                     pool.submit(notebooks.write, self, HERE / "notebooks")]
            tasks += [pool.submit(self.run_page, path) for path in paths]
            reference.write(self)
            included.write(self, SOURCE)
            for task in tasks:
                task.result()

    def sphinx(self, builder):
        environment = {**os.environ, "CAPSTAN_BOOK": str(HERE), "CAPSTAN_VERSION": self.capstan("--version").split()[1],
                       "PYTHONDONTWRITEBYTECODE": "1"}
        # Debian's modules belong to the interpreter that runs this.
        done = subprocess.run([sys.executable, "-m", "sphinx", "-b", builder, "-n", "-W", "--keep-going", "-q", "-j", "2",
                               "-d", self.work / "doctrees", self.pages, self.work / builder.replace("single", "single_")], env=environment)
        if done.returncode != 0:
            raise SystemExit("the book has warnings")

    def print_pdf(self):
        browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
        if browser is None:
            print("No PDF: Chromium is not installed.")
            return
        page = (self.work / "single_html" / "index.html").as_uri()
        pdf = self.work / "capstan.pdf"
        subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer",
                        f"--user-data-dir={self.work / 'browser'}", f"--print-to-pdf={pdf}", page],
                       check=True, capture_output=True)
        if not pdf.exists():
            raise SystemExit("Chromium wrote no PDF")
        shutil.rmtree(self.work / "browser", ignore_errors=True)

    def write_both(self):
        """The pages from what Sphinx has read, while Chromium prints the one page."""
        with ThreadPoolExecutor(1) as pool:
            printed = pool.submit(self.print_pdf)
            self.sphinx("html")
            printed.result()
        pdf = self.work / "capstan.pdf"
        if pdf.exists():
            shutil.copy(pdf, self.work / "html")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=Path)
    parser.add_argument("--doxyfile", type=Path, help="of the reference of the headers")
    parser.add_argument("--stamp", type=Path, help="a file to touch at the end")
    options = parser.parse_args()
    book = Book(options.build, options.doxyfile)
    started = time.monotonic()
    book.begin()
    for name, step in (("pages", book.make_pages), ("one page", lambda: book.sphinx("singlehtml")), ("html and pdf", book.write_both)):
        try:
            step()
        except blocks.BlockFailed as failed:
            raise SystemExit(str(failed)) from None
        print(f"book: {name} after {time.monotonic() - started:.0f} s", flush=True)
    if options.stamp:
        options.stamp.touch()


if __name__ == "__main__":
    main()
