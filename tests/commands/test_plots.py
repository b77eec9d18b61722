"""The plots that the documents show, run where their programs are installed."""

import importlib.util
import re
import shutil
import subprocess
import sys
import unittest

from capstan_program import CONFIGS, PROGRAM, CapstanTest

ROOT = CONFIGS.parent


class Plots(CapstanTest):
    def setUp(self):
        super().setUp()
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--progress", "none")

    @unittest.skipUnless(importlib.util.find_spec("pandas") and importlib.util.find_spec("matplotlib"),
                         "no pandas or matplotlib (Debian: python3-pandas, python3-matplotlib)")
    def test_python(self):
        done = subprocess.run([sys.executable, ROOT / "reports/examples/plot_errors.py", "capstan.db", "errors.png"],
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("Posterior mean", done.stdout)
        picture = (self.folder / "errors.png").read_bytes()
        self.assertTrue(picture.startswith(b"\x89PNG"))
        self.assertGreater(len(picture), 10000)

    @unittest.skipUnless(shutil.which("Rscript"), "no R (Debian: r-base-core)")
    def test_r(self):
        line = re.search(r"^Rscript -e '(.*)'$", (ROOT / "storage/README.md").read_text(), re.MULTILINE)[1]
        done = subprocess.run(["Rscript", "-e", line.replace("capstan query", f"{PROGRAM} query")], cwd=self.folder,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((self.folder / "errors.pdf").read_bytes().startswith(b"%PDF"))


if __name__ == "__main__":
    unittest.main()
