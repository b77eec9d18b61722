"""What the system does to a command: signals, limits, broken streams, files that vanish. Nothing is lost, nothing is silent."""

import os
import pty
import resource
import signal
import subprocess
import time
import unittest

from capstan_program import CONFIGS, PROGRAM, CapstanTest

LONG = "\n".join("repetitions = 3000" if line.startswith("repetitions") else line
                 for line in (CONFIGS / "noise-instants.toml").read_text().splitlines()) + "\n"
EVIL = "a\x1b]0;evil\x07\x9b2J\u202e"


class Outside(CapstanTest):
    def begin_study(self, db="results.db"):
        """A long study, once its first unit is stored."""
        self.write("long.toml", LONG)
        process = self.start_capstan("study", "run", "long.toml", "--db", db, "--progress", "json")
        for line in process.stderr:
            if '"done":' in line and '"done":0' not in line and '"done":null' not in line:
                return process
        self.fail("the study ended")

    def test_a_database_that_is_removed_is_missed(self):
        process = self.begin_study()
        for file in self.folder.glob("results.db*"):
            file.unlink()
        _, error = process.communicate()
        self.assertEqual(process.returncode, 3, error)
        self.assertIn("was removed or renamed", error)

    def test_signals_end_a_study_in_words_and_it_resumes(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            db = f"{number.name}.db"
            process = self.begin_study(db)
            process.send_signal(number)
            _, error = process.communicate()
            self.assertEqual(process.returncode, 130, error)
            self.assertIn("study resume 1", error)
            self.assertIn("passed", self.run_capstan("doctor", "--db", db).stdout)

    def test_a_limit_on_file_sizes_is_named(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))

        done = subprocess.run([PROGRAM, "study", "run", CONFIGS / "noise-instants.toml", "--db", "f.db", "--progress", "none"],
                              cwd=self.folder, capture_output=True, text=True, preexec_fn=limit)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("Cannot", done.stderr)
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "q.db")
        done = subprocess.run([PROGRAM, "report", "--db", "q.db", "-o", "r.html"], cwd=self.folder, capture_output=True, text=True,
                              preexec_fn=limit)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("ulimit -f", done.stderr)
        self.assertFalse((self.folder / "r.html").exists())

    def test_a_broken_standard_error_ends_nothing(self):
        for stream in ("2>/dev/full", "2>&-"):
            db = f"{len(stream)}.db"
            done = subprocess.run(f"'{PROGRAM}' study run '{CONFIGS}/quick.toml' --db {db} {stream}", shell=True, cwd=self.folder,
                                  stdout=subprocess.PIPE)
            self.assertEqual(done.returncode, 0, stream)
            self.assertIn("complete", self.run_capstan("study", "list", "--db", db).stdout)
            self.assertEqual(subprocess.run(f"'{PROGRAM}' nonsense {stream}", shell=True, cwd=self.folder).returncode, 2)

    def test_a_pipe_is_not_waited_for(self):
        os.mkfifo(self.folder / "pipe.db")
        for words in (("recommend",), ("study", "run", CONFIGS / "quick.toml"), ("serve", "--port", 0)):
            self.assertIn("a pipe", self.run_capstan(*words, "--db", "pipe.db", expect=3, timeout=60).stderr)

    def test_names_cannot_steer_a_terminal(self):
        name = EVIL.encode("unicode_escape").decode().replace("\\x", "\\u00")
        self.write("evil.toml", f'name = "{name}"\n' + (CONFIGS / "quick.toml").read_text().split("\n", 1)[1].replace(
            'name = "quick"', ""))
        for words in (("study", "run", "evil.toml"), ("study", "list"), ("study", "show", 1), ("recommend",),
                      ("query", "SELECT name FROM study"), ("study", "show", 9)):
            main, side = pty.openpty()
            process = subprocess.Popen([PROGRAM, *map(str, words), "--db", "evil.db"], cwd=self.folder, stdout=side, stderr=side)
            os.close(side)
            told = b""
            try:
                while part := os.read(main, 65536):
                    told += part
            except OSError:  # the last writer has gone
                pass
            os.close(main)
            process.wait()
            self.assertNotIn(b"\x1b]", told, words)
            self.assertNotIn(b"\x07", told, words)
            self.assertNotIn("\x9b".encode(), told, words)
        self.assertIn("\\x1b]0;evil\\x07\\x9b2J\\xe2\\x80\\xae", self.run_capstan("study", "list", "--db", "evil.db").stdout)

    def test_a_number_that_is_none_or_too_large_is_refused_in_words(self):
        for text, told in (("1e3", "is '1e3', but must be an integer"), ("1", "must be at least 2"),
                           ("999999999999", "must be at least 2 and at most 10000000")):
            self.assertIn(told, self.run_capstan("place", CONFIGS / "quick.toml", "--repetitions", text, expect=2).stderr)
        words = ("calibrate", CONFIGS / "recordings" / "viscous-pair.csv", "--fit", "pretension,pretension")
        self.assertIn("named twice", self.run_capstan(*words, expect=2).stderr)

    def test_long_lists_of_problems_are_short(self):
        self.write("bad.toml", "[sweep]\nfriction_ratio = [" + ",".join(["-1.0"] * 100_000) + "]\n")
        done = self.run_capstan("study", "run", "bad.toml", expect=2)
        self.assertIn("(100000 times)", done.stderr)
        self.assertLess(len(done.stderr), 10_000)
        self.write("bad.toml", "[sweep]\nfriction_ratio = [" + ",".join(f"-{k}.0" for k in range(1, 100_000)) + "]\n")
        done = self.run_capstan("study", "run", "bad.toml", expect=2)
        self.assertIn("more problems", done.stderr)
        self.assertLess(len(done.stderr), 10_000)

    def test_upper_bounds_are_named(self):
        self.write("many.toml", "repetitions = 1000000000\n")
        self.assertIn("must be at most 10000000", self.run_capstan("study", "run", "many.toml", expect=2).stderr)

    def test_a_query_past_its_time_is_ended(self):
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "q.db")
        begin = time.monotonic()
        for sql in ("select instr(printf('%.*c',999999,'a'),printf('%.*c',499999,'a')||'b')",
                    "with recursive n(x) as (select 1 union all select x + 1 from n) select count(*) from n"):
            done = self.run_capstan("query", sql, "--db", "q.db", "--time-limit", 0.5, expect=1)
            self.assertIn("took longer than 0.5 s", done.stderr)
        print(f"two endless queries took {time.monotonic() - begin:.1f} s")


if __name__ == "__main__":
    unittest.main()
