"""Bugs planted into a copy of capstan/units, one at a time: the simulation of schedules has to find every one."""

import os
import pathlib
import subprocess
import tempfile
import unittest

SOURCES = pathlib.Path(os.environ["CAPSTAN_UNITS"])
TESTS = pathlib.Path(__file__).parent
COMPILE = os.environ["CAPSTAN_COMPILE"].split(";")
SCHEDULES = 20000

# What goes wrong, the file, what stands there, what is planted.
BUGS = (
    ("a lease is claimed whoever has it", "lease.cpp",
     "if (folder.create(name, lease_text(folder, now_s))) return", "folder.replace(name, lease_text(folder, now_s)); return"),
    ("the lease of a dead worker is held for ever", "lease.cpp", "now_s - *beat_s < Lease::stale_after_s", "now_s - *beat_s < 1e9"),
    ("the lease of a worker that lives is taken", "lease.cpp", "now_s - *beat_s < Lease::stale_after_s", "now_s - *beat_s < 2.0"),
    ("a lease is not given back", "lease.cpp", "folder_->remove(name_)", "(void)0"),
    ("no heart beats", "lease.cpp", "heart_(folder.beat(name_))", "heart_(nullptr)"),
    ("a record with a flipped bit is believed", "unit_record.cpp", "if (with_check(json) != *text) return std::nullopt;", ""),
    ("a record names no file", "unit_record.cpp", '{"file", record.file}', '{"file", record.worker}'),
    ("a unit beside which a worker waits counts as done", "unit_record.cpp", 'ending == ".done"', 'ending == ".done" || ending == ".standby"'),
    ("every unit is late at once", "unit_record.cpp", "if (had_s < after_s) return false;", "if (had_s < 0.0) return false; else return true;"),
    ("a unit is late where it took longer than the median", "unit_record.cpp", "had_s > factor * *middle", "had_s > *middle"),
    ("the hash is of the first bytes", "unit_record.cpp", "EVP_Digest(bytes.data(), bytes.size(),", "EVP_Digest(bytes.data(), bytes.size() / 2,"),
    ("a unit that was done meanwhile is computed again", "unit_worker.cpp",
     "if (read_unit_record(folder_, unit)) return;", ""),
    ("the result is merged again by whoever waited", "unit_worker.cpp", "if (work_.is_merged()) break;", ""),
    ("the merge begins before every unit has begun", "unit_worker.cpp", "else if (!is_done(unit))", "else if (false)"),
    ("the merge begins while units run", "unit_worker.cpp", "left && left->empty() && !work_.is_merged()", "left && !work_.is_merged()"),
    ("a damaged unit keeps its record", "unit_worker.cpp", "folder_.remove(done_file_of(unit));", ""),
    ("a damaged unit is not computed again", "unit_worker.cpp", "if (merged.damaged.empty()) return merged.end;", "return merged.end;"),
    ("nobody merges", "unit_worker.cpp", "!work_.is_merged()) return merge();", "!work_.is_merged()) return WorkEnd::complete;"),
    ("a file that is not what its record says is merged", "result_units.cpp",
     "if (!record || sha256_of(text) != record->sha256) {", "if (!record) {"),
    ("an answer is joined to another input", "result_units.cpp", "units_.inputs[static_cast<std::size_t>(unit - 1)]", "units_.inputs[0]"),
    ("the hash kept is of another text", "result_units.cpp", "sha256_of(result.text), units_", 'sha256_of(result.text + " "), units_'),
    ("each worker counts as another program", "result_units.cpp", "units_.computed_with};", "leases_.worker()};"),
    ("a merged result is not seen", "result_units.cpp", "return results_.modified_s(merged_results).has_value();", "return false;"),
    ("every result counts as merged", "result_units.cpp", "return results_.modified_s(merged_results).has_value();", "return true;"),
    ("answers are joined without a comma", "result_units.cpp", 'rows.empty() ? "" : ",\\n"', 'rows.empty() ? "" : "\\n"'),
    ("the result is not written", "result_units.cpp", "results_.replace(file, result.text);", ""),
    ("a damaged file is not replaced", "result_units.cpp", "results_.replace(file, result.text);", "results_.create(file, result.text);"),
)


class PlantedBugs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.objects = {}
        for source in (*(SOURCES / name for name in {bug[1] for bug in BUGS}), TESTS / "simulation.cpp", TESTS / "simulate_schedules.cpp"):
            cls.objects[source.name] = cls.compile(source, source.stem)

    @classmethod
    def compile(cls, source, name):
        made = cls.folder / f"{name}.o"
        subprocess.run([*COMPILE, "-c", str(source), f"-I{TESTS}", "-o", str(made)], check=True)
        return made

    def simulate(self, objects):
        program = self.folder / "simulate"
        subprocess.run([COMPILE[0], *map(str, objects), "-o", str(program), "-lcrypto"], check=True)
        try:
            return subprocess.run([str(program), "--count", str(SCHEDULES), "--until-failure"], capture_output=True, text=True, timeout=1800)
        except subprocess.TimeoutExpired:
            return None

    def test_none_is_found_where_none_is(self):
        done = self.simulate(self.objects.values())
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_every_one_is_found(self):
        for what, name, right, wrong in BUGS:
            with self.subTest(what):
                text = (SOURCES / name).read_text()
                joined = " ".join(text.split())
                self.assertEqual(joined.count(right), 1, "the source has changed: plant the bug again")
                planted = self.folder / name
                # Lines may have been broken anywhere: only directives need a line of their own.
                lines = text.split("\n")
                head = [line for line in lines if line.startswith("#")]
                body = " ".join(" ".join(line.split("//")[0] for line in lines if not line.startswith("#")).split())
                self.assertEqual(body.count(right), 1)
                planted.write_text("\n".join(head) + "\n" + body.replace(right, wrong) + "\n")
                objects = {**self.objects, name: self.compile(planted, "planted")}
                done = self.simulate(objects.values())
                found = "in time" if done is None else done.stdout.split("\n")[0]
                print(f"{what}: {found[:160]}", flush=True)
                self.assertTrue(done is None or done.returncode == 1, "no schedule fails")


if __name__ == "__main__":
    unittest.main()
