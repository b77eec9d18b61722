"""npm packages are pinned: to a version, to the bytes of that version, and to no address."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["CAPSTAN_SOURCE"])
BUILD = Path(os.environ["CAPSTAN_BUILD"])


def folders():
    return [file.parent for room in ("reports", "tests", "studies") for file in sorted((SOURCE / room).rglob("package.json"))
            if "node_modules" not in file.parts]


class PinnedPackages(unittest.TestCase):
    def test_there_are_four_lists_and_each_has_a_lock_file(self):
        self.assertEqual(4, len(folders()))
        for folder in folders():
            self.assertTrue((folder / "package-lock.json").exists(), folder)

    def test_a_list_names_exact_versions(self):
        for folder in folders():
            content = json.loads((folder / "package.json").read_text())
            for kind in ("dependencies", "devDependencies", "optionalDependencies"):
                for name, version in content.get(kind, {}).items():
                    self.assertRegex(version, r"^\d+\.\d+\.\d+$", f"{folder}: {name}")
            self.assertNotIn("scripts", content, folder)

    def test_a_lock_file_fixes_the_bytes_and_names_no_address(self):
        for folder in folders():
            for path, package in json.loads((folder / "package-lock.json").read_text())["packages"].items():
                if not path:
                    continue
                self.assertRegex(package.get("integrity", ""), r"^sha512-[A-Za-z0-9+/]{86}==$", f"{folder}: {path}")
                # An address would bind everybody to one registry, or bring in what is from none.
                self.assertNotIn("resolved", package, f"{folder}: {path}")
                self.assertNotIn("link", package, f"{folder}: {path}")
                self.assertRegex(package["version"], r"^\d+\.\d+\.\d+$", f"{folder}: {path}")

    def test_installing_leaves_the_lock_file_as_it_is(self):
        self.assertTrue(shutil.which("npm"))
        for folder in folders():
            with tempfile.TemporaryDirectory() as work:
                for name in ("package.json", "package-lock.json", ".npmrc"):
                    shutil.copy(folder / name, work)
                # Refuses where list and lock file disagree; installs nothing.
                answer = subprocess.run(["npm", "ci", "--dry-run", "--ignore-scripts", "--offline", "--loglevel=error"],
                                        cwd=work, capture_output=True, text=True)
                self.assertEqual(0, answer.returncode, answer.stderr)
                self.assertEqual((folder / "package-lock.json").read_bytes(),
                                 (Path(work) / "package-lock.json").read_bytes())

    def test_a_list_that_disagrees_with_its_lock_file_is_refused(self):
        with tempfile.TemporaryDirectory() as work:
            for name in ("package.json", "package-lock.json", ".npmrc"):
                shutil.copy(SOURCE / "reports" / "web" / name, work)
            path = Path(work) / "package.json"
            path.write_text(re.sub(r'("vega": )"[^"]+"', r'\1"1.0.0"', path.read_text()))
            answer = subprocess.run(["npm", "ci", "--dry-run", "--ignore-scripts", "--offline", "--loglevel=error"], cwd=work,
                                    capture_output=True, text=True)
            self.assertNotEqual(0, answer.returncode)

    def test_what_the_program_was_built_with_is_what_the_lock_file_says(self):
        locked = json.loads((SOURCE / "reports" / "web" / "package-lock.json").read_text())["packages"]
        installed = json.loads((BUILD / "reports" / "web" / "node_modules" / ".package-lock.json").read_text())["packages"]
        self.assertGreater(len(installed), 10)
        for path, package in installed.items():
            self.assertEqual(locked[path]["integrity"], package["integrity"], path)


if __name__ == "__main__":
    unittest.main()
