"""Whatever is wrong: said with where and what to try, with the documented exit code, and nothing is lost."""

import os
import pathlib
import shutil
import sqlite3
import subprocess
import unittest

from capstan_program import CONFIGS, PROGRAM, CapstanTest

NOBODY = 65534


class BadConfiguration(CapstanTest):
    def refused(self, toml, *texts):
        config = self.write("x.toml", toml)
        for command in (("config", "check"), ("study", "run")):
            done = self.run_capstan(*command, config, expect=2)
            self.assertEqual(done.stdout, "")
            for text in texts:
                self.assertIn(text, done.stderr)
        self.assertFalse((self.folder / "capstan.db").exists())

    def test_unknown_key(self):
        self.refused("\n[transmission]\nsegmnets = 3\n",
                     "x.toml:3: transmission.segmnets: unknown key; did you mean 'segments'?")

    def test_wrong_type(self):
        self.refused('repetitions = "many"\n', "x.toml:1: repetitions: is a string, but must be an integer")

    def test_negative_length(self):
        self.refused("[[transmission.curvature]]\nlength_m = -1\n", "x.toml:2: ", "is -1 m, but must be above 0")

    def test_sensors_outside_the_cable(self):
        self.refused("[layouts]\nexplicit = [[1, 12]]\n", "x.toml:2: ", "node 12 is outside the cable")

    def test_twelve_sensors_on_eleven_nodes(self):
        self.refused("[layouts]\ncounts = [12]\n", "x.toml:2: ", "12 sensors do not fit on 11 nodes")

    def test_no_toml(self):
        self.refused("name = \n", "x.toml:1:", "not valid TOML")

    def test_instant_in_another_regime_lists_those_that_fit(self):
        self.refused('[[regime]]\nname = "partial_proximal"\nsamples = [112]\nduty_fraction = 1\n'
                     '[estimation]\nweights = "same_regime"\n', "x.toml:3: ", "samples that are: ")

    def test_everything_at_once(self):
        self.refused('nmae = "x"\nseed = -1\n[layouts]\ncounts = [12]\n', "x.toml:1: ", "x.toml:2: ", "x.toml:4: ")

    def test_missing_file(self):
        done = self.run_capstan("study", "run", "none.toml", expect=2)
        self.assertIn("none.toml: no such file; `capstan config default -o none.toml` makes one", done.stderr)


class BadDatabase(CapstanTest):
    def quick(self, *words, **options):
        return self.run_capstan("study", "run", CONFIGS / "quick.toml", "--progress", "none", *words, **options)

    def test_no_database(self):
        self.write("notes.txt", "These are my notes; they are long enough to be no database at all.\n" * 5)
        before = (self.folder / "notes.txt").read_bytes()
        for words in (("study", "run", CONFIGS / "quick.toml"), ("recommend",), ("study", "list"), ("study", "delete", "1")):
            self.assertIn("is not a database", self.run_capstan(*words, "--db", "notes.txt", expect=3).stderr)
        self.assertEqual((self.folder / "notes.txt").read_bytes(), before)

    def test_somebody_elses_database(self):
        connection = sqlite3.connect(self.folder / "other.db")
        connection.execute("CREATE TABLE mine (x)")
        connection.commit()
        connection.close()
        before = (self.folder / "other.db").read_bytes()
        self.assertIn("not one of capstan's", self.quick("--db", "other.db", expect=3).stderr)
        self.assertEqual((self.folder / "other.db").read_bytes(), before)

    def test_newer_schema(self):
        self.quick()
        connection = sqlite3.connect(self.folder / "capstan.db")
        connection.execute("PRAGMA user_version = 99")
        connection.commit()
        connection.close()
        before = (self.folder / "capstan.db").read_bytes()
        for done in (self.quick(expect=3), self.run_capstan("recommend", expect=3)):
            self.assertIn("schema version 99, newer than", done.stderr)
        self.assertEqual((self.folder / "capstan.db").read_bytes(), before)

    def test_missing_database_and_study(self):
        self.assertIn("`capstan study run` creates", self.run_capstan("recommend", expect=3).stderr)
        self.assertFalse((self.folder / "capstan.db").exists())
        self.quick()
        self.assertIn("It holds 1 (quick, complete)", self.run_capstan("study", "show", "9", expect=3).stderr)

    def test_queries_only_read(self):
        self.quick()
        before = self.tables("capstan.db")
        for sql in ("DELETE FROM study", "DROP TABLE cell", "SELEC", "SELECT * FROM nothing"):
            self.assertIn("capstan query: ", self.run_capstan("query", sql, expect=2).stderr)
        self.assert_same_bits(before, self.tables("capstan.db"))


