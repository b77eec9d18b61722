"""The program as it is released has what a compiler and a linker can do against an overrun."""
import os
import subprocess
import unittest

CAPSTAN = os.environ["CAPSTAN"]


def readelf(*options):
    return subprocess.run(["readelf", "--wide", *options, CAPSTAN], capture_output=True, text=True, check=True).stdout


@unittest.skipUnless("Release" in os.environ.get("CAPSTAN_CONFIGURATION", ""), "no release")
class Hardened(unittest.TestCase):
    def test_its_addresses_are_not_known_before(self):
        self.assertIn("DYN (Position-Independent Executable file)", readelf("--file-header"))

    def test_its_tables_are_read_only_when_it_runs(self):
        self.assertIn("GNU_RELRO", readelf("--program-headers"))
        self.assertIn("BIND_NOW", readelf("--dynamic"))

    def test_its_stack_is_guarded_and_holds_no_code(self):
        self.assertIn("__stack_chk_fail", readelf("--dyn-syms"))
        stack = next(line for line in readelf("--program-headers").splitlines() if "GNU_STACK" in line)
        self.assertNotIn("RWE", stack)

    def test_calls_of_the_c_library_are_checked(self):
        self.assertRegex(readelf("--dyn-syms"), r"__\w+_chk")

    def test_jumps_are_marked_for_processors_that_check_them(self):
        """Debian's own start-up code has no such marks, so the linker cannot state the property of the complete program."""
        if os.uname().machine == "x86_64":
            with open(CAPSTAN, "rb") as program:
                self.assertGreater(program.read().count(b"\xf3\x0f\x1e\xfa"), 1000)  # endbr64


if __name__ == "__main__":
    unittest.main()
