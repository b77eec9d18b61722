"""A study over ssh on four hosts with servers of OpenSSH: one is ten times slower, one dies in the middle."""

import json
import os
import subprocess
import unittest

from capstan_program import CONFIGS, PROGRAM, CapstanTest
from secure_shell import SecureShell, why_not

STUDY = (CONFIGS / "noise-instants.toml", "--repetitions", "20")  # 28 parts
SHARDS = 28


@unittest.skipIf(why_not(), why_not())
class OverSsh(CapstanTest):
    def test_one_host_is_slow_and_one_dies(self):
        disk = f"SetEnv LD_PRELOAD={os.environ['CAPSTAN_SLOW_DISK']} CAPSTAN_SYNC_S=0.2 CAPSTAN_SLOW_HOST=node1"
        hosts = SecureShell(self.folder / "hosts", more={f"node{number}": disk for number in range(1, 5)})
        self.addCleanup(hosts.stop)
        self.run_capstan("study", "run", *STUDY, "--db", "complete.db")
        submitted = subprocess.run(
            hosts.on("head", PROGRAM, "study", "submit", *STUDY, "--scheduler", "ssh", "--hosts", ",".join(hosts.nodes), "--shards", SHARDS,
                     "--directory", "study"), cwd=self.folder, env=hosts.environment, capture_output=True, text=True)
        self.assertEqual(submitted.returncode, 0, submitted.stderr)
        self.assertEqual(submitted.stdout.count("Started: "), 4, submitted.stdout)
        leases = self.folder / "study/leases"
        records = lambda: [json.loads(path.read_text()) for path in leases.glob("shard-*.done")]
        held = lambda: [path for path in leases.glob("shard-*.lease") if "node2" in path.read_text()]
        hosts.wait("some shards", lambda: len(records()) >= 6 and held())
        hosts.kill("node2")
        hosts.wait("the merged study", lambda: (self.folder / "study/study.db").exists())
        done = {node: sum(record["worker"].startswith(node) for record in records()) for node in hosts.nodes}
        print(f"shards of each host: {done}")
        self.assertEqual(sum(done.values()), SHARDS)
        self.assertGreater(min(done["node3"], done["node4"]), done["node1"])
        self.assert_same_bits(self.tables("complete.db"), self.tables("study/study.db"))


if __name__ == "__main__":
    unittest.main()
