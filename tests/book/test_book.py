"""The built book: every link leads somewhere, nothing needs a network, and it has what it promises."""

import html.parser
import json
import os
import re
import subprocess
import unittest
import urllib.parse
from pathlib import Path

BOOK = Path(os.environ["CAPSTAN_BOOK"])
HTML = BOOK / "html"
SOURCE = Path(os.environ["CAPSTAN_SOURCE"])
PROGRAM = os.environ["CAPSTAN"]


class Links(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.targets, self.anchors, self.loaded = [], set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        for name in ("id", "name"):
            if attributes.get(name):
                self.anchors.add(attributes[name])
        target = attributes.get("href") or attributes.get("src")
        if target is not None:
            self.targets.append(target)
            if tag in ("script", "link", "img", "iframe"):
                self.loaded.append(target)


def capstan(*words):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=True).stdout


class Book(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # What Doxygen and the reports wrote are pages of others, which the book only points to.
        cls.pages = {path: Links(path.read_text()) for path in HTML.rglob("*.html")
                     if path.relative_to(HTML).parts[0] not in ("cpp", "reports")}

    def test_every_link_leads_somewhere(self):
        self.assertGreater(len(self.pages), 60)
        for path, page in self.pages.items():
            for target in page.targets:
                parts = urllib.parse.urlsplit(target)
                if parts.scheme or target in ("#", ""):
                    continue
                file = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
                with self.subTest(page=str(path.relative_to(HTML)), link=target):
                    self.assertTrue(file.exists())
                    if parts.fragment and file in self.pages:
                        self.assertIn(urllib.parse.unquote(parts.fragment), self.pages[file].anchors)

    def test_no_page_loads_anything_from_a_network(self):
        for path, page in self.pages.items():
            for target in page.loaded:
                self.assertFalse(re.match(r"(https?:)?//", target), f"{path}: {target}")
        for style in HTML.rglob("*.css"):
            self.assertNotRegex(style.read_text(), r"@import|url\(['\"]?(https?:)?/", str(style))

    def test_every_equation_of_the_engine_is_derived(self):
        numbers = set(re.findall(r"^\| (E\d+) \|", (SOURCE / "engine/README.md").read_text(), re.M))
        self.assertGreater(len(numbers), 40)
        derived = {}
        for path in (HTML / "theory").glob("*.html"):
            for number in re.findall(r'<span class="equation-number">\((E\d+)\)</span>', path.read_text()):
                self.assertNotIn(number, derived, f"{number} is in {path.name} and {derived.get(number)}")
                derived[number] = path.name
        self.assertEqual(numbers, set(derived))

    def test_everything_of_the_catalogues_has_a_page_with_figures(self):
        catalogue = json.loads(capstan("config", "catalogue", "--json"))
        names = [effect["name"] for effect in catalogue["effects"]]
        names += [f"layout-{layout['name']}" for layout in catalogue["layouts"]]
        names += [f"method-{method['name'].replace('_', '-')}" for method in catalogue["fusion_methods"]]
        for name in names:
            text = (HTML / "gallery" / f"{name}.html").read_text()
            self.assertGreaterEqual(text.count("<polyline"), 4, name)
            self.assertNotRegex(text, r'points="[^"]*(nan|inf)', name)

    def test_every_command_is_in_the_reference(self):
        text = (HTML / "reference/commands.html").read_text()
        listing = capstan("--help").split("Commands:\n")[1].split("\n\n")[0]
        for found in re.finditer(r"^  ([a-z]+(?: [a-z0-9]+)?)  ", listing, re.M):
            self.assertIn(f"capstan {found.group(1)}<", text)

    def test_six_notebooks_ran_without_an_error(self):
        notebooks = sorted((HTML / "notebooks").glob("*.ipynb"))
        self.assertEqual(len(notebooks), 6)
        for notebook in notebooks:
            cells = [cell for cell in json.loads(notebook.read_text())["cells"] if cell["cell_type"] == "code"]
            outputs = [output for cell in cells for output in cell["outputs"]]
            self.assertTrue(any("image/svg+xml" in output.get("data", {}) for output in outputs), notebook.name)
            self.assertFalse([output for output in outputs if output["output_type"] == "error"], notebook.name)
            self.assertTrue(all(cell["execution_count"] for cell in cells), notebook.name)

    def test_blocks_that_are_only_shown_are_few(self):
        shown = [path.name for path in (SOURCE / "reports/book/pages").rglob("*.md") for _ in
                 re.findall(r"^```sh no-run", path.read_text(), re.M)]
        self.assertLessEqual(len(shown), 3, shown)

    def test_no_page_names_the_place_where_it_was_built(self):
        for path in self.pages:
            self.assertNotIn(str(BOOK.parent), path.read_text(), str(path))

    def test_the_program_knows_where_the_book_is(self):
        page = Path(capstan("help", "--book").strip())
        self.assertTrue(page.is_file())
        self.assertIn("Capstan", page.read_text())

    def test_it_is_also_one_document_to_print(self):
        pdf = BOOK / "capstan.pdf"
        if not pdf.exists():
            self.skipTest("Chromium is missing")
        self.assertEqual(pdf.read_bytes()[:5], b"%PDF-")
        self.assertGreater(pdf.stat().st_size, 500_000)
        self.assertLess(pdf.stat().st_size, 40_000_000)


if __name__ == "__main__":
    unittest.main()
