"""Slow, greedy and hostile clients at once, and an honest browser among them: it is always answered, and the service stays small.

How long the answers take is told, not judged. CAPSTAN_LOAD_SECONDS says for how long (8)."""

import json
import os
import pathlib
import socket
import threading
import time
import unittest

from capstan_program import CONFIGS
from capstan_service import PATIENCE_S, ServiceTest

SECONDS = float(os.environ.get("CAPSTAN_LOAD_SECONDS", "8"))
BROWSERS = 50
MEMORY_LIMIT_MB = 150
JSON = {"Content-Type": "application/json"}
PAGES = ("/", "/studies/1", "/web/page.js", "/web/vega.min.js", "/api/jobs", "/api/studies", "/api/studies/1/report")


class Load(ServiceTest):
    def setUp(self):
        super().setUp()
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "served.db")
        self.process = self.serve("--query-limit", 1)
        self.over = threading.Event()
        self.threads = []

    def in_thread(self, work, *arguments):
        def repeat():
            while not self.over.is_set():
                try:
                    work(*arguments)
                except OSError:  # the service closed the connection: its right
                    time.sleep(0.01)

        self.threads.append(threading.Thread(target=repeat))
        self.threads[-1].start()

    def connect(self):
        connection = socket.create_connection((self.host, self.port), timeout=PATIENCE_S, source_address=("127.0.0.2", 0))
        connection.settimeout(20)
        return connection

    def drip(self):
        with self.connect() as connection:
            connection.sendall(b"GET / HTTP/1.1\r\n")
            while not self.over.wait(0.5):
                connection.sendall(b"X")

    def send_a_head_without_end(self):
        with self.connect() as connection:
            connection.sendall(b"GET / HTTP/1.1\r\n")
            while not self.over.is_set():
                connection.sendall(b"X:a\r\n" * 10000)

    def ask_for_much_and_read_nothing(self):
        with self.connect() as connection:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            body = json.dumps({"sql": "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n LIMIT 100000) SELECT x, "
                                      f"hex(randomblob(20)) AS y FROM n -- {time.monotonic()}"})
            connection.sendall(f"POST /api/query HTTP/1.1\r\nHost: {self.host}:{self.port}\r\nContent-Type: application/json\r\n"
                               f"Content-Length: {len(body)}\r\n\r\n{body}".encode())
            self.over.wait(3)

    def upload_much(self):
        part = (b'--b\r\nContent-Disposition: form-data; name="log"; filename="a.csv"\r\n\r\n' + b"1," * 15_000_000 + b"\r\n--b--\r\n")
        with self.connect() as connection:
            connection.sendall(f"POST /api/diagnoses HTTP/1.1\r\nHost: {self.host}:{self.port}\r\nContent-Type: multipart/form-data; "
                               f"boundary=b\r\nContent-Length: {len(part)}\r\n\r\n".encode())
            connection.sendall(part)
            connection.recv(1000)

    def bomb(self):
        nested = "with c0 as (select 1 x), " + ", ".join(
            f"c{k} as (select x from c{k - 1} union all select x from c{k - 1})" for k in range(1, 31)) + " select count(*) from c30"
        self.ask("POST", "/api/query", json.dumps({"sql": nested}).encode(), JSON)

    def multiply(self):
        self.ask("GET", "/web/vega.min.js", headers={"Range": "bytes=" + ",".join(["0-"] * 2000)})

    def browse(self, times_s, problems, number):
        turn = number
        while not self.over.is_set():
            begin = time.monotonic()
            try:
                status, _, text = self.ask("GET", PAGES[turn % len(PAGES)], headers={"Accept-Encoding": "gzip"})
            except OSError as error:
                status, text = 0, str(error)
            times_s.append(time.monotonic() - begin)
            if status != 200:
                problems.append((PAGES[turn % len(PAGES)], status, text[:200]))
            turn += 1
            self.over.wait(0.5)  # a person reads

    def test_an_honest_browser_is_answered(self):
        for _ in range(60):
            self.in_thread(self.drip)
        for work in (self.send_a_head_without_end, self.ask_for_much_and_read_nothing, self.upload_much, self.bomb, self.multiply):
            for _ in range(2):
                self.in_thread(work)
        times_s, problems = [], []
        browsers = [threading.Thread(target=self.browse, args=(times_s, problems, number)) for number in range(BROWSERS)]
        for each in browsers:
            each.start()
        self.over.wait(SECONDS)
        self.over.set()
        for each in browsers + self.threads:
            each.join()
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        peak_MB = next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmHWM:")) / 1024
        times_s.sort()
        print(f"{BROWSERS} browsers among 70 others: {len(times_s)} requests, median {1e3 * times_s[len(times_s) // 2]:.0f} ms, "
              f"p99 {1e3 * times_s[int(0.99 * len(times_s))]:.0f} ms; memory {peak_MB:.0f} MB at most")
        self.assertEqual(problems, [])
        self.assertLess(peak_MB, MEMORY_LIMIT_MB)
        self.assertEqual(self.ask("GET", "/api/jobs")[0], 200)


if __name__ == "__main__":
    unittest.main()
