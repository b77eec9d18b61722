"""MCAP files written by @mcap/core, read back number by number. Without npm, or offline, the test says so and is skipped."""
import base64
import json
import math
import os
import shutil
import struct
import subprocess
import unittest
from pathlib import Path

from cdr import Cdr
from written_log import WrittenLogTest, read_log

HERE = Path(__file__).resolve().parent / "mcap_writer"
WORK = Path(os.environ["CAPSTAN_MCAP_WORK"])
MESSAGES = 600
JOINT_STATE = ("std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n" + "=" * 80 +
               "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + "=" * 80 +
               "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n")
SCHEMAS = [
    {"name": "sensor_msgs/msg/JointState", "encoding": "ros2msg", "text": JOINT_STATE},
    {"name": "lab_msgs/Force", "encoding": "ros1msg", "text": "time stamp\nfloat32 force\nint8[2] flags\n"},
    {"name": "lab.Motor", "encoding": "jsonschema", "text": "{}"},
    {"name": "lab.Odd", "encoding": "protobuf", "text": "?"},
]
CHANNELS = [
    {"schema": 0, "topic": "/joints", "encoding": "cdr"}, {"schema": 1, "topic": "/force", "encoding": "ros1"},
    {"schema": 2, "topic": "/motor", "encoding": "json"}, {"schema": 3, "topic": "/odd", "encoding": "protobuf"},
    {"schema": -1, "topic": "/plain", "encoding": "json"},
]


def install():
    """npm works on a copy, and only when the lock file has changed."""
    for tool in ("node", "npm", "lz4", "zstd"):
        if not shutil.which(tool):
            raise unittest.SkipTest(f"'{tool}' is missing (Debian: apt-get install nodejs npm lz4 zstd)")
    WORK.mkdir(parents=True, exist_ok=True)
    installed = WORK / "installed-lock.json"
    if not installed.exists() or installed.read_bytes() != (HERE / "package-lock.json").read_bytes():
        for name in ("package.json", "package-lock.json", ".npmrc"):
            shutil.copy(HERE / name, WORK)
        try:
            run = subprocess.run(["npm", "--prefix", str(WORK), "ci", "--ignore-scripts", "--loglevel=error",
                                  "--fetch-retries=1", "--fetch-timeout=20000"], capture_output=True, text=True, timeout=120)
        except subprocess.TimeoutExpired:
            raise unittest.SkipTest("npm cannot install @mcap/core: no answer in two minutes") from None
        if run.returncode != 0:
            raise unittest.SkipTest(f"npm cannot install @mcap/core: {run.stderr.strip()[:200]}")
        shutil.copy(HERE / "package-lock.json", installed)
    shutil.copy(HERE / "write_mcap.mjs", WORK)


