"""A database of very many cells answers what its views are asked with the work that a small one needs.

CAPSTAN_SCALE_CELLS says how many cells (300,000). One study is run and its rows are copied under other numbers; per-node and
per-block rows, twenty times as many again, which no view reads, are left out. What is judged is the work, in SQLite's own
steps; times are told."""

import os
import shutil
import sqlite3
import time
import unittest

from capstan_program import CONFIGS, CapstanTest

CELLS = int(os.environ.get("CAPSTAN_SCALE_CELLS", "300000"))
MANY_LAYOUTS = CONFIGS.parent / "tests" / "browser" / "many_layouts.toml"  # 102,200 cells
LEFT_OUT = ("cell_node", "cell_block", "shard")
VIEWS = ("v_error_by_layout", "v_best_method", "v_single_sensor_matrix", "v_recommendation", "v_progress")
# The rows that the service's query box gives of an answer at most.
FIRST_ROWS = 100_000
# Of SQLite's machine, for a row that is kept or answered: a loop through it and its names.
STEPS_OF_A_ROW = 100
# What is asked over all studies.
OF_ALL = {
    **{view: f"SELECT * FROM {view} LIMIT {FIRST_ROWS}" for view in VIEWS},
    "v_diagnosis": "SELECT * FROM v_diagnosis",
    "v_best_method, to its end": "SELECT * FROM v_best_method",
    "the ten best": "SELECT * FROM v_best_method ORDER BY mean_abs_error_N LIMIT 10",
    "one layout of all studies": "SELECT study, family, sensor_count, method_title, mean_abs_error_N FROM v_error_by_layout "
                                 "WHERE regime = 'mass' AND sensor_count = 3 AND method = 'posterior_mean' "
                                 "ORDER BY mean_abs_error_N LIMIT 10",
}


class Scale(CapstanTest):
    def multiply(self, name, copies):
        """The rows of the one study, under the numbers of others."""
        connection = sqlite3.connect(self.folder / name, isolation_level=None)
        for pragma in ("journal_mode = OFF", "synchronous = OFF", "foreign_keys = OFF", "cache_size = -200000"):
            connection.execute("PRAGMA " + pragma)
        tables = [row[0] for row in connection.execute("SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite%'")]
        shift = {"study_id": 1, "cell_id": 10 ** 9, "recommendation_id": 10 ** 9, "event_id": 10 ** 6}
        for table in ("scenario", "noise_level", "sensor_set", "layout"):
            shift[table + "_id"] = connection.execute(f"SELECT max({table}_id) FROM {table}").fetchone()[0]
        for table in LEFT_OUT:
            connection.execute(f"DELETE FROM {table}")
        for table in tables:
            if table in LEFT_OUT or table.startswith("diagnosis"):
                continue
            columns = [row[1] for row in connection.execute(f"PRAGMA table_info({table})")]
            connection.execute(f"CREATE TEMP TABLE one AS SELECT * FROM {table}")
            connection.execute("BEGIN")
            for k in range(1, copies):
                moved = ", ".join(f"{column} + {k * shift[column]}" if column in shift else column for column in columns)
                connection.execute(f"INSERT INTO {table} SELECT {moved} FROM one")
            connection.execute("COMMIT")
            connection.execute("DROP TABLE temp.one")
        connection.close()

    def answer(self, name, sql):
        """The rows without numbers of studies and levels, and the work for them in thousands of SQLite's steps."""
        connection = sqlite3.connect(f"file:{self.folder / name}?mode=ro", uri=True)
        steps = [0]

        def count():
            steps[0] += 1

        connection.set_progress_handler(count, 1000)
        cursor = connection.execute(sql)
        kept = [k for k, column in enumerate(cursor.description) if not column[0].endswith("_id")]
        rows = [tuple(row[k] for k in kept) for row in cursor]
        connection.close()
        return rows, steps[0]

    def kept(self, name):
        return self.answer(name, "SELECT count(*) FROM layout_error")[0][0][0]

    def timed(self, name, sql):
        """Of the command, from its start to its last row: on the clock, and of a processor."""
        times_s = []
        for _ in range(3):
            begin, begin_children = time.monotonic(), os.times()
            self.run_capstan("query", sql, "--format", "csv", "--db", name)
            children = os.times()
            times_s.append((time.monotonic() - begin, children.children_user + children.children_system
                            - begin_children.children_user - begin_children.children_system))
        clock_s, processor_s = map(min, zip(*times_s))
        return f"{1e3 * clock_s:.0f} ms ({1e3 * processor_s:.0f} ms of a processor)"

    def test_questions_about_a_study_do_not_go_through_the_others(self):
        large = CELLS >= 5_000_000
        self.run_capstan("study", "run", MANY_LAYOUTS if large else CONFIGS / "noise-instants.toml", "--repetitions", 4, "--db", "one.db",
                         "--progress", "none")
        connection = sqlite3.connect(self.folder / "one.db")
        cells = connection.execute("SELECT count(*) FROM cell").fetchone()[0]
        connection.execute("PRAGMA journal_mode = DELETE")
        connection.close()
        copies = -(-CELLS // cells)
        shutil.copy(self.folder / "one.db", self.folder / "many.db")
        self.multiply("many.db", copies)
        print(f"{copies * cells} cells in {copies} studies, {(self.folder / 'many.db').stat().st_size / 1e9:.2f} GB", flush=True)
        middle = copies // 2
        for view in VIEWS:
            sql = f"SELECT * FROM {view} WHERE study_id = {{}}"
            expected, work_of_one = self.answer("one.db", sql.format(1))
            rows, work = self.answer("many.db", sql.format(middle))
            self.assertGreater(len(rows), 0, view)
            self.assertEqual(sorted(rows, key=repr), sorted(expected, key=repr), view)
            self.assertLessEqual(work, 2 * work_of_one + 20, view)
            print(f"  {view} of a study: {len(rows)} rows, {self.timed('many.db', sql.format(middle))}; {work} thousand steps, "
                  f"{work_of_one} where it is alone", flush=True)
        for what, sql in OF_ALL.items():
            rows, work = self.answer("many.db", sql)
            # Never the cells: what is kept of the complete studies, once.
            self.assertLessEqual(1000 * work, STEPS_OF_A_ROW * max(len(rows), self.kept("many.db")), what)
            print(f"  {what}, over all: {len(rows)} rows, {self.timed('many.db', sql)}; {work} thousand steps", flush=True)


if __name__ == "__main__":
    unittest.main()
