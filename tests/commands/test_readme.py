"""The commands of the README, every line in order, in an empty folder, as a reader types them."""

import re
import signal
import subprocess
import time
import unittest

from capstan_program import CONFIGS, PROGRAM, CapstanTest

# They build the project or install it, which other tests do.
OTHERS = ("studies/run", "tests/run", "cmake", "cpack")


def commands(text):
    for block in re.findall(r"^```sh\n(.*?)^```", text, flags=re.M | re.S):
        for line in block.splitlines():
            command = line.split(" #")[0].strip()
            if command and not command.startswith(OTHERS):
                yield command


class Readme(CapstanTest):
    def setUp(self):
        super().setUp()
        (self.folder / "build").mkdir()
        (self.folder / "build" / "capstan").symlink_to(PROGRAM)
        (self.folder / "configs").symlink_to(CONFIGS)

    def test_every_command_runs_as_it_stands(self):
        lines = list(commands((CONFIGS.parent / "README.md").read_text()))
        self.assertGreater(len(lines), 15)
        for line in lines:
            with self.subTest(line):
                if " serve" in line:
                    self.serve(line)
                    continue
                done = subprocess.run(line, shell=True, cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout}\n{done.stderr}")

    def serve(self, line):
        program = subprocess.Popen(["sh", "-c", "exec " + line + " --port 0"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        self.assertIn("http://", program.stdout.readline() + program.stdout.readline())
        time.sleep(0.5)
        program.send_signal(signal.SIGTERM)
        program.communicate(timeout=120)


if __name__ == "__main__":
    unittest.main()
