"""2,500 shards on a Slurm whose arrays end at 1000, as by default, with four nodes: one is ten times slower, one is killed.

The work of a shard is to wait for a slow disk, so that the nodes need not share this machine's processors. Ideal is the work
divided by what the nodes that live can do at each moment. Both are printed; a busy machine is not a failure."""

import json
import os
import statistics
import subprocess
import time
import unittest

from capstan_program import PROGRAM, CapstanTest
from slurm_cluster import SlurmCluster, why_not

LEVELS = INSTANTS = int(os.environ.get("CAPSTAN_LEVELS", "50"))
SHARDS = LEVELS * INSTANTS
SLOTS = 4  # of a node
SYNC_S = os.environ.get("CAPSTAN_SYNC_S", "0.3")
STUDY = f"""\
name = "many"
repetitions = 2
[transmission]
segments = 3
axial_stiffness_N = 2000
dynamic_friction = 0.2
static_friction = 0.3
pretension_N = 10
[[transmission.curvature]]
length_m = 0.3
bend_radius_m = 0.2
[motion]
sample_rate_Hz = 1000
samples = 400
[motion.proximal]
amplitude_m = 0.003
frequency_Hz = 1
[[regime]]
name = "mass"
samples = [{", ".join(str(15 + k) for k in range(INSTANTS))}]
duty_fraction = 1
""" + "".join(f'[[noise]]\nlabel = "{k}"\nmultiplicative_ratio = {k / 1000}\n' for k in range(1, LEVELS + 1)) + """\
[layouts]
counts = [1]
"""


@unittest.skipIf(why_not(), why_not())
class ManyShards(CapstanTest):
    def test_no_node_holds_the_others(self):
        cluster = SlurmCluster(self.folder / "slurm", processors=SLOTS)
        self.addCleanup(cluster.stop)
        self.assertIn("= 1001", next(line for line in cluster.slurm("scontrol", "show", "config").splitlines() if "MaxArraySize" in line))
        self.write("many.toml", STUDY)
        self.run_capstan("study", "run", "many.toml", "--db", "complete.db")
        environment = dict(cluster.environment, LD_PRELOAD=os.environ["CAPSTAN_SLOW_DISK"], CAPSTAN_SYNC_S=SYNC_S, CAPSTAN_SLOW_HOST="n1")
        begin = time.monotonic()
        done = subprocess.run([PROGRAM, "study", "submit", "many.toml", "--slurm", "--shards", str(SHARDS), "--pilot", "0", "--directory",
                               "study"], cwd=self.folder, env=environment, capture_output=True, text=True)
        self.assertIn(f"Submitted shards 1-{SHARDS} of {SHARDS}", done.stdout, done.stderr)
        arrays = done.stdout.split(" as ")[1].split(".")[0]
        leases = self.folder / "study/leases"
        count = lambda: sum(name.endswith(".done") for name in os.listdir(leases))
        cluster.wait("a third of the shards", lambda: count() >= SHARDS // 3, 7200)
        cluster.kill_node("n2")
        died_s = time.monotonic() - begin
        killed_at = count()
        cluster.wait("the merged study", lambda: (self.folder / "study/study.db").exists(), 7200)
        wall_s = time.monotonic() - begin
        records = [json.loads(path.read_text()) for path in leases.glob("shard-*.done")]
        # A worker that dies between its result and its record leaves a result that counts.
        self.assertGreaterEqual(len(records), SHARDS - SLOTS)
        seconds = statistics.median(record["seconds"] for record in records)
        work = SHARDS * seconds - died_s * SLOTS * 3.1  # three nodes and a tenth, then two and a tenth
        ideal_s = died_s + work / (SLOTS * 2.1)
        print(f"{SHARDS} shards as {arrays}; n2 killed after {killed_at}; a shard takes {seconds:.2f} s in the median: "
              f"{wall_s:.0f} s, ideal {ideal_s:.0f} s, {wall_s / ideal_s:.2f} of it")
        self.assert_same_bits(self.tables("complete.db"), self.tables("study/study.db"))


if __name__ == "__main__":
    unittest.main()
