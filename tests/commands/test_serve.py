"""The service: studies and diagnoses through REST end as those of the shell do, whatever happens on the way."""

import json
import signal
import sqlite3
import threading
import time
import unittest

from capstan_program import CONFIGS
from capstan_service import ServiceTest

QUICK = (CONFIGS / "quick.toml").read_text()
LONG = (CONFIGS / "noise-instants.toml").read_text()  # dozens of units: long enough to be stopped and killed


def with_repetitions(toml, repetitions):
    return "\n".join(f"repetitions = {repetitions}" if line.startswith("repetitions") else line
                     for line in toml.splitlines()) + "\n"


class Serve(ServiceTest):
    def at_the_shell(self, toml):
        self.run_capstan("study", "run", self.write("shell.toml", toml), "--db", "shell.db")
        return self.tables("shell.db")

    def start(self, toml):
        started = self.post("/api/studies", {"config_toml": toml}, expect=202)
        self.assertEqual(len(started), 1)
        return started[0]["job"]

    def test_a_study_of_the_service_is_that_of_the_shell(self):
        self.serve("--configs", CONFIGS)
        self.assertIn("quick.toml", self.get("/api/configs"))
        job = self.post("/api/studies", {"config": "quick.toml"}, expect=202)[0]
        self.assertEqual((job["kind"], job["title"]), ("study", "quick"))
        self.assertEqual(self.await_job(job["job"], "done")["study_id"], 1)
        self.assert_same_bits(self.at_the_shell(QUICK), self.tables("served.db"))
        units = self.get("/api/studies/1/units")
        self.assertTrue(units and all(unit["done"] == 1 for unit in units))
        self.post(f"/api/jobs/{job['job']}/stop", expect=409)
        self.post("/api/studies/1/resume", expect=409)

    def test_answers_are_those_of_the_commands(self):
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "served.db")
        self.serve()
        for path, words in (("/api/studies", ("study", "list")), ("/api/studies/1", ("study", "show", 1)),
                            ("/api/studies/1/recommendation", ("recommend", 1)), ("/api/studies/1/report", ("report", 1))):
            expected = self.run_capstan(*words, "--json", "--db", "served.db").stdout
            self.assertEqual(self.ask("GET", path)[2].decode(), expected, path)
        sql = "SELECT * FROM v_best_method"
        for answer_format in ("json", "csv"):
            body = json.dumps({"sql": sql, "format": answer_format}).encode()
            status, headers, text = self.ask("POST", "/api/query", body, {"Content-Type": "application/json"})
            expected = self.run_capstan("query", sql, "--format", answer_format, "--db", "served.db").stdout
            self.assertEqual((status, text.decode().splitlines()), (200, expected.splitlines()), headers)
        self.assertEqual(self.ask("GET", "/api/schema")[2].decode(), self.run_capstan("query", "--schema").stdout)

    def test_sensors_by_hand_get_the_errors_of_the_study(self):
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "served.db")
        self.serve()
        cells = self.post("/api/query", {"sql": "SELECT ss.nodes, c.method, avg(c.mean_abs_error_N) AS error_N FROM cell c "
                                                "JOIN sensor_set ss USING (sensor_set_id) JOIN scenario s USING (scenario_id) "
                                                "WHERE s.regime = 'mass' GROUP BY ss.nodes, c.method"})
        self.assertGreater(len(cells), 20)
        for cell in cells:
            question = {"nodes": json.loads(cell["nodes"]), "method": cell["method"], "regime": "mass", "noise": 1}
            score = self.post("/api/studies/1/layout", question)
            self.assertAlmostEqual(score["mean_abs_error_N"], cell["error_N"], places=12, msg=cell)
            self.assertEqual(len(score["nodes"]), 7)
        moved = {"nodes": [2, 5], "method": "posterior_mean", "regime": "mass", "noise": 1}  # no layout of the study
        self.assertGreater(self.post("/api/studies/1/layout", moved)["mean_abs_error_N"], 0)
        one_regime = self.post("/api/studies/1/layout", moved)
        duty = self.post("/api/studies/1/layout", {**moved, "regime": "duty_cycle", "reference": {"nodes": [5, 2], "method": "posterior_mean"}})
        self.assertAlmostEqual(duty["mean_abs_error_N"], one_regime["mean_abs_error_N"], places=12)  # the study has one regime
        self.assertEqual((duty["worse_than_reference_N"], duty["reference"]["nodes"]), (0, duty["nodes"]))
        for node in one_regime["nodes"]:
            self.assertTrue(0 <= node["low_N"] < node["high_N"], node)
        worse = self.post("/api/studies/1/layout", {**moved, "method": "mean", "reference": {"nodes": [2, 5], "method": "posterior_mean"}})
        self.assertGreater(worse["worse_interval_N"][1], worse["worse_interval_N"][0])
        self.assertAlmostEqual(worse["worse_than_reference_N"], worse["mean_abs_error_N"] - one_regime["mean_abs_error_N"], places=12)
        self.post("/api/studies/1/layout", {**moved, "reference": {"nodes": [9], "method": "mean"}}, expect=400)
        self.post("/api/studies/1/layout", {**moved, "reference": 3}, expect=400)
        for wrong in ({"nodes": []}, {"nodes": [0]}, {"nodes": [8]}, {"nodes": [3, 3]}, {"method": "magic"},
                      {"regime": "partial_both"}, {"noise": 2}, {"nodes": "all"}):
            self.post("/api/studies/1/layout", {**moved, **wrong}, expect=400)

    def test_sensors_by_hand_of_a_study_over_worlds_get_its_errors(self):
        self.run_capstan("study", "run", CONFIGS / "wrist-exosuit.toml", "--repetitions", "20", "--db", "served.db")
        before = self.tables("served.db")
        self.serve()
        offered = self.get("/api/studies/1/sensors")
        advice = self.get("/api/studies/1/recommendation")["recommendations"][0]
        chosen = [offered["sensors"][sensor - 1] for sensor in offered["recommended"]]
        self.assertEqual([(each["kind"], each["place_m"]) for each in chosen],
                         [(each["kind"], each["place_m"]) for each in advice["sensors"]])
        placed = self.post("/api/studies/1/sensors", {"sensors": offered["recommended"][::-1]})
        for key in ("expected_error_N", "monte_carlo_interval_N", "error_95_N", "set"):
            self.assertEqual(placed[key], advice[key], key)
        self.assertFalse(placed["distinguishable"])
        poor = self.post("/api/studies/1/sensors", {"sensors": [1]})
        self.assertGreater(poor["worse_than_recommended_N"], 0)
        for sensors in ([], [1, 1], [0], [999], "1"):
            self.post("/api/studies/1/sensors", {"sensors": sensors}, expect=400)
        self.post("/api/studies/1/layout", {"nodes": [1], "method": "mean", "regime": "mass", "noise": 1}, expect=400)
        self.assert_same_bits(before, self.tables("served.db"))

    def test_a_kept_script_is_asked_about_and_sent_once(self):
        self.serve()
        status, headers, script = self.ask("GET", "/web/service.js")
        self.assertEqual((status, headers["Cache-Control"]), (200, "no-cache"))
        status, again, body = self.ask("GET", "/web/service.js", headers={"If-None-Match": headers["ETag"]})
        self.assertEqual((status, again["ETag"], body), (304, headers["ETag"], b""))
        status, _, other = self.ask("GET", "/web/service.js", headers={"If-None-Match": 'W/"of another program"'})
        self.assertEqual((status, other), (200, script))

    def test_stopped_and_resumed(self):
        toml = with_repetitions(LONG, 300)
        expected = self.at_the_shell(toml)
        self.serve()
        job = self.start(toml)
        waiting = self.start(QUICK)
        self.await_units(1, 2)
        self.post(f"/api/jobs/{waiting}/stop", expect=202)
        self.post(f"/api/jobs/{job}/stop", expect=202)
        self.await_job(job, "stopped")
        self.assertEqual(self.get("/api/studies")[0]["status"], "running")
        self.get("/api/studies/1/recommendation", expect=409)
        self.assertEqual(self.get(f"/api/jobs/{waiting}")["state"], "stopped")
        self.assertTrue(self.post(f"/api/jobs/{waiting}/cost")["seconds"] > 0)  # it would begin anew
        self.assertEqual(self.post(f"/api/jobs/{job}/cost"), {"known": False})  # it goes on
        self.post("/api/studies/1/resume", expect=202)
        self.assertEqual(self.await_job(job, "done")["study_id"], 1)
        self.assert_same_bits(expected, self.tables("served.db"))

    def test_killed_and_started_again(self):
        toml = with_repetitions(LONG, 300)
        expected = self.at_the_shell(toml)
        for units in (0, 3, 20):
            db = f"killed{units}.db"
            process = self.serve(db=db)
            job = self.start(toml)
            if units:
                self.await_units(1, units)
            process.send_signal(signal.SIGKILL)
            process.communicate()
            again = self.serve(db=db)
            self.assertEqual(self.await_job(job, "done")["study_id"], 1)
            self.assertEqual(len(self.get("/api/jobs")), 1)
            self.assert_same_bits(expected, self.tables(db))
            again.send_signal(signal.SIGTERM)
            self.assertEqual(again.wait(timeout=60), 0)

    def test_ended_politely_it_goes_on_at_the_next_start(self):
        toml = with_repetitions(LONG, 300)
        process = self.serve()
        job = self.start(toml)
        self.await_units(1, 2)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=60), 0)
        self.serve()
        self.await_job(job, "done")
        self.assert_same_bits(self.at_the_shell(toml), self.tables("served.db"))

    def test_ends_when_asked_as_soon_as_it_says_that_it_serves(self):
        for _ in range(5):
            process = self.serve()
            process.send_signal(signal.SIGTERM)
            _, error = process.communicate()
            self.assertEqual(process.returncode, 0, error)

    def test_one_service_for_a_database(self):
        self.serve()
        done = self.run_capstan("serve", "--db", "served.db", "--port", 0, expect=1)
        self.assertIn("another `capstan serve` has", done.stderr)
        (self.folder / "link.db").symlink_to("served.db")
        done = self.run_capstan("serve", "--db", "link.db", "--port", 0, expect=1)
        self.assertIn("another `capstan serve` has", done.stderr)
        done = self.run_capstan("serve", "--db", "other.db", "--port", self.port, expect=1)
        self.assertIn("Try another --port", done.stderr)

    def test_a_recording_is_diagnosed_as_at_the_shell(self):
        self.run_capstan("gap-trial", "--cases", 1, "--seed", 4, "--length", "short", "--severity", "strong",
                         "--keep", "kept", "--generate-only", "--progress", "none")
        log, sidecar = (self.folder / "kept" / f"case001.{end}" for end in ("csv", "json"))
        self.serve()
        job = self.upload({"log": ("../../case001.csv", log.read_bytes()), "sidecar": ("x.json", sidecar.read_bytes())})
        self.assertEqual((job["kind"], job["title"]), ("diagnosis", "case001.csv"))
        number = self.await_job(job["job"], "done")["diagnosis_id"]
        told = self.get(f"/api/diagnoses/{number}")
        shell = json.loads(self.run_capstan("diagnose", log, "--json", "--progress", "none", "--db", "shell.db").stdout)
        self.assertEqual(told, shell)
        stored = self.get("/api/diagnoses")[0]
        self.assertEqual(stored["recording"], shell["case"])
        self.assertIn(shell["ranked"][0]["effect"], stored["verdict"])
        self.assertAlmostEqual(stored["confidence_fraction"], shell["ranked"][0]["probability"], places=12)
        rows = []
        for db in ("served.db", "shell.db"):
            connection = sqlite3.connect(self.folder / db)
            self.addCleanup(connection.close)
            rows.append([connection.execute(f"SELECT * FROM {table}").fetchall() for table in
                         ("diagnosis_effect", "diagnosis_number", "diagnosis_candidate", "diagnosis_channel", "diagnosis_gap")])
            self.assertEqual(len(connection.execute("SELECT log_sha256 FROM diagnosis").fetchone()[0]), 64)
        self.assertEqual(*rows)

    def test_many_at_once_while_a_study_runs(self):
        """No error and the study's bits unchanged; how long it takes is told, not judged."""
        toml = with_repetitions(LONG, 300)
        expected = self.at_the_shell(toml)
        self.serve()
        job = self.start(toml)
        self.await_units(1, 1)
        times_s, problems = [], []
        query = json.dumps({"sql": "SELECT * FROM v_best_method"}).encode()

        def client(number):
            for turn in range(6):
                begin = time.monotonic()
                if (number + turn) % 2:
                    status, _, text = self.ask("POST", "/api/query", query, {"Content-Type": "application/json"})
                else:
                    status, _, text = self.ask("GET", "/api/studies/1/report")
                times_s.append(time.monotonic() - begin)
                if status != 200:
                    problems.append((status, text))

        clients = [threading.Thread(target=client, args=(number,)) for number in range(50)]
        for each in clients:
            each.start()
        for each in clients:
            each.join()
        self.assertEqual(problems, [])
        self.assertEqual(len(times_s), 300)
        times_s.sort()
        print(f"50 clients, {len(times_s)} requests: median {1e3 * times_s[150]:.0f} ms, p99 {1e3 * times_s[296]:.0f} ms")
        self.await_job(job, "done")
        self.assert_same_bits(expected, self.tables("served.db"))


if __name__ == "__main__":
    unittest.main()
