"""What one client, and many, may take of the service: memory, threads, time. Each test here is an attack that once succeeded."""

import gzip
import http.client
import json
import pathlib
import socket
import threading
import time
import unittest

from capstan_program import CONFIGS
from capstan_service import PATIENCE_S, ServiceTest

JSON = {"Content-Type": "application/json"}
QUICK = (CONFIGS / "quick.toml").read_text()
OTHER_ADDRESS = "127.0.0.2"  # of a client on this machine
MEMORY_LIMIT_MB = 150


class Limits(ServiceTest):
    def setUp(self):
        super().setUp()
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "served.db")

    def serve(self, *words, **options):
        self.process = super().serve(*words, **options)
        return self.process

    def of_process(self, name):
        text = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return next(int(line.split()[1]) for line in text.splitlines() if line.startswith(name + ":"))

    def assert_small(self):
        self.assertLess(self.of_process("VmHWM") / 1024, MEMORY_LIMIT_MB)

    def connect(self, address=OTHER_ADDRESS):
        connection = socket.create_connection((self.host, self.port), timeout=PATIENCE_S, source_address=(address, 0))
        self.addCleanup(connection.close)
        return connection

    def received_from(self, connection):
        """Everything that the service sends until it closes the connection."""
        text = b""
        try:
            while part := connection.recv(65536):
                text += part
        except (ConnectionResetError, BrokenPipeError):
            pass
        return text

    def status_of(self, request):
        connection = self.connect()
        connection.sendall(request.encode())
        told = self.received_from(connection)
        self.assertEqual(told.count(b"HTTP/1.1 "), 1, told[:200])
        return int(told.split()[1])

    def head(self, *fields, start="GET /api/studies HTTP/1.1"):
        return "\r\n".join([start, f"Host: {self.host}:{self.port}", *fields, "", ""])

    def query(self, sql):
        status, _, text = self.ask("POST", "/api/query", json.dumps({"sql": sql}).encode(), JSON)
        return status, text

    def test_a_head_without_end_is_cut_off(self):
        self.serve()
        before = self.of_process("VmRSS")
        connection = self.connect()
        connection.sendall(f"GET / HTTP/1.1\r\nHost: {self.host}:{self.port}\r\n".encode())
        sent = 0
        try:
            while sent < 300_000_000:
                sent += connection.send(b"X:a\r\n" * 20000)
        except (ConnectionResetError, BrokenPipeError):
            pass
        self.assertLess(sent, 100_000_000)
        self.assertLess(self.of_process("VmRSS") - before, 10_000)
        self.assertEqual(self.status_of(self.head(*["X: a"] * 101)), 431)
        self.assertEqual(self.status_of(self.head(*["X: a"] * 90)), 200)
        self.assertEqual(self.status_of(self.head("X: " + "a" * 20_000)), 431)
        self.assertEqual(self.status_of(self.head(start=f"GET /{'a' * 20_000} HTTP/1.1")), 414)

    def test_slow_senders_hold_no_thread_and_lose_their_connections(self):
        self.serve()
        self.get("/api/jobs")
        threads = self.of_process("Threads")
        slow = [self.connect() for _ in range(100)]
        body = self.head("Content-Type: application/json", "Content-Length: 1000", start="POST /api/query HTTP/1.1")
        for number, connection in enumerate(slow):
            connection.sendall(body.encode() if number % 2 else b"GET / HTTP/1.1\r\nX: ")
        stopped = threading.Event()

        def drip():
            while not stopped.wait(1):
                for connection in slow:
                    try:
                        connection.send(b"x")
                    except OSError:
                        pass

        dripping = threading.Thread(target=drip)
        dripping.start()
        self.addCleanup(dripping.join)
        self.addCleanup(stopped.set)
        begin, longest = time.monotonic(), 0.0
        for _ in range(50):
            asked = time.monotonic()
            self.assertEqual(self.ask("GET", "/api/jobs")[0], 200)
            longest = max(longest, time.monotonic() - asked)
        print(f"100 slow senders: 50 requests of another client, the slowest took {1e3 * longest:.0f} ms")
        self.assertEqual(self.of_process("Threads"), threads)
        for connection in slow:
            self.assertEqual(self.received_from(connection), b"")  # closed, without an answer
        print(f"the slow senders had their connections for {time.monotonic() - begin:.1f} s")

    def test_an_address_has_a_limited_number_of_connections(self):
        self.serve()
        open_before = len(list(pathlib.Path(f"/proc/{self.process.pid}/fd").iterdir()))
        silent = [self.connect() for _ in range(400)]
        for _ in range(3):  # from the same address: a client that asks at once comes before those that wait
            self.assertEqual(self.status_of(self.head()), 200)
        self.assertLessEqual(len(list(pathlib.Path(f"/proc/{self.process.pid}/fd").iterdir())), open_before + 130)
        self.assertEqual(self.received_from(silent[0]), b"")
        self.assertEqual(self.ask("GET", "/api/studies")[0], 200)

    def test_encoded_bodies_are_refused_and_never_decoded(self):
        self.serve()
        body = gzip.compress(json.dumps({"sql": "SELECT 1" + " " * 900_000}).encode())
        for encoding in ("gzip", "br", "deflate", "gzip, br"):
            self.assertEqual(self.ask("POST", "/api/query", body, {**JSON, "Content-Encoding": encoding})[0], 415, encoding)
        self.assert_small()

    def test_ranges_do_not_multiply_an_answer(self):
        self.serve()
        plain = self.ask("GET", "/web/vega.min.js")[2]
        ranges = "bytes=" + ",".join(["0-"] * 2000)
        for _ in range(8):
            status, headers, text = self.ask("GET", "/web/vega.min.js", headers={"Range": ranges})
            self.assertEqual((status, text), (200, plain), headers)
        self.assert_small()

    def test_queries_end_at_their_limits(self):
        self.serve("--query-limit", 1)
        nested = "with c0 as (select 1 x), " + ", ".join(
            f"c{k} as (select x from c{k - 1} union all select x from c{k - 1})" for k in range(1, 31)) + " select count(*) from c30"
        bombs = [nested,
                 "select printf('%.*c',999999,'a') like '%'||printf('%.*c',49990,'a')||'b'",
                 "select instr(printf('%.*c',999999,'a'),printf('%.*c',499999,'a')||'b')",
                 "select printf('%.*c',999999,'a') glob '*" + "[a]" * 9000 + "'",
                 "select printf('%.*c',2147483646,'x')",
                 "select group_concat(a.mean_abs_error_N) from cell_node a, cell_node b, cell_node c",
                 "select " + "(" * 50000,
                 "select '" + "x" * 200_000 + "'",
                 "select 1\0"]
        statuses = {}

        def attack(sql):
            statuses[sql] = self.query(sql)

        attacks = [threading.Thread(target=attack, args=(sql,)) for sql in bombs]
        for each in attacks:
            each.start()
        for _ in range(20):
            self.assertEqual(self.ask("GET", "/api/jobs")[0], 200)
        for each in attacks:
            each.join()
        for sql, (status, text) in statuses.items():
            self.assertIn(status, (400, 408, 413), (sql[:80], text))
            self.assertIn("error", json.loads(text))
        self.assertEqual(self.query("select 1 as x"), (200, b'[\n  {\n    "x": 1\n  }\n]\n'))
        self.assert_small()

    def test_a_long_answer_is_cut_off(self):
        self.serve()
        many = "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n LIMIT 150000) SELECT x FROM n"
        status, headers, text = self.ask("POST", "/api/query", json.dumps({"sql": many, "format": "csv"}).encode(), JSON)
        self.assertEqual((status, headers["X-Truncated"], len(text.splitlines())), (200, "yes", 100_001))

    def test_texts_are_compressed_once_and_are_the_same(self):
        self.serve()
        for path in ("/", "/web/vega.min.js", "/studies/1", "/api/studies/1/report"):
            status, headers, plain = self.ask("GET", path)
            self.assertEqual((status, headers.get("Content-Encoding")), (200, None), path)
            status, headers, packed = self.ask("GET", path, headers={"Accept-Encoding": "gzip, deflate, br"})
            self.assertEqual((status, headers["Content-Encoding"], headers["Vary"]), (200, "gzip", "Accept-Encoding"), path)
            self.assertEqual(gzip.decompress(packed), plain, path)
        used = self.processor_ticks()
        for _ in range(200):
            self.ask("GET", "/studies/1", headers={"Accept-Encoding": "gzip"})
        print(f"200 compressed pages took {10 * (self.processor_ticks() - used)} ms of processor time")
        self.assertLess(self.processor_ticks() - used, 300)  # to compress a page each time took 20 to 100 ticks of 10 ms

    def processor_ticks(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return int(fields[11]) + int(fields[12])

    def test_expectations_and_lengths(self):
        self.serve()
        body = json.dumps({"sql": "SELECT 1"})
        connection = self.connect()
        connection.sendall(self.head("Content-Type: application/json", f"Content-Length: {len(body)}", "Expect: 100-continue",
                                     start="POST /api/query HTTP/1.1").encode())
        self.assertEqual(connection.recv(100), b"HTTP/1.1 100 Continue\r\n\r\n")
        connection.sendall(body.encode())
        self.assertTrue(self.received_from(connection).startswith(b"HTTP/1.1 200 OK\r\n"))
        post = "POST /api/query HTTP/1.1"
        kind = "Content-Type: application/json"
        self.assertEqual(self.status_of(self.head(kind, "Content-Length: 2000000", "Expect: 100-continue", start=post)), 413)
        self.assertEqual(self.status_of(self.head(kind, "Content-Length: 2", "Expect: tea", start=post) + "{}"), 417)
        for lengths in (("2", "2"), ("2", "3"), ("2, 2",), ("-2",), ("0x2",), ("2 3",), ("",)):
            fields = [f"Content-Length: {length}" for length in lengths]
            self.assertEqual(self.status_of(self.head(kind, *fields, start=post) + "{}"), 400, lengths)
        self.assertEqual(self.status_of(self.head(f"Host: {self.host}:{self.port}")), 400)
        self.assertEqual(self.status_of(self.head("Origin: null", "Origin: null")), 400)
        self.assertEqual(self.status_of(self.head(kind, "Content-Length: 2", "Transfer-Encoding: chunked", start=post)), 400)
        self.assertEqual(self.status_of(self.head(start="PUT /api/studies HTTP/1.1").replace("\r\n\r\n", "\r\nContent-Length: 0\r\n\r\n")), 405)
        for start in ("GET", "GET /", "GET / HTTP/3.0", "\0", "GET  / HTTP/1.1"):
            self.assertEqual(self.status_of(self.head(start=start)), 400, start)

    def test_numbers_of_jobs_are_whole_numbers(self):
        self.serve()
        job = self.post("/api/studies", {"config_toml": (CONFIGS / "quick.toml").read_text()}, expect=202)[0]["job"]
        self.assertEqual(job, 1)
        for number in (4294967297, 8589934593, 18446744073709551617, "1.0", "+1", "1e0", "0x1"):
            self.assertEqual(self.ask("GET", f"/api/jobs/{number}")[0], 404, number)
            self.assertEqual(self.ask("POST", f"/api/jobs/{number}/stop", b"{}", JSON)[0], 404, number)
        self.await_job(1, "done")

    def test_the_queue_is_limited_and_private(self):
        self.serve()
        for path in (self.folder / "served.db.jobs",):
            self.assertEqual(path.stat().st_mode & 0o777, 0o700)
        many = QUICK + "[sweep]\nfriction_ratio = [" + ", ".join(f"{0.5 + k / 1000:.3f}" for k in range(501)) + "]\n"
        self.assertIn("at most 500", self.post("/api/studies", {"config_toml": many}, expect=503)["error"])
        self.assertEqual(self.get("/api/jobs"), [])

    def test_heads_are_answered_without_their_bodies(self):
        self.serve()
        connection = self.connect()
        connection.sendall(self.head(start="HEAD / HTTP/1.1").encode())
        head, body = self.received_from(connection).split(b"\r\n\r\n", 1)
        self.assertIn(b"Content-Length: ", head)
        self.assertEqual(body, b"")


if __name__ == "__main__":
    unittest.main()
