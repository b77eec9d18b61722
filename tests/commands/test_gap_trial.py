"""The blind trial end to end: recordings, seal, answers kept and gone on from, scores that can be checked."""

import hashlib
import json
import pathlib
import shutil
import tempfile
import unittest

from capstan_program import CONFIGS, CapstanTest

SMALL = ("--cases", 2, "--seed", 4, "--length", "short", "--severity", "strong")


class GapTrial(CapstanTest):
    @classmethod
    def setUpClass(cls):
        cls.generated = None
        cls.kept = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.kept.cleanup)

    def generate(self):
        """Once; each test has a copy."""
        kept = pathlib.Path(self.kept.name) / "kept"
        if self.generated is None:
            type(self).generated = self.run_capstan("gap-trial", *SMALL, "--keep", kept, "--generate-only", "--json",
                                                    "--progress", "json")
        shutil.copytree(kept, self.folder / "kept")
        told = self.generated
        return json.loads(told.stdout), [json.loads(line) for line in told.stderr.splitlines()]

    def labels(self):
        return json.loads((self.folder / "kept/labels.json").read_text())

    def answer_rightly(self):
        """As one would who had seen the labels."""
        seal = (self.folder / "kept/labels.sha256").read_text().split()[0]
        for name, label in self.labels()["cases"].items():
            truth = label["causes"][0]
            answer = {"case": name, "labels_sha256": seal, "named": [truth["effect"]],
                      "ranked": [{"effect": truth["effect"], "probability": 1.0}],
                      "component": truth["component"], "end": truth["end"] or "",
                      "s_m": truth["s_m"] and sum(truth["s_m"]) / 2,
                      "channels": [{"channel": "load_torque", "rms_before": 1.0, "rms_after": 0.01}]}
            (self.folder / "kept/answers" / f"{name}.json").write_text(json.dumps(answer))

    def test_recordings_and_seal(self):
        told, events = self.generate()
        self.assertEqual(hashlib.sha256((self.folder / "kept/labels.json").read_bytes()).hexdigest(),
                         told["labels_sha256"])
        self.assertEqual([e["event"] for e in events], ["progress", "progress", "sealed"])
        self.assertEqual(len(self.labels()["cases"]), 2)
        sidecar = json.loads((self.folder / "kept/case001.json").read_text())
        self.assertEqual(sidecar["sample_rate_hz"], 200)
        # A recording like any other: the other commands read it.
        parameters = json.loads(self.run_capstan("calibrate", "kept/case001.csv", "--json", "--segments", 20).stdout)
        self.assertIn("dynamic_friction", [p["name"] for p in parameters["parameters"]])

    def test_right_answers_score_full_marks_and_go_on_from_what_is_kept(self):
        self.generate()
        self.answer_rightly()
        words = self.run_capstan("gap-trial", *SMALL, "--keep", "kept").stdout  # nothing left to diagnose
        self.assertIn("100.0 %", words)
        score = json.loads(self.run_capstan("gap-trial", "--unseal", "kept/labels.json", "--json").stdout)
        self.assertEqual(score["groups"][0]["top1"], {"hits": 2, "of": 2, "fraction": 1.0,
                                                      "interval_95": score["groups"][0]["top1"]["interval_95"]})
        self.assertEqual((score["brier"], score["ece"]), (0.0, 0.0))
        self.assertEqual(score["component"]["fraction"], 1.0)
        self.assertEqual(score["unanswered"], [])

    def test_labels_that_were_changed_are_refused(self):
        self.generate()
        self.answer_rightly()
        path = self.folder / "kept/labels.json"
        path.write_text(path.read_text().replace('"strong"', '"mild"'))
        refused = self.run_capstan("gap-trial", "--unseal", "kept/labels.json", expect=2)
        self.assertIn("changed after they were sealed", refused.stderr)
        self.run_capstan("gap-trial", *SMALL, "--keep", "kept", expect=2)

    def test_wrong_use(self):
        self.assertIn("--keep", self.run_capstan("gap-trial", "--generate-only", expect=2).stderr)
        self.assertIn("severity", self.run_capstan("gap-trial", "--severity", "weak", expect=2).stderr)
        for wrong in ("3", "0.5:", "10:0.5", "0.5:10x"):
            self.assertIn("LOW:HIGH", self.run_capstan("gap-trial", "--visibility", wrong, expect=2).stderr)
        self.assertIn("--kind rigs", self.run_capstan("gap-trial", "--only", "three effects", expect=2).stderr)
        self.assertIn("--kind benches", self.run_capstan("gap-trial", "--kind", "rigs", "--only", "wrong parameter",
                                                         expect=2).stderr)
        self.run_capstan("gap-trial", "--unseal", "nowhere/labels.json", expect=2)
        self.generate()
        other = self.run_capstan("gap-trial", "--cases", 3, "--keep", "kept", expect=2)
        self.assertIn("holds a trial with other options", other.stderr)
        nobody = self.run_capstan("gap-trial", "--unseal", "kept/labels.json", expect=2)
        self.assertIn("no answers", nobody.stderr)