class BadPlace(CapstanTest):
    def as_nobody(self, *words):
        """Permissions mean nothing to root."""
        if os.getuid() != 0:
            return subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True)
        if not shutil.which("setpriv"):
            self.skipTest("root without setpriv")
        program = self.folder / "capstan"
        if not program.exists():
            shutil.copy(PROGRAM, program)
            shutil.copy(CONFIGS / "quick.toml", self.folder)
        self.folder.chmod(0o755)
        return subprocess.run(["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups", program, *words],
                              cwd=self.folder, capture_output=True, text=True)

    def test_read_only_folder(self):
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "mine.db")
        shutil.copy(CONFIGS / "quick.toml", self.folder)
        closed = self.folder / "closed"
        closed.mkdir()
        closed.chmod(0o555)
        self.addCleanup(closed.chmod, 0o755)
        done = self.as_nobody("study", "run", "quick.toml", "--db", "closed/x.db")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertRegex(done.stderr, "may not be written|you may read and write|you may write there")
        done = self.as_nobody("simulate", "quick.toml", "-o", "closed/x.csv")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("cannot write closed/x.csv: you may not write there", done.stderr)
        self.assertEqual(list(closed.iterdir()), [])

    def test_folder_that_does_not_exist(self):
        done = self.run_capstan("simulate", CONFIGS / "quick.toml", "-o", "none/x.csv", expect=1)
        self.assertIn("its folder does not exist", done.stderr)
        self.assertIn("is a folder", self.run_capstan("simulate", CONFIGS / "quick.toml", "-o", ".", expect=1).stderr)

    def test_an_output_that_cannot_be_written_is_told_before_the_work(self):
        pair = CONFIGS / "recordings" / "viscous-pair.csv"
        for option, file, code, text in (("--save", "none/m.toml", 1, "its folder does not exist"),
                                         ("--corrected", "none/m.toml", 1, "its folder does not exist"),
                                         ("--prediction", "x.xls", 2, "should end in .csv, .mat or .mcap"),
                                         ("--html", "-", 2, "name a file, such as page.html"),
                                         ("-o", "none/x.json", 1, "its folder does not exist"),
                                         ("-o", "x.pdf", 2, "it writes text, md, csv, json and html"),
                                         ("--db", "none/x.db", 3, "check that its folder exists")):
            done = self.run_capstan("diagnose", pair, option, file, expect=code)
            self.assertIn(text, done.stderr, option)
            self.assertNotIn("nominal model", done.stderr, option)
        self.assertEqual(list(self.folder.iterdir()), [])

    def small_disk(self, size):
        disk = self.folder / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", disk], capture_output=True)
        if mounted.returncode != 0:
            self.skipTest("may not mount a small disk here")
        self.addCleanup(subprocess.run, ["umount", "-l", disk], capture_output=True)
        return disk

    def test_full_disk_keeps_what_is_done(self):
        study = ("study", "run", CONFIGS / "paper.toml", "--repetitions", "20")
        self.run_capstan(*study, "--db", "complete.db")
        disk = self.small_disk("1m")
        done = self.run_capstan(*study, "--db", "disk/x.db", expect=3)
        self.assertIn("the disk is full", done.stderr)
        self.assertIn("capstan study resume", done.stderr)
        subprocess.run(["mount", "-o", "remount,size=30m", disk], check=True)
        self.run_capstan("study", "resume", "--db", "disk/x.db")
        self.assert_same_bits(self.tables("complete.db"), self.tables("disk/x.db"))

    def test_full_disk_leaves_no_half_file(self):
        disk = self.small_disk("16k")
        (disk / "motion.csv").write_text("what was here before")
        done = self.run_capstan("simulate", CONFIGS / "paper.toml", "-o", "disk/motion.csv", expect=1)
        self.assertIn("the disk is full", done.stderr)
        self.assertEqual((disk / "motion.csv").read_text(), "what was here before")
        self.assertEqual([path.name for path in disk.iterdir()], ["motion.csv"])

    def test_standard_output_on_a_full_disk(self):
        if not pathlib.Path("/dev/full").exists():
            self.skipTest("no /dev/full")
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "config", "default"], stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("cannot write to standard output", done.stderr)

    def test_a_study_survives_the_loss_of_standard_error(self):
        """Full, closed, or a pipe whose reader has gone: the messages are lost, the study is not."""
        command = [PROGRAM, "study", "run", str(CONFIGS / "quick.toml"), "--db"]
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "complete.db")
        for name, redirection in (("full", "2>/dev/full"), ("closed", "2>&-"), ("gone", "2> >(:)")):
            with self.subTest(name):
                database = f"{name}.db"
                done = subprocess.run(["bash", "-c", f'sleep 0.1; "$@" {redirection}', "bash", *command, database],
                                      cwd=self.folder, stdout=subprocess.DEVNULL)
                self.assertEqual(done.returncode, 0)
                self.assert_same_bits(self.tables("complete.db"), self.tables(database))


if __name__ == "__main__":
    unittest.main()
