"""Two programs run studies into one database while ten read it: nobody hears of a lock, and no row is lost."""

import json
import os
import sqlite3
import threading
import unittest

from capstan_program import CapstanTest
from small_study import SMALL_STUDY, UNITS, integrity

STUDIES = int(os.environ.get("CAPSTAN_CONCURRENT_STUDIES", "3"))  # of each of the two writers

QUESTIONS = (
    ("study", "list", "--json"),
    ("query", "SELECT * FROM v_error_by_layout", "--format", "json"),
    ("query", "SELECT count(*) FROM cell c JOIN cell_node USING (cell_id)", "--format", "csv"),
    ("query", "SELECT * FROM v_progress", "--format", "json"),
    ("report", "--json"),
)

# What a study measured, without the numbers that depend on which study of the file it is.
ERRORS = """SELECT t.seed, s.scenario_index, n.noise_index, ss.set_index, c.method, c.mean_abs_error_N, c.standard_error_N,
                   c.error_q50_N, (SELECT sum(mean_abs_error_N) FROM cell_node e WHERE e.cell_id = c.cell_id),
                   (SELECT sum(mean_abs_error_N) FROM cell_block b WHERE b.cell_id = c.cell_id)
            FROM cell c JOIN scenario s USING (scenario_id) JOIN study t USING (study_id) JOIN noise_level n USING (noise_level_id)
            JOIN sensor_set ss USING (sensor_set_id) ORDER BY 1, 2, 3, 4, 5"""


class Concurrency(CapstanTest):
    def errors(self, name):
        connection = sqlite3.connect(self.folder / name)
        self.addCleanup(connection.close)
        return connection.execute(ERRORS).fetchall()

    def test_two_write_and_ten_read(self):
        seeds = range(1, 2 * STUDIES + 1)
        for seed in seeds:
            self.write(f"{seed}.toml", SMALL_STUDY.format(seed=seed))
            self.run_capstan("study", "run", f"{seed}.toml", "--db", "alone.db")
        self.run_capstan("study", "run", "1.toml", "--db", "shared.db")  # there is something to read from the beginning
        heard, answers = [], []
        done = threading.Event()

        def collect(words, process):
            answer, messages = process.communicate()
            if process.returncode != 0 or "lock" in messages.lower() or "busy" in messages.lower():
                heard.append((words, process.returncode, messages))
            return answer

        def write(mine):
            for seed in mine:
                words = ("study", "run", f"{seed}.toml", "--db", "shared.db", "--jobs", 1)
                collect(words, self.start_capstan(*words))

        def read(number):
            turn = number
            while not done.is_set() or turn == number:
                words = (*QUESTIONS[turn % len(QUESTIONS)], "--db", "shared.db")
                answers.append(len(collect(words, self.start_capstan(*words))))
                turn += 1

        writers = [threading.Thread(target=write, args=(seeds[first::2],)) for first in range(2)]
        readers = [threading.Thread(target=read, args=(number,)) for number in range(10)]
        for each in writers + readers:
            each.start()
        for each in writers:
            each.join()
        done.set()
        for each in readers:
            each.join()
        self.assertEqual(heard, [])
        self.assertGreaterEqual(len(answers), 10)
        self.assertNotIn(0, answers)
        self.assertEqual(integrity(self.folder / "shared.db"), ["ok"])
        studies = json.loads(self.run_capstan("study", "list", "--json", "--db", "shared.db").stdout)
        self.assertEqual([(study["status"], study["units_done"]) for study in studies], [("complete", UNITS)] * (len(seeds) + 1))
        print(f"two writers, {len(studies)} studies; ten readers, {len(answers)} answers; no lock was heard of", flush=True)

        alone = self.errors("alone.db")
        shared = self.errors("shared.db")
        twice = [row for row in shared if row[0] == 1]
        self.assertEqual(twice[::2], twice[1::2])
        self.assertEqual(twice[::2] + [row for row in shared if row[0] != 1], alone)


if __name__ == "__main__":
    unittest.main()
