"""A report as PDF, its figures as SVG and PNG, and words explained: real files, or a refusal that says what to do."""

import os
import shutil
import struct
import unittest
import xml.etree.ElementTree

from capstan_program import CONFIGS, CapstanTest

BROWSER = any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome", "chrome")))
NO_BROWSER = {**os.environ, "PATH": "/nowhere"}


class Figures(CapstanTest):
    def setUp(self):
        super().setUp()
        self.run_capstan("study", "run", CONFIGS / "quick.toml")

    @unittest.skipUnless(BROWSER, "no browser (Debian: apt-get install chromium)")
    def test_a_pdf_is_a_pdf(self):
        self.run_capstan("report", "-o", "r.pdf")
        pdf = (self.folder / "r.pdf").read_bytes()
        self.assertTrue(pdf.startswith(b"%PDF-"))
        self.assertGreater(len(pdf), 50_000)

    def test_every_page_holds_the_notices_of_the_scripts_that_draw_its_figures(self):
        """Their licences ask for it: BSD-3 for Vega, Vega-Lite and Vega-Embed, ISC for D3."""
        self.run_capstan("report", "-o", "report.html")
        self.run_capstan("place", CONFIGS / "paper.toml", "--repetitions", 4, "--html", "place.html", "--progress", "none")
        self.run_capstan("diagnose", CONFIGS / "recordings" / "viscous-pair.csv", "--html", "why.html", "--progress", "none")
        for name in ("report.html", "place.html", "why.html"):
            page = (self.folder / name).read_text()
            self.assertIn("vega", page.split("<details class=\"notices\">")[0], name)  # it draws with them
            notices = page.split("<details class=\"notices\">")[1].split("</details>")[0]
            for part in ("---- vega, ", "---- vega-lite", "---- vega-embed", "---- d3-array, ", "---- d3-geo", "Mike Bostock",
                         "University of Washington Interactive Data Lab", "Redistributions in binary form must reproduce",
                         "and this permission notice appear in all copies"):
                self.assertIn(part, notices, name)

    @unittest.skipUnless(BROWSER, "no browser (Debian: apt-get install chromium)")
    def test_every_figure_as_svg_and_png(self):
        widths = {}
        for width in (400, 800):
            self.run_capstan("report", "--figures", f"figures{width}", "--width", width)
            files = sorted(path.name for path in (self.folder / f"figures{width}").iterdir())
            self.assertGreater(len(files), 6)
            self.assertIn("figure-best_by_count-duty_cycle-5-percent.svg", files)
            for name in files:
                path = self.folder / f"figures{width}" / name
                if name.endswith(".svg"):
                    self.assertIn(name[:-4] + ".png", files)
                    root = xml.etree.ElementTree.parse(path).getroot()
                    widths.setdefault(name, []).append(float(root.get("width")))
                    self.assertLess(widths[name][-1], 1.5 * width, name)
                    self.assertIn("#fff", path.read_text())  # the colours of print
                else:
                    head = path.read_bytes()[:24]
                    self.assertEqual(head[:8], b"\x89PNG\r\n\x1a\n")
                    self.assertGreater(struct.unpack(">I", head[16:20])[0], 2 * width)
        for name, (narrow, wide) in widths.items():
            self.assertLess(narrow, wide, name)

    def test_without_a_browser_nothing_is_written_under_a_wrong_name(self):
        for words in (("-o", "r.pdf"), ("--figures", "figures")):
            told = self.run_capstan("report", *words, expect=2, env=NO_BROWSER).stderr
            self.assertIn("chromium", told)
        self.assertEqual(list(self.folder.glob("r.*")) + list(self.folder.glob("figures*")), [])

    def test_other_endings_are_refused(self):
        for ending in ("svg", "png", "tex", "docx", "xlsx"):
            told = self.run_capstan("report", "-o", f"r.{ending}", expect=2).stderr
            self.assertIn("--figures", told)
            self.run_capstan("recommend", "-o", f"r.{ending}", expect=2)
        self.run_capstan("recommend", "-o", "r.pdf", expect=2)
        self.run_capstan("report", "-o", "r.dat", expect=2)
        self.assertEqual(list(self.folder.glob("r.*")), [])

    def test_a_text_is_no_page(self):
        self.run_capstan("report", "-o", "r.txt")
        self.assertTrue((self.folder / "r.txt").read_text().startswith("# "))
        self.run_capstan("recommend", "-o", "r.log")
        self.assertTrue((self.folder / "r.log").read_text().startswith("Study 1 (quick)"))


class Words(CapstanTest):
    def test_terms_methods_effects_and_layouts_are_explained(self):
        for words, explained in ((("regret",), "regime"), (("posterior_mean",), "Posterior mean"), (("Viscous", "friction"), "effect"),
                                 (("even",), "layout"), (("feasible", "curve"), "tensions"), (("node",), "sensor")):
            self.assertIn(explained, self.run_capstan("help", *words).stdout, words)
        self.assertIn("did you mean 'regret'", self.run_capstan("help", "regrett", expect=2).stderr)
        listed = self.run_capstan("help", "terms").stdout
        for word in ("regret", "posterior_mean", "viscous_friction", "Even"):
            self.assertIn(word, listed)

    def test_commands_come_before_terms(self):
        self.assertIn("Usage: capstan duty", self.run_capstan("help", "duty").stdout)


if __name__ == "__main__":
    unittest.main()
