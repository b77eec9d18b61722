"""`capstan export` writes a table row by row: its memory does not grow with the table."""

import json
import os
import sqlite3
import subprocess
import unittest

from capstan_program import PROGRAM, CapstanTest
from small_study import SMALL_STUDY

ROWS = 400_000


class ExportMemory(CapstanTest):
    def max_memory_KiB(self, *words):
        """Of a finished command, as the system counted it."""
        # The address sanitizer would keep what is freed, and its 256 MB would be counted.
        environment = os.environ | {"ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":quarantine_size_mb=1"}
        process = subprocess.Popen([PROGRAM, *map(str, words)], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   env=environment)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        return usage.ru_maxrss

    def test_memory_does_not_grow_with_the_table(self):
        self.write("small.toml", SMALL_STUDY.format(seed=1))
        self.run_capstan("study", "run", "small.toml", "--db", "small.db")
        self.run_capstan("study", "run", "small.toml", "--db", "large.db")
        connection = sqlite3.connect(self.folder / "large.db")
        connection.execute("WITH RECURSIVE n(k) AS (SELECT 1000 UNION ALL SELECT k + 1 FROM n WHERE k < 1000 + ?) "
                           "INSERT INTO cell_block SELECT (SELECT min(cell_id) FROM cell), k, k / 7.0 FROM n", (ROWS - 1,))
        connection.commit()
        connection.close()
        sizes, grown = {}, {}
        for file_format in ("csv", "json", "parquet"):
            memory = [self.max_memory_KiB("export", name, "--format", file_format, "--tables", "cell_block", "--db", name + ".db")
                      for name in ("small", "large")]
            sizes[file_format] = (self.folder / "large" / f"cell_block.{file_format}").stat().st_size
            grown[file_format] = memory[1] - memory[0]
            # A group of a Parquet file is kept until it is written: 50,000 rows.
            self.assertLess(grown[file_format], 24 * 1024, file_format)
        rows = json.loads((self.folder / "large" / "cell_block.json").read_text())
        self.assertGreaterEqual(len(rows), ROWS)
        self.assertEqual(len((self.folder / "large" / "cell_block.csv").read_text().splitlines()), len(rows) + 1)
        print(f"{len(rows)} rows: " + ", ".join(f"{name} {sizes[name] / 1e6:.0f} MB with {grown[name] / 1024:+.1f} MiB" for name in sizes), flush=True)


if __name__ == "__main__":
    unittest.main()