class McapFiles(WrittenLogTest):
    @classmethod
    def setUpClass(cls):
        install()

    def write(self, compression):
        messages = []
        self.expected = {topic: {} for topic in ("/joints", "/force", "/motor", "/plain")}

        def add(channel, time, data, **numbers):
            messages.append({"channel": channel, "log_time_ns": str(time), "data": base64.b64encode(data).decode()})
            for column, value in {"log_time": time // 10**9 + 1e-9 * (time % 10**9), **numbers}.items():
                self.expected[CHANNELS[channel]["topic"]].setdefault(column.replace("__", "."), []).append(value)

        for k in range(MESSAGES):
            time = 1700000000_000000000 + k * 1234567
            joints = Cdr().header(5, k, "base").number("I", 1).string("knee").numbers([math.sin(k)]).numbers([]).numbers([k])
            add(0, time, joints.message(), header__stamp=5 + 1e-9 * k, position__knee=math.sin(k), effort__knee=k)
            add(1, time, struct.pack("<IIfbb", 9, k, 0.5 * k, -1, 1), stamp=9 + 1e-9 * k, force=0.5 * k, flags__0=-1, flags__1=1)
            motor = {"angle": k / 3, "on": k % 2 == 0, "name": "m", "stamp": {"sec": 4, "nsec": k}, "currents": [k, {"a": None}]}
            add(2, time, json.dumps(motor).encode(), angle=k / 3, currents__0=k, on=k % 2 == 0, stamp=4 + 1e-9 * k)
            messages.append({"channel": 3, "log_time_ns": str(time), "data": ""})
            add(4, time, json.dumps({"x": -k}).encode(), x=-k)
        description = self.folder / "description.json"
        description.write_text(json.dumps({"compression": compression, "schemas": SCHEMAS, "channels": CHANNELS,
                                           "messages": messages}))
        path = self.folder / "log.mcap"
        subprocess.run(["node", str(WORK / "write_mcap.mjs"), str(description), str(path)], check=True)
        return path

    def check(self, path):
        log = read_log(path)
        self.assertEqual(log.format, "MCAP")
        for topic, columns in self.expected.items():
            self.assert_numbers({name: log.tables[topic][name] for name in sorted(log.tables[topic])},
                                {name: columns[name] for name in sorted(columns)})
        return log

    def test_every_number_is_read_whatever_the_compression(self):
        for compression in ("none", "lz4", "zstd", "no chunks"):
            with self.subTest(compression):
                log = self.check(self.write(compression))
                self.assertEqual(log.remarks.count("\n"), 0)
                self.assertIn("/odd is left out: its encoding is 'protobuf'", log.remarks)

    def records(self, content):
        """[(operation, begin, end)] by the specification."""
        at, found = 8, []
        while at + 9 <= len(content):
            operation, length = content[at], struct.unpack_from("<Q", content, at + 1)[0]
            found.append((operation, at, at + 9 + length))
            at += 9 + length
        return found

    def test_a_file_without_a_summary_is_read_and_its_missing_end_told(self):
        path = self.write("zstd")
        complete = path.read_bytes()
        data_end = next(begin for operation, begin, _ in self.records(complete) if operation == 15)
        path.write_bytes(complete[:data_end])
        self.assertIn("is cut", self.check(path).remarks)

    def test_cuts_are_told(self):
        for compression in ("none", "lz4", "zstd", "no chunks"):
            with self.subTest(compression):
                path = self.write(compression)
                data_end = next(end for operation, _, end in self.records(path.read_bytes()) if operation == 15)
                kept = self.assert_cuts_are_told(path, may_be_silent_from=data_end)
                self.assertGreater(kept, MESSAGES * 0.8)

    def test_a_chunk_with_a_wrong_checksum_is_left_out_and_told(self):
        path = self.write("none")
        complete = bytearray(path.read_bytes())
        second = [begin for operation, begin, _ in self.records(complete) if operation == 6][1]
        complete[second + 400] ^= 1
        path.write_bytes(complete)
        log = read_log(path)
        self.assertIn(f"1 chunk is left out, the first at byte {second}: damaged, as its checksum shows", log.remarks)
        self.assertLess(log.rows["/joints"], MESSAGES)
        self.assertGreater(log.rows["/joints"], MESSAGES * 0.5)

    def test_a_bomb_is_not_unpacked(self):
        """A chunk of zeros that states a small size, and one that states a large one."""
        zeros = subprocess.run(["zstd", "-c", "-q"], input=bytes(1 << 30), capture_output=True, check=True).stdout
        for stated in (1000, 1 << 40):
            chunk = struct.pack("<QQQI", 0, 0, stated, 0) + struct.pack("<I", 4) + b"zstd" + struct.pack("<Q", len(zeros)) + zeros
            path = self.folder / "bomb.mcap"
            path.write_bytes(b"\x89MCAP0\r\n" + b"\6" + struct.pack("<Q", len(chunk)) + chunk)
            self.assertIn("no complete message was found", read_log(path).refusal)


if __name__ == "__main__":
    unittest.main()
