"""Every request for memory in a study failing in turn: a clear error or an answer as without it, nothing corrupt, and going on
ends with the same bits.

CAPSTAN_MEMORY_FAULTS says how many requests are tried, spread evenly (600); `all` tries every one."""

import os
import unittest

from faulty_program import FaultyTest
from small_study import SMALL_STUDY

TRIED = os.environ.get("CAPSTAN_MEMORY_FAULTS", "600")

TINY = SMALL_STUDY.format(seed=1)
for one, other in (("samples = [15, 18, 21, 39, 42, 45]", "samples = [15]"), ("repetitions = 20", "repetitions = 3"),
                   ("segments = 6", "segments = 3"), ("counts = [1, 2, 3]", "counts = [1]"),
                   ('[[noise]]\nlabel = "0.2 N"\nadditive_N = 0.2\n', "")):
    assert one in TINY, one
    TINY = TINY.replace(one, other)


class MemoryFaults(FaultyTest):
    shim = os.environ["CAPSTAN_ALLOCATION_FAULTS"]

    def test_a_study(self):
        self.write("tiny.toml", TINY)
        self.run_capstan("study", "run", "tiny.toml", "--db", "complete.db")
        expected = self.tables("complete.db")
        words = ("study", "run", "tiny.toml", "--db", "faulty.db", "--jobs", 1, "--progress", "none")
        count, answer = self.count_of(*words)
        self.assertGreater(count, 1000)
        wanted = count if TRIED == "all" else min(count, int(TRIED))
        process = self.start_faulty(*words)
        ended, crashes, other_reasons = 0, [], []
        for k in range(wanted):
            at = 1 + k * (count - 1) // max(1, wanted - 1)
            if k % 1000 == 999:
                print(f"  {k + 1} of {wanted} requests tried", flush=True)
            self.remove("faulty.db*")
            done = self.faulty(process, at)
            if done.returncode == 0:
                self.assertEqual(done.stdout, answer, f"request {at}")
            else:
                ended += 1
                if done.returncode not in (1, 2, 3) or not done.stderr.strip() or "terminate" in done.stderr:
                    crashes.append((at, done.returncode, done.stderr))
                elif "out of memory" not in done.stderr.lower():
                    # A library took the lack of memory for wrong input.
                    other_reasons.append((at, done.returncode, done.stderr))
                    print(f"request {at}: code {done.returncode}, {done.stderr}", flush=True)
            if self.left_before("faulty.db*", done.returncode):
                continue
            self.assert_whole("faulty.db", f"request {at}")
            if done.returncode != 0:
                if not self.is_new(at, "faulty.db*"):
                    continue
                self.go_on()
            self.assert_same_bits(expected, self.tables("faulty.db"))
        self.assertEqual(crashes, [], f"{len(crashes)} of {wanted}")
        self.assertLess(len(other_reasons), max(3, wanted // 50), other_reasons)
        self.assertGreater(ended, wanted // 2)
        print(f"{wanted} of {count} requests for memory failed, one in each run: {ended} runs ended with an error that says "
              f"so ({len(other_reasons)} with another reason), the others did without; {len(self.judged)} different files were left, of {len(self.continued)} different "
              f"contents, each gone on from", flush=True)

    def go_on(self):
        if self.run_capstan_any("study", "resume", "latest", "--db", "faulty.db").returncode != 0:
            self.run_capstan("study", "run", "tiny.toml", "--db", "faulty.db")  # it had not begun


if __name__ == "__main__":
    unittest.main()
