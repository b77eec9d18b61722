"""Completion, manual pages and the doctor: written from the one table of commands, and true."""

import json
import re
import shutil
import sqlite3
import subprocess
import unittest

from capstan_program import CONFIGS, CapstanTest


class Shell(CapstanTest):
    def complete(self, *words):
        """What bash would offer after these words, the last of which is being typed."""
        script = self.run_capstan("completion", "bash").stdout
        listed = " ".join(f"'{word}'" for word in words)
        script += f"\nCOMP_WORDS=({listed}); COMP_CWORD={len(words) - 1}; _capstan; printf '%s\\n' \"${{COMPREPLY[@]}}\"\n"
        done = subprocess.run(["bash", "-u"], input=script, capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.split()

    @unittest.skipUnless(shutil.which("bash"), "no bash")
    def test_bash_completes(self):
        self.assertEqual(self.complete("capstan", "rec"), ["recommend", "recording"])
        self.assertIn("study", self.complete("capstan", ""))
        self.assertEqual(self.complete("capstan", "study", "ru"), ["run"])
        self.assertEqual(self.complete("capstan", "study", "run", "--rep"), ["--repetitions"])
        self.assertEqual(self.complete("capstan", "report", "--format", "h"), ["html"])
        self.assertIn("--configs", self.complete("capstan", "serve", "--c"))
        self.assertEqual(self.complete("capstan", "report", "some"), [])  # then bash offers files
        self.assertIn("serve", self.complete("capstan", "help", "s"))

    @unittest.skipUnless(shutil.which("zsh"), "no zsh")
    def test_zsh_can_read_its_script(self):
        self.run_capstan("completion", "zsh", "-o", "_capstan")
        done = subprocess.run(["zsh", "-n", self.folder / "_capstan"], capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_zsh_names_every_command_and_option(self):
        script = self.run_capstan("completion", "zsh").stdout
        self.assertTrue(script.startswith("#compdef capstan\n"))
        for name in self.names():
            self.assertIn(name.split()[-1], script)
        self.run_capstan("completion", "fish", expect=2)

    def names(self):
        text = self.run_capstan("man").stdout.split(".SH COMMANDS")[1].split(".SH")[0]
        return [name.replace("\\-", "-") for name in re.findall(r"^\.TP\n\\fB(.*)\\fR$", text, re.MULTILINE)]

    def test_every_command_has_a_manual_page(self):
        self.run_capstan("man", "--directory", "pages")
        names = self.names()
        self.assertGreater(len(names), 25)
        pages = sorted(path.name for path in (self.folder / "pages").iterdir())
        self.assertEqual(pages, sorted(["capstan.1"] + [f"capstan-{name.replace(' ', '-')}.1" for name in names]))
        for name in names:
            page = (self.folder / "pages" / f"capstan-{name.replace(' ', '-')}.1").read_text()
            for option in re.findall(r"(?<=\s)--([a-z-]+)", self.run_capstan(*name.split(), "--help").stdout.split("Options:")[1]
                                     .split("Examples:")[0].split("Exit codes:")[0]):
                self.assertIn("\\-\\-" + option.replace("-", "\\-"), page, name)
        self.run_capstan("man", "nothing", expect=2)

    @unittest.skipUnless(shutil.which("groff"), "no groff")
    def test_manual_pages_are_sound(self):
        self.run_capstan("man", "--directory", "pages")
        for page in sorted((self.folder / "pages").iterdir()):
            done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", page], capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (0, ""), page.name)
            self.assertIn("NAME", re.sub(".\b", "", done.stdout))  # without overstrikes

    def test_the_doctor_reports_an_intact_database(self):
        told = self.run_capstan("doctor").stdout
        self.assertIn("capstan.db: does not exist yet", told)
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--progress", "none")
        self.assertIn("capstan.db: integrity check passed", self.run_capstan("doctor").stdout)
        told = json.loads(self.run_capstan("doctor", "--json").stdout)
        self.assertTrue(told["database"]["is_intact"])
        self.assertEqual((told["database"]["studies"], told["database"]["running_studies"]), (1, 0))
        self.assertRegex(told["simd"], r"^(AVX|SSE|NEON|EMU|SCALAR)")

    def test_the_doctor_finds_what_is_broken(self):
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--progress", "none")
        connection = sqlite3.connect(self.folder / "capstan.db")
        connection.execute("DELETE FROM sensor_set WHERE sensor_set_id = 1")
        connection.execute("UPDATE work_unit SET done = 0 WHERE unit_index = 1")
        connection.commit()
        connection.close()
        told = " ".join(self.run_capstan("doctor", expect=3).stdout.split())  # lines are wrapped
        self.assertIn("refers to nothing in sensor_set", told)
        self.assertIn("called complete", told)
        (self.folder / "letter.db").write_text("no database at all")
        self.assertIn("not a database", self.run_capstan("doctor", "--db", "letter.db", expect=3).stdout)


if __name__ == "__main__":
    unittest.main()