class Rigs(CapstanTest):
    def test_recordings_are_read_by_the_other_commands_and_the_labels_tell_nuisances_apart(self):
        self.run_capstan("gap-trial", "--kind", "rigs", "--cases", 5, "--seed", 4, "--keep", "rigs", "--generate-only")
        labels = json.loads((self.folder / "rigs/labels.json").read_text())
        self.assertEqual(labels["kind"], "rigs")
        self.assertEqual(len(labels["cases"]), 5)
        stated = 0
        for name, label in labels["cases"].items():
            sidecar = json.loads((self.folder / f"rigs/{name}.json").read_text())
            conditions = [set(run.get("condition", {})) for run in sidecar["runs"]]
            self.assertEqual(conditions, [set(label.get("conditions", []))] * len(conditions))
            stated += "conditions" in label
            self.assertTrue(label["nuisances"])
            checked = self.run_capstan("recording", "check", f"rigs/{name}").stdout
            self.assertIn("can be used", checked)
            for condition in label.get("conditions", []):
                self.assertIn(condition, checked)
        self.assertEqual(stated, 2)

    def test_a_drive_of_unknown_geometry_is_diagnosed_as_its_equivalent_bench(self):
        self.run_capstan("gap-trial", "--kind", "rigs", "--cases", 1, "--seed", 4, "--keep", "rigs", "--generate-only")
        recordings = CONFIGS / "recordings"
        for ending in (".csv", ".json"):
            shutil.copyfile(recordings / f"lumped-drive{ending}", self.folder / f"rigs/case001{ending}")
        answer = json.loads(self.run_capstan("gap-trial", "--keep", "rigs", "--case", 1).stdout)
        self.assertAlmostEqual(sum(e["probability"] for e in answer["ranked"]), 1.0)
        self.assertTrue(answer["named"])

    def test_a_trial_without_causes(self):
        self.run_capstan("gap-trial", "--kind", "rigs", "--only", "none", "--cases", 2, "--seed", 4, "--keep", "rigs",
                         "--generate-only")
        labels = json.loads((self.folder / "rigs/labels.json").read_text())
        self.assertEqual([label["causes"] for label in labels["cases"].values()], [[], []])


class WholeTrial(CapstanTest):
    def test_one_case_from_end_to_end(self):
        one = ("gap-trial", "--cases", 1, "--seed", 2, "--length", "short", "--severity", "strong", "--keep", "kept")
        score = json.loads(self.run_capstan(*one, "--json").stdout)
        self.assertEqual(score["groups"][0]["top1"]["of"], 1)
        self.assertGreater(score["reliability"][0]["mean_probability"], 0.0)
        answer = self.folder / "kept/answers/case001.json"
        given = answer.stat().st_mtime_ns
        self.assertEqual(json.loads(self.run_capstan(*one, "--json").stdout), score)
        self.assertEqual(answer.stat().st_mtime_ns, given)
        self.assertAlmostEqual(sum(e["probability"] for e in json.loads(answer.read_text())["ranked"]), 1.0)


if __name__ == "__main__":
    unittest.main()
