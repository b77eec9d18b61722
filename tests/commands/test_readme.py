"""The commands of the README, every line in order, in an empty folder, as a reader types them. The configurations have fewer
repetitions and shorter motions than those that are shipped: whether a command runs does not depend on them."""

import re
import signal
import subprocess
import time
import unittest

from capstan_program import CONFIGS, PROGRAM, CapstanTest
from small_study import short_worlds

# They build the project or install it, which other tests do.
OTHERS = ("studies/run", "tests/run", "reports/book/run", "cmake", "cpack")
WORLDS = ("wrist-exosuit", "noise-sweep")


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
        configs = self.folder / "configs"
        configs.mkdir()
        for path in CONFIGS.iterdir():
            if path.suffix == ".toml":
                text = short_worlds(path.stem) if path.stem in WORLDS else path.read_text()
                (configs / path.name).write_text(re.sub(r"^repetitions = .*", "repetitions = 40", text, flags=re.M))
            else:
                (configs / path.name).symlink_to(path)

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
