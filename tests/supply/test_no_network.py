"""The program needs no network: the main job, from study to report, in a namespace that has none, and nothing it runs
even asks for one."""
import json
import os
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CAPSTAN = os.environ["CAPSTAN"]
SOURCE = Path(os.environ["CAPSTAN_SOURCE"])
ALONE = ["unshare", "--map-root-user", "--net", "--"]


def in_no_network(*command, **options):
    return subprocess.run([*ALONE, *command], capture_output=True, text=True, **options)


@unittest.skipUnless(shutil.which("unshare") and in_no_network("true").returncode == 0,
                     "this machine lets nobody make a namespace without a network")
class NoNetwork(unittest.TestCase):
    def test_the_namespace_has_none(self):
        """So that the other tests mean something."""
        listening = socket.create_server(("127.0.0.1", 0))
        reach = f"import socket; socket.create_connection(('127.0.0.1', {listening.getsockname()[1]}), 2)"
        self.assertEqual(0, subprocess.run([sys.executable, "-c", reach]).returncode)
        self.assertNotEqual(0, in_no_network(sys.executable, "-c", reach).returncode)
        listening.close()

    def test_the_main_job_runs_in_it(self):
        with tempfile.TemporaryDirectory() as folder:
            def capstan(*words):
                answer = in_no_network(CAPSTAN, *words, cwd=folder)
                self.assertEqual(0, answer.returncode, answer.stderr)
                return answer.stdout

            config = SOURCE / "configs" / "quick.toml"
            capstan("study", "run", str(config), "--progress", "none")
            self.assertTrue(json.loads(capstan("recommend", "--json")))
            capstan("report", "-o", "report.html")
            capstan("query", "SELECT * FROM v_best_method")
            capstan("export", "tables", "--format", "parquet")
            capstan("doctor")
            page = (Path(folder) / "report.html").read_text()
            self.assertGreater(len(page), 500_000)
            # Nor does the page fetch anything: no address where a browser would go to by itself.
            self.assertEqual([], re.findall(r"<(?:script|link|img|iframe)[^>]*(?:src|href)=[\"']?https?:", page))

    def test_the_same_answer_as_with_one(self):
        with tempfile.TemporaryDirectory() as folder:
            config = str(SOURCE / "configs" / "quick.toml")
            words = [CAPSTAN, "study", "run", config, "--progress", "none", "--json", "--db"]
            alone = in_no_network(*words, "alone.db", cwd=folder)
            beside = subprocess.run([*words, "beside.db"], cwd=folder, capture_output=True, text=True)
            self.assertEqual(0, alone.returncode, alone.stderr)
            self.assertEqual(beside.stdout, alone.stdout)

    @unittest.skipUnless(shutil.which("strace"), "strace is not installed")
    def test_the_main_job_opens_no_socket_to_elsewhere(self):
        with tempfile.TemporaryDirectory() as folder:
            config = str(SOURCE / "configs" / "quick.toml")
            answer = subprocess.run(["strace", "--follow-forks", "-e", "trace=connect", "-o", "calls", CAPSTAN, "study", "run",
                                     config, "--progress", "none"], cwd=folder, capture_output=True, text=True)
            self.assertEqual(0, answer.returncode, answer.stderr)
            self.assertNotIn("AF_INET", (Path(folder) / "calls").read_text())


if __name__ == "__main__":
    unittest.main()
