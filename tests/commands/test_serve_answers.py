"""Questions that the service answers on a page of their own: the same bits as at the shell, behind the same queue."""

import json
import re
import signal
import unittest

import tension_recording
from capstan_program import CONFIGS, PROGRAM
from capstan_service import ServiceTest
from test_worlds import ARM, CONSTRAINTS

QUICK = (CONFIGS / "quick.toml").read_text()


class ServeAnswers(ServiceTest):
    def answer_of(self, job):
        self.assertEqual(self.await_job(job["job"], "done")["state"], "done")
        status, headers, page = self.ask("GET", f"/jobs/{job['job']}")
        self.assertEqual(status, 200, page)
        self.assertIn("script-src 'self' 'unsafe-eval' 'sha256-", headers["Content-Security-Policy"])
        self.assertIn(b"<!DOCTYPE html>", page)
        return self.ask("GET", f"/api/jobs/{job['job']}/answer")[2].decode()

    def test_are_those_of_the_commands(self):
        self.serve("--configs", CONFIGS)
        self.write("shell.toml", QUICK)
        for command, body, words in (
            ("place", {"config": "quick.toml"}, ()),
            ("place", {"config_toml": QUICK, "noise": "5 %"}, ("--noise", "5 %")),
            ("sensitivity", {"config_toml": QUICK, "sensors": 1}, ("--sensors", 1)),
            ("estimate", {"config_toml": QUICK}, ()),
            ("place", {"config_toml": ARM}, ()),
            ("place", {"config_toml": ARM + CONSTRAINTS}, ()),
            ("sensitivity", {"config_toml": ARM + CONSTRAINTS}, ()),
        ):
            job = self.post("/api/answers", {"command": command, **body}, expect=202)[0]
            toml = body.get("config_toml", QUICK)
            self.assertEqual((job["kind"], job["title"]), (command, "quick" if toml == QUICK else "arm"))
            self.write("shell.toml", toml)
            expected = self.run_capstan(command, "shell.toml", *words, "--json", "--progress", "none").stdout
            self.assertEqual(self.answer_of(job), expected, command)
        self.assertEqual(self.get("/api/studies"), [])  # nothing is stored in the database

    def test_one_question_over_worlds_has_one_answer(self):
        """Through study run, recommend, place, the service and its page, with and without constraints."""
        self.serve()
        for number, toml in enumerate((ARM, ARM + CONSTRAINTS), 1):
            self.write("arm.toml", toml)
            ran = json.loads(self.run_capstan("study", "run", "arm.toml", "--db", f"{number}.db", "--json").stdout)
            job = self.post("/api/studies", {"config_toml": toml}, expect=202)[0]
            self.assertEqual(self.await_job(job["job"], "done")["state"], "done")
            for answer in (json.loads(self.run_capstan("recommend", "--db", f"{number}.db", "--json").stdout),
                           json.loads(self.run_capstan("place", "arm.toml", "--json").stdout),
                           self.get(f"/api/studies/{number}/recommendation")):
                for key in ("recommendations", "prices", "robustness"):
                    self.assertEqual(answer[key], ran[key], key)
            self.run_capstan("report", "--db", f"{number}.db", "-o", "report.html")
            page = self.ask("GET", f"/studies/{number}")[2].decode()
            self.assertEqual(self.drawn(page), self.drawn((self.folder / "report.html").read_text()))
            self.assertIn(f"<p>{ran['recommendations'][0]['sentence']}", page)
            self.assertIn(f"use {ran['recommendations'][0]['set']}: expected error "
                          f"{ran['recommendations'][0]['expected_error_N']:.3f} N", page)

    @staticmethod
    def drawn(page):
        """The numbers behind the figures of a page."""
        tables = json.loads(re.search(r'id="study-data">(.*?)</script>', page)[1])["tables"]
        return {name: tables[name] for name in ("world_front", "world_place")}

    def test_of_a_recording(self):
        self.serve()
        tension_recording.make(PROGRAM, self.folder)
        files = {"log": ("b.csv", (self.folder / "b.csv").read_bytes()), "sidecar": ("b.json", (self.folder / "b.json").read_bytes())}
        for more, words in (({}, ()), ({"leave_out": ("x", b"each")}, ("--leave-out", "each"))):
            cost = self.upload(files | more, path="/api/estimates/cost", expect=200)
            self.assertTrue(cost["known"] and cost["seconds"] > 0, cost)
            job = self.upload(files | more, path="/api/estimates")
            expected = self.run_capstan("estimate", "b.csv", *words, "--json", "--progress", "none").stdout
            self.assertEqual(self.answer_of(job), expected)
        self.upload(files | {"leave_out": ("x", b"--db")}, path="/api/estimates", expect=400)
        self.upload({"log": files["log"]}, path="/api/estimates", expect=400)

    def test_what_is_wrong_is_said_before_anything_starts(self):
        self.serve("--configs", CONFIGS)
        for body in ({"command": "magic", "config": "quick.toml"}, {"config": "quick.toml"}, {"command": "place"},
                     {"command": "place", "config_toml": QUICK, "sensors": 2}, {"command": "estimate", "config_toml": QUICK, "noise": "5 %"},
                     {"command": "place", "config_toml": "repetitions = -1"}):
            self.post("/api/answers", body, expect=400)
            self.post("/api/answers/cost", body, expect=400)
        self.post("/api/answers", {"command": "place", "config": "../quick.toml"}, expect=404)
        self.assertEqual(self.get("/api/jobs"), [])
        checked = self.post("/api/configs/check", {"config_toml": 'repetitions = -1\nnoize = 3\n'})
        self.assertEqual(len([each for each in checked["problems"] if "repetitions" in each or "noize" in each]), 2, checked)
        self.assertEqual(self.post("/api/configs/check", {"config": "quick.toml"}), {"problems": [], "studies": 1, "over_worlds": False})
        self.assertGreater(self.post("/api/configs/check", {"config": "atlas.toml"})["studies"], 100)
        job = self.post("/api/studies", {"config": "quick.toml"}, expect=202)[0]
        self.await_job(job["job"], "done")
        self.get(f"/api/jobs/{job['job']}/answer", expect=404)
        self.get("/api/jobs/99/answer", expect=404)

    def test_costs_are_told_of_worlds_too(self):
        self.serve("--configs", CONFIGS)
        worlds = self.post("/api/studies/cost", {"config": "wrist-exosuit.toml"})
        self.assertTrue(worlds["known"] and worlds["seconds"] > 0, worlds)
        place = self.post("/api/answers/cost", {"command": "place", "config": "quick.toml"})
        self.assertTrue(place["known"] and 0 < place["seconds"] < 600, place)

    def test_cost_of_a_diagnosis_is_that_of_the_command(self):
        self.serve("--configs", CONFIGS)
        files = {part: (name, (CONFIGS / "recordings" / name).read_bytes()) for part, name in (("log", "viscous-pair.csv"), ("sidecar", "viscous-pair.json"))}
        cost = self.upload(files, path="/api/diagnoses/cost", expect=200)
        self.assertTrue(cost["known"] and 0 < cost["min_seconds"] < cost["seconds"], cost)
        self.upload({"log": files["log"]}, path="/api/diagnoses/cost", expect=400)
        unreadable = self.upload(files | {"sidecar": ("viscous-pair.json", b"{}")}, path="/api/diagnoses/cost", expect=200)
        self.assertFalse(unreadable["known"])
        self.assertRegex(unreadable["problems"], "^viscous-pair.json: .*")  # no folder of the service
        self.assertEqual((self.get("/api/jobs"), self.get("/api/diagnoses")), ([], []))
        told = json.loads(self.run_capstan("diagnose", CONFIGS / "recordings" / "viscous-pair.csv", "--cost", "--json").stdout)
        self.assertEqual((told["runs"], told["samples"]), (2, 1602))
        words = self.run_capstan("diagnose", CONFIGS / "recordings" / "viscous-pair.csv", "--cost").stdout
        self.assertRegex(words, "a diagnosis takes about .* to .* on this machine")

    def test_killed_and_started_again(self):
        toml = QUICK.replace("repetitions = ", "repetitions = 1")
        process = self.serve()
        job = self.post("/api/answers", {"command": "sensitivity", "config_toml": toml}, expect=202)[0]
        self.await_job(job["job"], "running", "done")
        process.send_signal(signal.SIGKILL)
        process.communicate()
        self.serve()
        self.write("shell.toml", toml)
        expected = self.run_capstan("sensitivity", "shell.toml", "--json", "--progress", "none").stdout
        self.assertEqual(json.loads(self.answer_of(job)), json.loads(expected))


if __name__ == "__main__":
    unittest.main()
