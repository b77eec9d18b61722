"""What is stored proves itself: damage is found and named, shards that were computed differently are refused, and a part
computed again has the same bits."""

import contextlib
import json
import os
import random
import shutil
import sqlite3
import struct
import subprocess
import unittest

from capstan_program import CONFIGS, PROGRAM, CapstanTest
from small_study import short_worlds

STUDY = (CONFIGS / "quick.toml", "--repetitions", "20")
INSTANTS = (CONFIGS / "noise-instants.toml", "--repetitions", "20")
WORLDS = ("worlds.toml", "--repetitions", "20")


def widths():
    """Of this program on this processor, widest first."""
    done = subprocess.run([PROGRAM, "doctor"], env={**os.environ, "CAPSTAN_SIMD": "none"}, capture_output=True, text=True)
    return done.stderr.strip().split(" has ")[1].split(", ")


class IntegrityTest(CapstanTest):
    def setUp(self):
        super().setUp()
        self.write("worlds.toml", short_worlds())

    def change(self, db, sql, *values):
        with contextlib.closing(sqlite3.connect(self.folder / db)) as connection:
            connection.execute(sql, values)
            connection.commit()

    def value(self, db, sql):
        with contextlib.closing(sqlite3.connect(self.folder / db)) as connection:
            return connection.execute(sql).fetchone()

    def doctor(self, db, expect=0):
        return json.loads(self.run_capstan("doctor", "--db", db, "--json", expect=expect).stdout)["database"]

    def run_study(self, db, *words, study=STUDY, **options):
        self.run_capstan("study", "run", *study, "--db", db, "--progress", "none", *words, **options)


class Doctor(IntegrityTest):
    def test_a_whole_study_passes(self):
        self.run_study("a.db")
        found = self.doctor("a.db")
        self.assertTrue(found["is_intact"])
        self.assertEqual((found["hashed_parts"], found["unhashed"]), (2 * 2 + 3, []))  # units; description, conclusions, study

    def test_a_bit_of_any_measured_number_is_found(self):
        """Of the real study, as a program of others could change it; tests/storage tries 2,000 in every table."""
        self.run_study("a.db")
        choice = random.Random(6)
        for table, column in (("cell", "bias_N"), ("cell_block", "mean_abs_error_N"), ("cell_node", "bias_N"),
                              ("single_sensor_node", "tension_q025_N"), ("scenario_node", "true_tension_N"),
                              ("recommendation", "error_N"), ("layout_error", "rms_error_N"), ("sensor_weight", "weight_fraction")):
            rows = self.value("a.db", f"SELECT count(*) FROM {table}")[0]
            row = f"(SELECT {column} FROM {table} LIMIT 1 OFFSET {choice.randrange(rows)})"
            before = self.value("a.db", f"SELECT {row}")[0]
            bits = struct.unpack("<Q", struct.pack("<d", before))[0] ^ 1 << choice.randrange(52)
            after = struct.unpack("<d", struct.pack("<Q", bits))[0]
            self.change("a.db", f"UPDATE {table} SET {column} = ? WHERE {column} = ?", after, before)
            problems = self.doctor("a.db", expect=3)["problems"]
            self.assertIn(f"table {table} is not as it was written", " ".join(problems))
            self.change("a.db", f"UPDATE {table} SET {column} = ? WHERE {column} = ?", before, after)
        self.assertEqual(self.doctor("a.db")["problems"], [])

    def test_what_it_was_computed_with_is_stored(self):
        self.run_study("a.db", "--simd", "SCALAR")
        version = self.run_capstan("--version").stdout.split()[1].rstrip(".,")
        simd, compiler, stored = self.value("a.db", "SELECT simd, compiler, program_version FROM computed_with")
        self.assertEqual((simd, stored), ("SCALAR", version))
        self.assertRegex(compiler, r"^(g|clang)\+\+ \d+")
        shown = json.loads(self.run_capstan("study", "show", "--json", "--db", "a.db").stdout)
        self.assertEqual(shown["computed_with"], [{"simd": simd, "compiler": compiler, "program_version": stored}])
        self.assertEqual((shown["content_sha256"],), self.value("a.db", "SELECT sha256 FROM content_hash WHERE part = 'study'"))
        self.assertIn("this program on this processor has", self.run_capstan(
            "study", "run", *STUDY, "--db", "b.db", "--simd", "MMX", expect=2).stderr)
        self.assertFalse((self.folder / "b.db").exists())

    def test_resume_keeps_the_width_of_the_study(self):
        self.run_study("a.db", "--simd", "SCALAR")
        expected = self.tables("a.db")
        process = self.start_capstan("study", "run", *STUDY, "--db", "b.db", "--simd", "SCALAR", "--progress", "json")
        for line in process.stderr:
            if '"done":1,' in line:
                break
        self.end(process)
        self.run_capstan("study", "resume", "--db", "b.db")
        self.assert_same_bits(expected, self.tables("b.db"))
        self.assertEqual(self.value("b.db", "SELECT count(*) FROM computed_with"), (1,))


