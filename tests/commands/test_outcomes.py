"""Signals, broken outputs and limits: one table of outcomes, printed. Nothing is lost, nothing is silent.

A study that is ended resumes to the bits of one that nobody disturbed. A command whose answer is lost says so and ends with
another code than 0."""

import math
import os
import resource
import signal
import subprocess
import time
import unittest

from capstan_program import CONFIGS, PROGRAM, CapstanTest

STUDY = "\n".join("repetitions = 400" if line.startswith("repetitions") else line
                  for line in (CONFIGS / "noise-instants.toml").read_text().splitlines()) + "\n"
SLOW = "\n".join("repetitions = 2000" if line.startswith("repetitions") else line
                 for line in (CONFIGS / "paper.toml").read_text().splitlines()) + "\n"
ENDING = ("HUP", "INT", "QUIT", "PIPE", "ALRM", "TERM", "USR1", "USR2", "XCPU", "VTALRM", "PROF")
CUSTOM = ("INT", "PIPE")  # these end a command that stores nothing as they end any other: the sender knows
rows = []


def tell(what, command, code, words):
    rows.append((what, command, code, words.strip().splitlines()[-1][:90] if words.strip() else "-"))


class Outcomes(CapstanTest):
    @classmethod
    def tearDownClass(cls):
        print("\n" + "\n".join("{:<22} {:<14} {:>5}  {}".format(*map(str, row)) for row in [("what", "command", "code", "last words")] + rows))

    def undisturbed(self, study=STUDY):
        self.run_capstan("study", "run", self.write("study.toml", study), "--db", "complete.db", "--progress", "none")
        return self.tables("complete.db")

    def undisturbed_for(self, processor_s):
        """A study that takes so much processor time here at least, however fast the processor is."""
        repetitions = 3000
        while True:
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            tables = self.undisturbed(STUDY.replace("repetitions = 400", f"repetitions = {repetitions}"))
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            used_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            if used_s >= processor_s:
                return tables
            (self.folder / "complete.db").unlink()
            repetitions = math.ceil(1.2 * repetitions * processor_s / used_s)

    def begin_study(self, db):
        process = self.start_capstan("study", "run", "study.toml", "--db", db, "--progress", "json")
        for line in process.stderr:
            if '"done":' in line and '"done":0' not in line and '"done":null' not in line:
                return process
        self.fail("the study ended")

    def goes_on(self, db, expected):
        self.assertIn("passed", self.run_capstan("doctor", "--db", db).stdout)
        self.run_capstan("study", "resume", 1, "--db", db, "--progress", "none")
        self.assert_same_bits(expected, self.tables(db))

    def test_signals_stop_a_study_in_words_and_it_goes_on(self):
        expected = self.undisturbed()
        for name in ENDING:
            process = self.begin_study(name + ".db")
            process.send_signal(getattr(signal, "SIG" + name))
            _, said = process.communicate()
            tell("SIG" + name, "study run", process.returncode, said)
            self.assertEqual(process.returncode, 130, (name, said))
            self.assertIn("study resume 1", said, name)
            self.goes_on(name + ".db", expected)

    def test_what_cannot_be_caught_loses_no_finished_unit(self):
        expected = self.undisturbed()
        process = self.begin_study("KILL.db")
        process.kill()
        _, said = process.communicate()
        tell("SIGKILL", "study run", process.returncode, "")
        self.goes_on("KILL.db", expected)

    def test_a_study_that_is_halted_goes_on(self):
        expected = self.undisturbed()
        process = self.begin_study("TSTP.db")
        process.send_signal(signal.SIGTSTP)
        time.sleep(0.3)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGCONT)
        _, said = process.communicate()
        tell("SIGTSTP, SIGCONT", "study run", process.returncode, said)
        self.assertEqual(process.returncode, 0, said)
        self.assert_same_bits(expected, self.tables("TSTP.db"))

    def test_a_signal_about_a_file_size_ends_nothing(self):
        """The write that fails is told; the signal itself says nothing new."""
        expected = self.undisturbed()
        process = self.begin_study("XFSZ.db")
        process.send_signal(signal.SIGXFSZ)
        _, said = process.communicate()
        tell("SIGXFSZ", "study run", process.returncode, said)
        self.assertEqual(process.returncode, 0, said)
        self.assert_same_bits(expected, self.tables("XFSZ.db"))

    def test_signals_end_a_command_that_stores_nothing_in_words(self):
        self.write("slow.toml", SLOW)
        for name in ENDING:
            process = self.start_capstan("place", "slow.toml", "--progress", "json", "-o", "answer.txt")
            process.stderr.readline()
            process.send_signal(getattr(signal, "SIG" + name))
            _, said = process.communicate()
            tell("SIG" + name, "place", process.returncode, said)
            self.assertEqual(process.returncode, -getattr(signal, "SIG" + name), (name, said))
            if name not in CUSTOM:
                self.assertIn("ended by SIG" + name, said)
            self.assertEqual(list(self.folder.glob("answer*")), [], name)

    def limited(self, what, limit, *words, expect):
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True, preexec_fn=limit)
        tell(what, words[0] if words[0] != "study" else "study run", done.returncode, done.stderr)
        self.assertIn(done.returncode, expect, done.stderr)
        if done.returncode != 0:
            self.assertTrue(done.stderr.strip(), what)
        return done

    def test_limits_are_named(self):
        expected = self.undisturbed_for(4.0)  # the shortest limit is 1 s
        study = ("study", "run", "study.toml", "--progress", "none")

        def set_to(which, soft, hard=None):
            return lambda: resource.setrlimit(which, (soft, hard or soft))

        done = self.limited("processor time", set_to(resource.RLIMIT_CPU, 1, 100), *study, "--db", "cpu.db", expect=(130,))
        self.assertIn("study resume", done.stderr)
        self.goes_on("cpu.db", expected)
        done = self.limited("file size", set_to(resource.RLIMIT_FSIZE, 200_000), *study, "--db", "fsize.db", expect=(3,))
        self.assertIn("Cannot", done.stderr)
        self.limited("memory", set_to(resource.RLIMIT_AS, 60_000_000), *study, "--db", "as.db", expect=(1, 127))
        self.limited("open files", set_to(resource.RLIMIT_NOFILE, 4), *study, "--db", "nofile.db", expect=(1, 3))
        for db in ("fsize.db", "as.db", "nofile.db"):  # what is there is complete
            if (self.folder / db).exists() and (self.folder / db).stat().st_size:
                self.assertIn("passed", self.run_capstan("doctor", "--db", db).stdout)

        def one_process():
            if os.getuid() == 0:
                os.setgid(65534)
                os.setuid(65534)  # root has no such limit
            resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))

        self.folder.chmod(0o777)
        done = self.limited("processes", one_process, "place", CONFIGS / "quick.toml", "--repetitions", 20, expect=(0, 1))
        self.assertTrue(done.stdout if done.returncode == 0 else done.stderr)

    def test_broken_outputs(self):
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "q.db")
        for words in ("recommend --db q.db", "query 'SELECT * FROM cell' --db q.db", "report --db q.db --format md", "config default",
                      f"place '{CONFIGS}/quick.toml' --repetitions 20", "--help"):
            for stream, code in ((">/dev/full", 1), (">&-", 1), ("2>/dev/full", 0), ("2>&-", 0)):
                done = subprocess.run(f"'{PROGRAM}' {words} {stream}", shell=True, cwd=self.folder, capture_output=True, text=True)
                tell(stream, words.split()[0], done.returncode, done.stderr)
                self.assertEqual(done.returncode, code, (words, stream, done.stderr))
                self.assertIn("cannot write to standard output" if code else "", done.stderr)
        done = subprocess.run(f"'{PROGRAM}' study run '{CONFIGS}/quick.toml' --db full.db >/dev/full", shell=True, cwd=self.folder,
                              capture_output=True, text=True)
        tell(">/dev/full", "study run", done.returncode, done.stderr)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("complete", self.run_capstan("study", "list", "--db", "full.db").stdout)

    def test_a_reader_that_has_gone(self):
        """As in `capstan query ... | head -1`: the command ends, and what is stored stays."""
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "q.db")
        process = self.start_capstan("query", "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n LIMIT 100000) SELECT x FROM n", "--db", "q.db", "--format", "csv")
        process.stdout.readline()
        process.stdout.close()
        said = process.stderr.read()
        process.wait()
        tell("reader gone", "query", process.returncode, said)
        self.assertIn(process.returncode, (-signal.SIGPIPE, 1), said)
        self.assertIn("complete", self.run_capstan("study", "list", "--db", "q.db").stdout)


if __name__ == "__main__":
    unittest.main()
