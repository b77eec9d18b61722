"""Every request for memory failing in turn, over a small study: a clear error, no crash, nothing corrupt, and going on ends
with the same bits.

CAPSTAN_MEMORY_FAULTS says how many requests are tried, spread evenly (150); `all` tries every one."""

import os
import subprocess
import unittest

from capstan_program import PROGRAM, CapstanTest
from small_study import SMALL_STUDY, integrity

SHIM = os.environ["CAPSTAN_ALLOCATION_FAULTS"]
TRIED = os.environ.get("CAPSTAN_MEMORY_FAULTS", "150")

TINY = SMALL_STUDY.format(seed=1)
for one, other in (("samples = [15, 18, 21, 39, 42, 45]", "samples = [15]"), ("repetitions = 20", "repetitions = 3"),
                   ("segments = 6", "segments = 3"), ("counts = [1, 2, 3]", "counts = [1]"),
                   ('[[noise]]\nlabel = "0.2 N"\nadditive_N = 0.2\n', "")):
    assert one in TINY, one
    TINY = TINY.replace(one, other)


class MemoryFaults(CapstanTest):
    def faulty(self, at, *words):
        return subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=300,
                              env={**os.environ, "LD_PRELOAD": SHIM, "CAPSTAN_FAULT_AT": str(at), "CAPSTAN_FAULT_COUNT": "count"})

    def test_a_study(self):
        self.write("tiny.toml", TINY)
        self.run_capstan("study", "run", "tiny.toml", "--db", "whole.db")
        expected = self.tables("whole.db")
        words = ("study", "run", "tiny.toml", "--db", "faulty.db", "--jobs", 1, "--progress", "none")
        done = self.faulty(0, *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        answer = done.stdout
        count = int((self.folder / "count").read_text())
        self.assertGreater(count, 1000)
        wanted = count if TRIED == "all" else min(count, int(TRIED))
        ended, crashes = 0, []
        for k in range(wanted):
            at = 1 + k * (count - 1) // max(1, wanted - 1)
            for path in self.folder.glob("faulty.db*"):
                path.unlink()
            done = self.faulty(at, *words)
            if done.returncode == 0:
                self.assertEqual(done.stdout, answer, f"request {at}")
            else:
                ended += 1
                if done.returncode not in (1, 3) or "out of memory" not in done.stderr.lower():
                    crashes.append((at, done.returncode, done.stderr))
            path = self.folder / "faulty.db"
            if path.exists():
                self.assertEqual(integrity(path), ["ok"], f"request {at}")
            if done.returncode != 0:
                self.go_on()
            self.assert_same_bits(expected, self.tables("faulty.db"))
        self.assertEqual(crashes, [], f"{len(crashes)} of {wanted}")
        self.assertGreater(ended, wanted // 2)
        print(f"{wanted} of {count} requests for memory failed, one in each run: {ended} runs ended with an error that says "
              f"so, the others did without", flush=True)

    def go_on(self):
        resumed = subprocess.run([PROGRAM, "study", "resume", "latest", "--db", "faulty.db"], cwd=self.folder,
                                 capture_output=True, timeout=300)
        if resumed.returncode != 0:
            self.run_capstan("study", "run", "tiny.toml", "--db", "faulty.db")  # it had not begun


if __name__ == "__main__":
    unittest.main()