class Merge(IntegrityTest):
    def run_shards(self, study, *words):
        for number in (1, 2):
            self.run_study(f"{number}.db", "--shard", f"{number}/2", *words, study=study)

    def refusal(self):
        messages = self.run_capstan("study", "merge", "--db", "merged.db", "1.db", "2.db", expect=3).stderr
        self.assertFalse((self.folder / "merged.db").exists())
        return messages

    def test_a_damaged_shard_is_named_with_unit_and_table(self):
        self.run_shards(INSTANTS)
        self.change("2.db", "UPDATE cell SET rms_error_N = rms_error_N * (1 + 1e-15) WHERE cell_id = (SELECT max(cell_id) FROM cell)")
        message = self.refusal()
        self.assertIn("2.db is damaged (study 1 (noise instants), unit ", message)
        self.assertIn("table cell is not as it was written); run it again, into a new file", message)

    def test_a_damaged_shard_of_worlds_is_named(self):
        self.run_shards(WORLDS)
        self.change("1.db", "UPDATE world_error SET load_end_error_N = load_end_error_N * (1 + 1e-15) WHERE world = 6")
        self.assertIn("1.db is damaged (study 1 (wrist exosuit), worlds as_stated, numbers 0 to 63: table world_error is not",
                      self.refusal())

    def test_shards_of_another_width_are_refused(self):
        width = widths()[0]
        if width == "SCALAR":
            self.skipTest("this processor has one width only")
        for study in (STUDY, WORLDS):
            with self.subTest(study):
                self.run_study("1.db", "--shard", "1/2", "--simd", width, study=study)
                self.run_study("2.db", "--shard", "2/2", "--simd", "SCALAR", study=study)
                message = self.refusal()
                self.assertRegex(message, "2.db was computed with SIMD SCALAR, .* but 1.db with SIMD " + width)
                self.assertIn(f"run it again into a new file, with the same program and --simd {width}", message)
                (self.folder / "1.db").unlink()
                (self.folder / "2.db").unlink()

    def test_a_shard_goes_on_at_its_own_width_only(self):
        if widths()[0] == "SCALAR":
            self.skipTest("this processor has one width only")
        process = self.start_capstan("study", "run", *INSTANTS, "--shard", "1/2", "--db", "1.db", "--simd", "SCALAR", "--progress", "json")
        for line in process.stderr:
            if '"done":2,' in line:
                break
        self.end(process)
        done = self.run_capstan("study", "run", *INSTANTS, "--shard", "1/2", "--db", "1.db", expect=3)
        self.assertIn("1.db was begun with SIMD SCALAR", done.stderr)
        self.run_capstan("study", "run", *INSTANTS, "--shard", "1/2", "--db", "1.db", "--simd", "SCALAR")

    def test_one_stated_width_has_the_bits_of_one_run(self):
        """The merge computes its conclusions at the shards' width, whatever the processor has."""
        for study in (STUDY, WORLDS):
            with self.subTest(study):
                self.run_study("complete.db", "--simd", "SCALAR", study=study)
                self.run_shards(study, "--simd", "SCALAR")
                self.run_capstan("study", "merge", "--db", "merged.db", "1.db", "2.db")
                self.assert_same_bits(self.tables("complete.db"), self.tables("merged.db"))
                for name in self.folder.glob("*.db*"):
                    name.unlink()

    def test_a_merge_at_another_width_is_refused(self):
        if widths()[0] == "SCALAR":
            self.skipTest("this processor has one width only")
        self.run_shards(STUDY, "--simd", widths()[0])
        done = self.run_capstan("study", "merge", "--db", "m.db", "--simd", "SCALAR", "1.db", "2.db", expect=3)
        self.assertIn("Merge them with --simd " + widths()[0], done.stderr)


class Verify(IntegrityTest):
    def verify(self, db, *words, expect=0):
        return json.loads(self.run_capstan("study", "verify", "--db", db, "--json", *words, expect=expect).stdout)

    def test_units_computed_again_have_the_same_bits(self):
        self.run_study("a.db", study=INSTANTS)
        self.assertEqual(self.verify("a.db", "--share", 1)["problems"], [])
        self.assertEqual(self.verify("a.db")["compared"], 3)  # of 56
        before = (self.folder / "a.db").read_bytes()
        self.verify("a.db", "--share", 0.2, "--jobs", 7)
        self.assertEqual(before, (self.folder / "a.db").read_bytes())

    def test_worlds_computed_again_have_the_same_bits(self):
        self.run_study("w.db", study=WORLDS)
        found = self.verify("w.db", "--share", 0.2)
        self.assertEqual((found["problems"], found["compared"]), ([], -(-found["units"] // 5)))

    def test_a_wrong_number_with_the_right_hash_is_found(self):
        """As of a processor that computes wrongly: the hash is that of what it stored."""
        self.run_study("a.db", study=INSTANTS)
        self.change("a.db", "UPDATE cell_node SET bias_N = bias_N + 1e-6 WHERE cell_id = (SELECT max(cell_id) FROM cell)")
        self.change("a.db", "DELETE FROM content_hash")
        self.assertEqual(len(self.doctor("a.db")["unhashed"]), 1)
        self.assertEqual(self.verify("a.db", "--share", 1, expect=3)["problems"],
                         ["unit 55: table cell_node is not what this program computes"])

    def test_a_sample_can_be_repeated(self):
        self.run_study("a.db", study=INSTANTS)
        self.change("a.db", "UPDATE cell SET bias_N = bias_N + 1e-6")
        first = self.verify("a.db", "--share", 0.1, "--seed", 3, expect=3)
        self.assertEqual(first, self.verify("a.db", "--share", 0.1, "--seed", 3, expect=3))
        others = [self.verify("a.db", "--share", 0.1, "--seed", seed, expect=3)["problems"] for seed in (4, 5)]
        self.assertTrue(any(first["problems"] != other for other in others))


if __name__ == "__main__":
    unittest.main()
