"""The service and those who mean no good: every one is refused with the right status, and nothing is changed."""

import json
import socket
import unittest

from capstan_program import CONFIGS
from capstan_service import ServiceTest

JSON = {"Content-Type": "application/json"}


class Strangers(ServiceTest):
    def setUp(self):
        super().setUp()
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--db", "served.db")
        self.before = self.results()
        self.addCleanup(lambda: self.assert_same_bits(self.before, self.results()))

    def results(self):
        """Every table but the one that holds notes and the trash."""
        tables = self.tables("served.db")
        del tables["study_mark"]
        return tables

    def status(self, *request, **options):
        status, headers, text = self.ask(*request, **options)
        if status >= 400:
            self.assertIn("error", json.loads(text))
        return status

    def query(self, sql):
        return self.status("POST", "/api/query", json.dumps({"sql": sql}).encode(), JSON)

    def test_the_query_box_only_reads(self):
        (self.folder / "secret.txt").write_text("secret")
        self.serve()
        for sql in ("DELETE FROM study", "UPDATE study SET name = 'x'", "INSERT INTO shard VALUES (1, 1)", "DROP TABLE study",
                    "CREATE TABLE t (x)", "CREATE TEMP TABLE t (x)", "ATTACH 'other.db' AS o", "VACUUM INTO 'copy.db'", "REINDEX",
                    "PRAGMA writable_schema = ON", "PRAGMA journal_mode = DELETE", "PRAGMA user_version = 9",
                    "PRAGMA query_only = OFF", "SELECT load_extension('evil')", "SELECT readfile('secret.txt')",
                    "SELECT writefile('x', 'y')", "SELECT edit('x')", "SELECT fts3_tokenizer('x')", "SELECT 1; DELETE FROM study",
                    "BEGIN", "COMMIT", "WITH x AS (SELECT 1) DELETE FROM study", "SELECT * FROM pragma_writable_schema", "",
                    "SELEC 1", "SELECT * FROM nothing", "SELECT randomblob(2000000000)"):
            self.assertEqual(self.query(sql), 400, sql)
        self.assertEqual(self.query("SELECT 1"), 200)
        self.assertEqual(sorted(path.name for path in self.folder.glob("*.db")), ["served.db"])

    def test_a_query_without_end_is_ended(self):
        self.serve("--query-limit", 0.2)
        endless = "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT count(*) FROM n"
        self.assertEqual(self.query(endless), 408)
        self.assertEqual(self.query("SELECT count(*) FROM cell_node a, cell_node b, cell_node c, cell_node d"), 408)

    def test_pages_of_other_sites(self):
        self.serve()
        own = f"http://{self.host}:{self.port}"
        for origin in ("http://evil.example", "null", f"https://{self.host}:{self.port}", f"http://{self.host}:1"):
            self.assertEqual(self.status("GET", "/api/studies", headers={"Origin": origin}), 403, origin)
            self.assertEqual(self.status("POST", "/api/studies", b"{}", {**JSON, "Origin": origin}), 403, origin)
        for site in ("cross-site", "same-site"):
            self.assertEqual(self.status("GET", "/api/studies", headers={"Sec-Fetch-Site": site}), 403)
        self.assertEqual(self.status("GET", "/api/studies", headers={"Origin": own, "Sec-Fetch-Site": "same-origin"}), 200)
        # A name that was made to point to this machine.
        for host in (f"evil.example:{self.port}", "evil.example", "127.0.0.1", f"127.0.0.1.evil.example:{self.port}"):
            self.assertEqual(self.status("GET", "/api/studies", host=host), 403, host)
        self.assertEqual(self.status("GET", "/api/studies", host=f"localhost:{self.port}"), 200)
        # What a form of another page could send without asking.
        for kind in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"):
            self.assertEqual(self.status("POST", "/api/query", b'{"sql": "SELECT 1"}', {"Content-Type": kind}), 415)

    def test_a_refused_body_is_never_taken_for_a_request(self):
        self.serve()
        inner = f"GET /api/studies HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n\r\n"
        outer = (f"POST /api/studies HTTP/1.1\r\nHost: evil.example\r\nContent-Type: application/json\r\n"
                 f"Content-Length: {len(inner)}\r\n\r\n{inner}")
        with socket.create_connection((self.host, self.port), timeout=60) as connection:
            connection.sendall(outer.encode())
            told = b""
            try:
                while part := connection.recv(65536):
                    told += part
            except ConnectionResetError:
                pass
        self.assertEqual(told.count(b"HTTP/1.1"), 1, told)
        self.assertIn(b" 403 ", told.splitlines()[0])

    def test_a_token_is_demanded_away_from_loopback(self):
        process = self.serve("--host", "0.0.0.0")
        self.assertEqual(len(self.token), 32)
        self.assertEqual(self.status("GET", "/api/studies"), 401)
        self.assertEqual(self.status("GET", "/"), 401)
        self.assertEqual(self.status("GET", "/?token=wrong"), 401)
        for wrong in ("", "Bearer ", "Bearer wrong", "Bearer " + self.token[:-1], "Basic " + self.token, self.token):
            self.assertEqual(self.status("GET", "/api/studies", headers={"Authorization": wrong}), 401, wrong)
        right = {"Authorization": "Bearer " + self.token}
        self.assertEqual(self.status("GET", "/api/studies", headers=right), 200)
        self.assertEqual(self.status("GET", "/api/studies", headers={**right, "Origin": "http://evil.example"}), 403)
        status, headers, _ = self.ask("GET", "/?token=" + self.token)
        self.assertEqual((status, headers["Location"]), (303, "/"))
        self.assertIn("HttpOnly; SameSite=Strict", headers["Set-Cookie"])
        cookie = headers["Set-Cookie"].split(";")[0]
        self.assertEqual(self.status("GET", "/api/studies", headers={"Cookie": "a=b; " + cookie}), 200)
        process.kill()
        self.write("token.txt", "0123456789abcdefXYZ\n")
        self.serve("--token-file", "token.txt", db="other.db")
        self.assertEqual(self.status("GET", "/api/studies"), 401)
        self.assertEqual(self.status("GET", "/api/studies", headers={"Authorization": "Bearer 0123456789abcdefXYZ"}), 200)
        self.run_capstan("serve", "--token-file", self.write("short.txt", "abc"), "--port", 0, expect=2)

    def test_paths_stay_inside(self):
        (self.folder / "inside").mkdir()
        (self.folder / "inside/one.toml").write_text((CONFIGS / "quick.toml").read_text())
        (self.folder / "outside.toml").write_text("name = 'secret'")
        self.serve("--configs", "inside")
        self.assertEqual(self.get("/api/configs"), ["one.toml"])
        self.assertEqual(self.status("GET", "/api/configs/one.toml"), 200)
        for path in ("/api/configs/../outside.toml", "/api/configs/..%2foutside.toml", "/api/configs/%2e%2e%2foutside.toml",
                     "/api/configs//etc/passwd", "/web/../../etc/passwd", "/web/..%2f..%2fetc%2fpasswd", "/../../etc/passwd",
                     "/served.db", "/studies/..", "/studies/1/../../served.db"):
            self.assertIn(self.status("GET", path), (400, 404), path)
        for name in ("../outside.toml", "/etc/passwd", "one.toml/../../outside.toml", "inside/one.toml", ""):
            self.post("/api/studies", {"config": name}, expect=404)

    def test_sizes_are_limited(self):
        self.serve()
        gigabyte = {"Content-Type": "multipart/form-data; boundary=x", "Content-Length": str(1 << 30)}
        self.assertEqual(self.status("POST", "/api/diagnoses", headers=gigabyte), 413)
        self.assertEqual(self.status("POST", "/api/diagnoses", headers={**gigabyte, "Content-Length": "9" * 30}), 400)
        self.assertEqual(self.status("POST", "/api/query", headers={**JSON, "Content-Length": str(2 << 20)}), 413)
        self.assertEqual(self.status("POST", "/api/query", headers=JSON), 411)
        self.assertEqual(self.status("POST", "/api/diagnoses", headers={"Content-Type": "multipart/form-data; boundary=x",
                                                                       "Transfer-Encoding": "chunked"}), 411)
        self.assertEqual(self.status("GET", "/" + "x" * 20000), 414)

    def test_bodies_that_make_no_sense(self):
        self.serve()
        for body in (b"", b"{", b"[]", b"1", b"\xff\xfe", b'{"sql": 3}', b'{"sql": "SELECT 1", "format": "xml"}', b"{}"):
            self.assertEqual(self.status("POST", "/api/query", body, JSON), 400, body)
        for config in ("no toml", "repetitions = 'many'", "[sweep]\nfriction_ratio = [1e99]"):
            self.post("/api/studies", {"config_toml": config}, expect=400)
        self.assertIn("repetitions", self.post("/api/studies", {"config_toml": "repetitions = -3"}, expect=400)["error"])
        self.upload({"log": ("a.csv", b"time_s\n")}, expect=400)
        self.upload({"log": ("a.csv", b"time_s\n"), "sidecar": ("a.json", b"[")}, expect=400)
        for path in ("/api/studies/7", "/api/studies/99999999999999999999", "/api/jobs/3", "/api/diagnoses/1", "/nothing"):
            self.assertEqual(self.status("GET", path), 404, path)
        self.assertEqual(self.get("/api/jobs"), [])

    def test_a_recording_that_makes_no_sense_fails_with_the_reason(self):
        self.serve()
        job = self.upload({"log": ("a.csv", b"nonsense"), "sidecar": ("a.json", b"{}")})["job"]
        while (told := self.get(f"/api/jobs/{job}"))["state"] in ("queued", "running"):
            pass
        self.assertEqual(told["state"], "failed")
        self.assertIn("a.json", told["message"])

    def test_every_path_of_the_description_is_there(self):
        self.serve("--configs", CONFIGS)
        described = self.get("/openapi.json")
        self.assertEqual(described["openapi"], "3.0.3")
        for path, item in described["paths"].items():
            real = path.replace("{study_id}", "1").replace("{name}", "quick.toml").replace("{job}", "7").replace(
                "{diagnosis_id}", "7")
            for method, about in item.items():
                if method == "parameters":
                    continue
                with self.subTest(f"{method} {path}"):
                    kinds = [kind + "; boundary=x" for kind in about.get("requestBody", {}).get("content", {})]
                    body = (b"{}", {"Content-Type": kinds[0]}) if kinds else (None, {})
                    status, headers, text = self.ask(method.upper(), real, *body)
                    self.assertIn(str(status), about["responses"], text)
                    content = about["responses"][str(status)].get("content", {"application/json": {}})
                    self.assertIn(headers["Content-Type"].split(";")[0], content)
                    self.check_shape(described, content, headers, text)

    def check_shape(self, described, content, headers, text):
        kind = headers["Content-Type"].split(";")[0]
        if kind != "application/json":
            return
        value, schema = json.loads(text), content[kind].get("schema", {})
        if schema.get("type") == "array":
            self.assertIsInstance(value, list)
            if not value:
                return
            value, schema = value[0], schema["items"]
        schema = described["components"]["schemas"].get(schema.get("$ref", "").split("/")[-1], schema)
        for name in schema.get("required", []):
            self.assertIn(name, value)


if __name__ == "__main__":
    unittest.main()
