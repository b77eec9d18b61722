"""A running `capstan serve`, and requests to it that may be as wrong as those of an attacker."""

import http.client
import json
import re
import time
import uuid

from capstan_program import CapstanTest

PATIENCE_S = 1800  # for work that a busy machine may take long for; nothing is judged by it


class ServiceTest(CapstanTest):
    def serve(self, *words, db="served.db"):
        """Starts the service on a free port and remembers it; returns the process."""
        process = self.start_capstan("serve", "--db", db, "--port", 0, *words)
        first = process.stderr.readline()
        address = re.search(r"at http://([0-9.]+):(\d+)/(?:\?token=(\S+))?", first)
        self.assertIsNotNone(address, first)
        self.host, self.port, self.token = address[1], int(address[2]), address[3]
        return process

    def ask(self, method, path, body=None, headers=None, host=None):
        """Status, headers and bytes of the answer."""
        connection = http.client.HTTPConnection(self.host, self.port, timeout=PATIENCE_S)
        try:
            connection.putrequest(method, path, skip_host=True)
            connection.putheader("Host", host or f"{self.host}:{self.port}")
            for name, value in (headers or {}).items():
                connection.putheader(name, value)
            if body is not None and "Content-Length" not in (headers or {}):
                connection.putheader("Content-Length", str(len(body)))
            connection.endheaders(body)
            answer = connection.getresponse()
            return answer.status, dict(answer.getheaders()), answer.read()
        finally:
            connection.close()

    def get(self, path, expect=200):
        status, _, text = self.ask("GET", path)
        self.assertEqual(status, expect, text)
        return json.loads(text)

    def post(self, path, value=None, expect=200):
        status, _, text = self.ask("POST", path, json.dumps(value or {}).encode(), {"Content-Type": "application/json"})
        self.assertEqual(status, expect, text)
        return json.loads(text)

    def upload(self, files, expect=202, path="/api/diagnoses"):
        """`files`: part -> (file name, bytes), or pairs of these where a part comes more than once."""
        border = uuid.uuid4().hex
        parts = files.items() if isinstance(files, dict) else files
        body = b"".join(f'--{border}\r\nContent-Disposition: form-data; name="{part}"; filename="{name}"\r\n\r\n'.encode()
                        + content + b"\r\n" for part, (name, content) in parts) + f"--{border}--\r\n".encode()
        status, _, text = self.ask("POST", path, body,
                                   {"Content-Type": f"multipart/form-data; boundary={border}"})
        self.assertEqual(status, expect, text)
        return json.loads(text)

    def await_job(self, number, *states):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            job = self.get(f"/api/jobs/{number}")
            if job["state"] in states:
                return job
            self.assertNotEqual(job["state"], "failed", job)
            time.sleep(0.05)
        self.fail(f"job {number} is still {job}")

    def await_units(self, study_id, units):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            done = [s["units_done"] for s in self.get("/api/studies") if s["study_id"] == study_id]
            if done and done[0] >= units:
                return done[0]
            time.sleep(0.01)
        self.fail(f"study {study_id} has not come to {units} units")
