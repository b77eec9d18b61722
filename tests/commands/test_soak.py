"""A service under small studies and questions for a while: neither its memory nor its handles grow, nor do its answers slow.

CAPSTAN_SOAK_SECONDS says for how long (20), CAPSTAN_SOAK_SHARE how much of a processor it may take (1: as it comes). Before,
each of the service's threads is to get every kind of question: their own caches do not count as growth.
What is judged is the service's own memory, handles and processor time; times on the clock are told."""

import json
import os
import pathlib
import statistics
import time
import unittest

from capstan_service import ServiceTest
from small_study import SMALL_STUDY

SECONDS = float(os.environ.get("CAPSTAN_SOAK_SECONDS", "20"))
SHARE = float(os.environ.get("CAPSTAN_SOAK_SHARE", "1"))
TICKS_PER_S = os.sysconf("SC_CLK_TCK")
WARM_UP_ROUNDS = 1000 if SECONDS > 60 else 60  # of eight questions each, to whichever thread takes them
WARM_UP_STUDIES = 33  # one more than the service keeps reports of: each is made again
KEPT_STUDIES = 12  # so that the database, and with it the work that a question asks for, does not grow

STUDY = (SMALL_STUDY.replace('name = "small"', 'name = "soak {seed}"')
         .replace("samples = [15, 18, 21, 39, 42, 45]", "samples = [15, 45]")
         .replace('[[noise]]\nlabel = "0.2 N"\nadditive_N = 0.2\n\n', ""))


def quarters(values):
    """The first and the last quarter of what was measured after the warm-up."""
    length = max(1, len(values) // 4)
    return values[:length], values[-length:]


def slope_per_hour(times_s, values):
    """Theil and Sen's: the median slope of pairs half the run apart, which a few odd values do not move."""
    half = len(values) // 2
    slopes = [(values[k + half] - values[k]) / (times_s[k + half] - times_s[k]) for k in range(len(values) - half)]
    return 3600 * statistics.median(slopes)


class Soak(ServiceTest):
    def of_process(self, name):
        for line in (self.proc / "status").read_text().splitlines():
            if line.startswith(name + ":"):
                return int(line.split()[1])
        self.fail(name)

    def processor_s(self):
        """Of the service itself; its studies are processes of their own."""
        fields = (self.proc / "stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / TICKS_PER_S

    def open_handles(self):
        """A connection whose client has just gone is open for a moment."""
        counts = []
        for _ in range(4):
            counts.append(len(list((self.proc / "fd").iterdir())))
            time.sleep(0.02)
        return min(counts)

    def timed(self, method, path, value=None):
        body = None if value is None else json.dumps(value).encode()
        begin = time.monotonic()
        status, _, text = self.ask(method, path, body, {"Content-Type": "application/json"} if body else None)
        self.latencies_s.append(time.monotonic() - begin)
        self.assertEqual(status, 200, text)
        return text

    def ask_about(self, study_id, remark=""):
        """The same questions about another study each time, or with another remark: nothing is answered from what was kept."""
        for view in ("v_error_by_layout", "v_best_method", "v_recommendation"):
            sql = f"SELECT * FROM {view} WHERE study_id = {study_id} -- {remark}"
            self.assertGreater(len(json.loads(self.timed("POST", "/api/query", {"sql": sql}))), 0)
        self.timed("GET", f"/api/studies/{study_id}/report")
        self.timed("GET", f"/studies/{study_id}")
        self.timed("GET", f"/api/studies/{study_id}/recommendation")
        self.timed("POST", f"/api/studies/{study_id}/layout",
                   {"nodes": [2, 5], "method": "posterior_mean", "regime": "mass", "noise": 1})
        self.timed("GET", "/api/studies")

    def one_round(self, number):
        toml = STUDY.format(seed=number)
        job = self.post("/api/studies", {"config_toml": toml}, expect=202)[0]["job"]
        study_id = self.await_job(job, "done")["study_id"]
        before = self.processor_s()
        self.ask_about(study_id)
        self.work_s.append(self.processor_s() - before)
        if number % KEPT_STUDIES == 0:
            for study in self.get("/api/studies")[:-1]:
                self.run_capstan("study", "delete", study["study_id"], "--db", "served.db")

    def test_neither_grows_nor_slows(self):
        process = self.serve("--jobs", 1)
        self.proc = pathlib.Path(f"/proc/{process.pid}")
        self.latencies_s = []
        self.work_s = []
        for k in range(WARM_UP_STUDIES):
            self.run_capstan("study", "run", self.write("soak.toml", STUDY.format(seed=1000 + k)), "--db", "served.db")
        for k in range(WARM_UP_ROUNDS):
            self.ask_about(1 + k % WARM_UP_STUDIES, k)
        warm_KiB = self.of_process("VmRSS")
        self.work_s.clear()
        times_s, memory_KiB, handles, threads, latency_s = [], [], [], [], []
        begin = time.monotonic()
        number = 0
        while time.monotonic() - begin < SECONDS or number < 8:
            number += 1
            before = time.monotonic()
            self.latencies_s.clear()
            self.one_round(number)
            took_s = time.monotonic() - before
            times_s.append(before - begin)
            latency_s.append(statistics.median(self.latencies_s))
            memory_KiB.append(self.of_process("VmRSS"))
            threads.append(self.of_process("Threads"))
            handles.append(self.open_handles())
            time.sleep(took_s * (1 / SHARE - 1))

        # The first of the kept studies, too, are no growth.
        warm = number // 4
        first_work, last_work = (statistics.mean(part) for part in quarters(self.work_s[warm:]))
        first_s, last_s = (statistics.median(part) for part in quarters(latency_s[warm:]))
        first_KiB, last_KiB = (statistics.median(part) for part in quarters(memory_KiB[warm:]))
        slope_KiB = slope_per_hour(times_s[warm:], memory_KiB[warm:])
        print(f"{number} studies and {8 * number} questions in {time.monotonic() - begin:.0f} s: memory {warm_KiB / 1024:.1f} MiB "
              f"after {8 * WARM_UP_ROUNDS} questions, {first_KiB / 1024:.1f} MiB in the first quarter, {last_KiB / 1024:.1f} MiB in the last (slope {slope_KiB / 1024:+.2f} MiB/h, most "
              f"{max(memory_KiB) / 1024:.1f} MiB); handles {min(handles)} to {max(handles)}, at the end {handles[-1]}; "
              f"median answer {1e3 * first_s:.1f} ms, then {1e3 * last_s:.1f} ms; processor time of eight "
              f"{1e3 * first_work:.1f} ms, then {1e3 * last_work:.1f} ms", flush=True)
        first_handles, last_handles = quarters(handles[warm:])
        self.assertLessEqual(statistics.median(last_handles), statistics.median(first_handles))
        self.assertLessEqual(max(threads[warm:]), threads[warm] + 2)
        self.assertLess(last_KiB, 1.1 * first_KiB + 8 * 1024)
        self.assertLess(last_work, 1.5 * first_work + 0.02)


if __name__ == "__main__":
    unittest.main()
