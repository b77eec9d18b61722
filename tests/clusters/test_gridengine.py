"""A study on Debian's Grid Engine with four nodes, one of which dies in the middle."""

import json
import os
import subprocess
import unittest

from capstan_program import CONFIGS, PROGRAM, CapstanTest
from gridengine import GridEngine, why_not

STUDY = (CONFIGS / "noise-instants.toml", "--repetitions", "20")  # 28 parts
SHARDS = 28


@unittest.skipIf(why_not(), why_not())
class OnGridEngine(CapstanTest):
    def setUp(self):
        super().setUp()
        self.cluster = GridEngine(self.folder / "cluster")
        self.addCleanup(self.cluster.stop)
        # Syncs take a while, so that a node can die beside its work.
        (self.folder / "cluster/root/default/common/sge_request").write_text(
            f"-v LD_PRELOAD={os.environ['CAPSTAN_SLOW_DISK']},CAPSTAN_SYNC_S=0.2\n")

    def capstan(self, *words):
        done = subprocess.run(self.cluster.on("head", PROGRAM, *words), cwd=self.folder, env=self.cluster.environment,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def states(self):
        return [shard["state"] for shard in json.loads(self.capstan("study", "status", "study", "--json"))["shards"]]

    def records(self):
        return [json.loads(path.read_text()) for path in (self.folder / "study/leases").glob("shard-*.done")]

    def test_a_node_dies_in_the_middle(self):
        self.run_capstan("study", "run", *STUDY, "--db", "complete.db")
        submit = ("study", "submit", *STUDY, "--scheduler", "gridengine", "--shards", SHARDS, "--array-limit", 10, "--throttle", 4,
                  "--directory", "study")
        self.assertIn("Submitted shards 1-28 of 28", self.capstan(*submit))
        self.assertNotIn("Submitted", self.capstan(*submit))
        held = lambda: [path for path in (self.folder / "study/leases").glob("shard-*.lease") if "node2" in path.read_text()]
        self.cluster.wait("some shards", lambda: len(self.records()) >= 6 and held())
        self.cluster.kill("node2")
        self.cluster.wait("the merged study", lambda: (self.folder / "study/study.db").exists())
        self.assertEqual(self.states(), ["done"] * SHARDS)
        workers = {record["worker"].split("-")[0] for record in self.records()}
        print(f"{SHARDS} shards on {', '.join(sorted(workers))}")
        self.assertEqual(workers - set(self.cluster.nodes), set())
        self.assertGreater(len(workers), 2)
        self.assert_same_bits(self.tables("complete.db"), self.tables("study/study.db"))


if __name__ == "__main__":
    unittest.main()
