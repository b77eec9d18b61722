"""ROS 1 bags written by rosbag, rosbag2 files by sqlite3, read back number by number."""
import importlib
import math
import sqlite3
import struct
import unittest

from cdr import Cdr
from written_log import WrittenLogTest, read_log


def installed(module):
    try:
        return importlib.import_module(module)
    except ImportError:
        return None


rosbag = installed("rosbag")
MESSAGES = 400


@unittest.skipUnless(rosbag and installed("sensor_msgs.msg"), "python3-rosbag and python3-sensor-msgs are not installed")
class RosBags(WrittenLogTest):
    def write(self, compression, name="log.bag"):
        import genpy
        from geometry_msgs.msg import WrenchStamped
        from sensor_msgs.msg import Imu, JointState
        from std_msgs.msg import Float32, Float64, Float64MultiArray, Int32, String
        path = self.folder / name
        self.expected = {topic: {} for topic in ("/joints", "/wrench", "/force", "/small", "/count", "/array", "/imu")}

        def note(topic, time, **numbers):
            for column, value in {"log_time": time.secs + 1e-9 * time.nsecs, **numbers}.items():
                self.expected[topic].setdefault(column.replace("__", "."), []).append(value)

        with rosbag.Bag(str(path), "w", compression=compression, chunk_threshold=20000) as bag:
            for k in range(MESSAGES):
                time = genpy.Time(1700000000 + k // 10, 1000003 * (k % 10))
                stamp = genpy.Time(1700000000 + k // 10, 1000000 * (k % 10))
                measured = stamp.secs + 1e-9 * stamp.nsecs
                value = math.sin(k) * 1e3
                joints = JointState(name=["knee", "hip"] if k % 3 else ["hip", "knee"], position=[k, -k] if k % 3 else [-k, k],
                                    velocity=[0.1 * k, 0.2 * k] if k % 3 else [0.2 * k, 0.1 * k], effort=[])
                joints.header.stamp, joints.header.seq = stamp, k
                bag.write("/joints", joints, time)
                note("/joints", time, header__seq=k, header__stamp=measured,
                     position__hip=-k, position__knee=k, velocity__hip=0.2 * k, velocity__knee=0.1 * k)
                wrench = WrenchStamped()
                wrench.header.stamp, wrench.header.seq = stamp, k
                wrench.header.frame_id = "tool" * (k % 4)
                wrench.wrench.force.x, wrench.wrench.torque.z = value, -value
                bag.write("/wrench", wrench, time)
                note("/wrench", time, header__seq=k, header__stamp=measured, wrench__force__x=value, wrench__force__y=0,
                     wrench__force__z=0, wrench__torque__x=0, wrench__torque__y=0, wrench__torque__z=-value)
                bag.write("/force", Float64(value), time)
                note("/force", time, data=value)
                bag.write("/small", Float32(0.5 * k), time)
                note("/small", time, data=0.5 * k)
                bag.write("/count", Int32(-k), time)
                note("/count", time, data=-k)
                bag.write("/array", Float64MultiArray(data=[k, value, 7][:2 + k % 2]), time)
                note("/array", time, layout__data_offset=0, data__0=k, data__1=value, data__2=7 if k % 2 else math.nan)
                bag.write("/words", String("nothing to plot"), time)
                imu = Imu()
                imu.header.stamp, imu.header.seq = stamp, k
                imu.orientation.w, imu.linear_acceleration.z = 1.0, 9.81
                imu.angular_velocity_covariance = [0.01 * j for j in range(9)]
                bag.write("/imu", imu, time)
        return path

    def check(self, path):
        log = read_log(path)
        self.assertEqual(log.format, "ROS 1 bag")
        self.assertEqual(log.remarks, "")
        for topic, columns in self.expected.items():
            if topic == "/imu":
                imu = log.tables[topic]
                self.assertEqual(imu["linear_acceleration.z"], [9.81] * MESSAGES)
                self.assertEqual([imu[f"angular_velocity_covariance.{j}"][-1] for j in range(9)], [0.01 * j for j in range(9)])
                self.assertEqual(len(imu), 1 + 2 + 4 + 3 + 3 + 27)
            else:
                self.assert_numbers({name: log.tables[topic][name] for name in sorted(log.tables[topic])},
                                    {name: columns[name] for name in sorted(columns)})
        self.assertEqual(log.rows["/words"], MESSAGES)
        self.assertEqual(list(log.tables["/words"]), ["log_time"])

    def test_every_number_is_read_whatever_the_compression(self):
        for compression in ("none", "bz2", "lz4"):
            with self.subTest(compression):
                self.check(self.write(compression))

    def test_a_bag_without_an_index_is_read(self):
        """As an interrupted recording leaves it: the header's index position is 0 and the index is missing."""
        path = self.write("lz4")
        complete = path.read_bytes()
        index = struct.unpack("<Q", complete.split(b"index_pos=", 1)[1][:8])[0]
        path.write_bytes(complete[:index].replace(b"index_pos=" + struct.pack("<Q", index), b"index_pos=" + bytes(8)))
        self.check(path)

    def test_cuts_are_told(self):
        for compression in ("none", "bz2", "lz4"):
            with self.subTest(compression):
                path = self.write(compression)
                index = struct.unpack("<Q", path.read_bytes().split(b"index_pos=", 1)[1][:8])[0]
                kept = self.assert_cuts_are_told(path, may_be_silent_from=index)
                self.assertGreater(kept, MESSAGES * 0.9)

    def test_a_claim_of_four_gigabytes_is_refused(self):
        path = self.write("none")
        complete = path.read_bytes()
        size = complete.index(b"size=")
        path.write_bytes(complete[:size + 5] + b"\xff\xff\xff\xff" + complete[size + 9:])
        self.assertIn("chunk of more than 64 MB", read_log(path).refusal)


class Rosbag2Files(WrittenLogTest):
    def write(self, big_endian=False, definitions=False):
        path = self.folder / "log.db3"
        path.unlink(missing_ok=True)
        file = sqlite3.connect(path)
        file.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
                     "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
        file.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                     "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
        file.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
        names = {1: ("/joints", "sensor_msgs/msg/JointState"), 2: ("/wrench", "geometry_msgs/msg/WrenchStamped"),
                 3: ("/force", "std_msgs/msg/Float64"), 4: ("/array", "std_msgs/msg/Float64MultiArray"),
                 5: ("/imu", "sensor_msgs/msg/Imu"), 6: ("/own", "lab_msgs/msg/Motor")}
        for number, (name, kind) in names.items():
            file.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", (number, name, kind))
        if definitions:
            file.execute("CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, "
                         "encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, type_description_hash TEXT)")
            file.execute("INSERT INTO message_definitions VALUES (1, 'lab_msgs/msg/Motor', 'ros2msg', ?, '')",
                         ("# a motor\nuint8 MODE_OFF=0\nuint8 mode 3\nfloat64 current # A\nstring<=8 label\nbool[3] limits\n"
                          "Pair[<=4] pairs\nint64 ticks\n" + "=" * 80 + "\nMSG: lab_msgs/Pair\nfloat32 a\nint16 b\n",))
        self.expected = {name: {} for name, _ in names.values()}

        def add(number, k, message, **numbers):
            time = 1700000000_000000000 + k * 1000000
            file.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", (number, time, message.message()))
            seconds = time // 10**9 + 1e-9 * (time % 10**9)
            for column, value in {"log_time": seconds, **numbers}.items():
                self.expected[names[number][0]].setdefault(column.replace("__", "."), []).append(value)

        for k in range(MESSAGES):
            stamp = dict(header__stamp=17 + 1e-9 * k)
            joints = Cdr(big_endian).header(17, k, "base" * (k % 3)).number("I", 2).string("knee").string("hip")
            joints.numbers([k, -k]).numbers([0.5 * k, 3]).numbers([])
            add(1, k, joints, **stamp, position__knee=k, position__hip=-k, velocity__knee=0.5 * k, velocity__hip=3)
            add(2, k, Cdr(big_endian).header(17, k, "f").numbers([1, 2, k, 4, 5, 6], False), **stamp, wrench__force__x=1,
                wrench__force__y=2, wrench__force__z=k, wrench__torque__x=4, wrench__torque__y=5, wrench__torque__z=6)
            add(3, k, Cdr(big_endian).number("d", math.cos(k)), data=math.cos(k))
            array = Cdr(big_endian).number("I", 1).string("rows").number("I", 2).number("I", 2).number("I", 0).numbers([k, 0.1])
            add(4, k, array, layout__dim__0__size=2, layout__dim__0__stride=2, layout__data_offset=0, data__0=k, data__1=0.1)
            imu = Cdr(big_endian).header(17, k, "imu").numbers([0, 0, 0, 1] + [0] * 9 + [k] * 3 + [0] * 9 + [0, 0, 9.81] + [0] * 9,
                                                              False)
            add(5, k, imu)
            own = Cdr(big_endian).number("B", 3).number("d", 0.25 * k).string("m" * (k % 5))
            own.number("?", True).number("?", False).number("?", True).number("I", 1).number("f", 1.5).number("h", -k)
            own.number("q", 10 * k)
            add(6, k, own, mode=3, current=0.25 * k, limits__0=1, limits__1=0, limits__2=1, pairs__0__a=1.5, pairs__0__b=-k,
                ticks=10 * k)
        file.commit()
        file.close()
        return path

    def test_every_number_is_read_in_both_byte_orders(self):
        for big_endian in (False, True):
            with self.subTest(big_endian=big_endian):
                log = read_log(self.write(big_endian, definitions=True))
                self.assertEqual(log.format, "rosbag2")
                self.assertEqual(log.remarks, "")
                for topic in ("/joints", "/wrench", "/force", "/array", "/own"):
                    self.assert_numbers(log.tables[topic], self.expected[topic])
                imu = log.tables["/imu"]
                self.assertEqual(imu["linear_acceleration.z"], [9.81] * MESSAGES)
                self.assertEqual(imu["angular_velocity.x"], list(range(MESSAGES)))

    def test_a_type_without_a_definition_is_left_out_and_named(self):
        log = read_log(self.write())
        self.assertIn("/own is left out: messages of type lab_msgs/msg/Motor cannot be read", log.remarks)
        self.assert_numbers(log.tables["/joints"], self.expected["/joints"])

    def test_cuts_are_told(self):
        self.assert_cuts_are_told(self.write(definitions=True))

    def test_a_view_instead_of_a_table_is_refused(self):
        path = self.folder / "view.db3"
        file = sqlite3.connect(path)
        file.execute("CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT)")
        file.execute("CREATE VIEW messages AS WITH RECURSIVE endless(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM endless) "
                     "SELECT id, 1 AS topic_id, id AS timestamp, zeroblob(1000000) AS data FROM endless")
        file.commit()
        file.close()
        self.assertIn("without the tables", read_log(path).refusal)


if __name__ == "__main__":
    unittest.main()
