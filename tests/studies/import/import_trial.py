"""A trial of `capstan import`: logs with planted faults, in every format, and what the import says of them.

    CAPSTAN=build/capstan CAPSTAN_CONFIGS=configs python3 tests/studies/import/import_trial.py --logs 500 --seed 1

Each log is a simulated bench written in a laboratory's way by an independent writer, with no fault, one or two. A fault is
found if a finding of its kind names its channel, a clock's offset if that of one of its channels is found within 1 ms or one
sample. The clocks of all channels are counted apart, also those of which the stated range has the truth. Every finding that no
fault explains is a false one; every repair has to be one that was planted. Prints a table by kind of fault and by format.
"""

import argparse
import collections
import json
import math
import os
import pathlib
import random
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile

PROGRAM = os.environ["CAPSTAN"]
CONFIGS = pathlib.Path(os.environ["CAPSTAN_CONFIGS"])
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "logs"))

UNITS = {"angle": [("rad", 1.0), ("deg", math.pi / 180.0)], "torque": [("N m", 1.0), ("mN m", 1e-3)],
         "force": [("N", 1.0), ("g", 9.80665e-3)]}
TIME_UNITS = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6)]


def kind_of(channel):
    return "angle" if channel.endswith("angle") else "torque" if channel.endswith("torque") else "force"


class Bench:
    """One simulated recording: the truth that each log is made of."""

    def __init__(self, name, command, folder):
        self.name = name
        subprocess.run([PROGRAM, "simulate", *command, "-o", str(folder / (name + ".csv"))], check=True, capture_output=True)
        lines = (folder / (name + ".csv")).read_text().splitlines()
        self.sidecar = json.loads((folder / (name + ".json")).read_text())
        columns = lines[0].split(",")
        rows = [list(map(float, line.split(","))) for line in lines[1:]]
        rows = [row for row in rows if row[0] == 1]
        self.time = [row[1] for row in rows]
        self.channels = {column: [row[k] for row in rows] for k, column in enumerate(columns) if k > 1}
        self.rate = self.sidecar["sample_rate_hz"]

    def is_constant(self, channel):
        return max(self.channels[channel]) == min(self.channels[channel])


def benches(folder):
    noise = ["--sensor-noise", "0.001"]
    return [Bench("handle", [str(CONFIGS / "bench-viscous-slow.toml"), *noise], folder),
            Bench("fast", [str(CONFIGS / "bench-viscous-fast.toml"), "--sensors", "1", *noise], folder),
            Bench("ramps", [str(CONFIGS / "bench-ramps.toml"), *noise], folder),
            Bench("cable", [str(CONFIGS / "paper.toml"), "--recording", "--sensors", "2", *noise], folder)]


class PlantedLog:
    """A log before it is written: tables with times of their own, and the faults that were planted."""

    def __init__(self, bench, chance, several_clocks):
        self.bench = bench
        self.chance = chance
        self.faults = []        # (kind, channel or None, size)
        names = [name for name in bench.channels if not bench.is_constant(name) or name == "load_angle"]
        self.values = {name: list(bench.channels[name]) for name in names}
        self.time = list(bench.time)
        self.clock_of = {name: "a" for name in names}
        self.offset = {"a": 0.0, "b": 0.0}
        if several_clocks:
            for name in names:
                if name in ("load_torque", "load_angle") and not bench.is_constant(name):
                    self.clock_of[name] = "b"
        self.units = {name: ("rad" if kind_of(name) == "angle" else "N m" if kind_of(name) == "torque" else "N") for name in names}
        self.stated = {}
        self.time_unit = "s"
        self.stated_time_unit = None
        self.drop = set()       # rows left out
        self.twice = set()      # rows written twice
        self.jitter = None

    # Honest peculiarities of a laboratory: units of its own, stated in the head.
    def choose_units(self):
        for name in self.values:
            unit, si = self.chance.choice(UNITS[kind_of(name)])
            self.units[name] = unit
            self.values[name] = [value / si for value in self.values[name]]
        self.time_unit = self.chance.choice(TIME_UNITS)[0]

    def moving(self):
        return [name for name in self.values if not self.bench.is_constant(name)]

    def changing(self):
        still = [channel for kind, channel, _ in self.faults if kind == "constant channel"]
        return [name for name in self.moving() if name not in still]

    def other_clock(self):
        """The clock that is off. The import judges clocks beside that of the first angle that moves."""
        angles = [name for name in self.changing() if kind_of(name) == "angle"]
        return "a" if angles and self.clock_of[angles[0]] == "b" else "b"

    def plant(self, kind):
        rows = len(self.time)
        name = self.chance.choice(self.moving())
        if kind == "repeated samples":
            self.twice |= set(self.chance.sample(range(5, rows), max(3, rows // 100)))
            self.faults.append((kind, None, len(self.twice)))
        elif kind == "gap":
            at = self.chance.randrange(rows // 4, rows // 2)
            self.drop |= set(range(at, at + max(8, rows // 20)))
            self.faults.append((kind, None, 1))
        elif kind == "missing readings":
            # With one clock: single cells; else single rows.
            self.drop |= set(self.chance.sample(range(5, rows - 5), 5))
            self.faults.append((kind, None, 5))
        elif kind == "jitter":
            period = 1.0 / self.bench.rate
            self.jitter = [period * self.chance.uniform(-0.3, 0.3) for _ in self.time]
            self.faults.append((kind, None, 0))
        elif kind in ("clock offset", "clock offset of torque"):
            self.offset["b"] = self.chance.choice([-1, 1]) * self.chance.uniform(0.03, 0.4)
            self.faults.append((kind, "b", self.offset["b"]))
        elif kind == "wrapped counter":
            angles = [each for each in self.moving() if kind_of(each) == "angle"]
            name = self.chance.choice(angles)
            self.units[name] = "counts"
            counts = self.chance.choice([1024, 4096])
            low = min(self.bench.channels[name])
            high = max(self.bench.channels[name])
            # The turn begins in the middle of the motion.
            middle = 0.5 * (low + high)
            self.values[name] = [round((value - middle) / (2 * math.pi) * counts) % counts for value in self.bench.channels[name]]
            self.stated[name] = {"unit": "counts", "counts_per_turn": counts}
            self.faults.append((kind, name, counts))
        elif kind == "saturated":
            torques = [each for each in self.moving() if kind_of(each) != "angle"]
            name = self.chance.choice(torques)
            values = sorted(self.values[name])
            limit = values[int(0.85 * len(values))]
            self.values[name] = [min(value, limit) for value in self.values[name]]
            self.faults.append((kind, name, 0))
        elif kind == "constant channel":
            # Not on a clock of its own, which a channel that never changes would hide.
            free = [each for each in self.moving() if each not in self.driven() and self.clock_of[each] == "a"]
            name = self.chance.choice(free)
            self.values[name] = [0.25] * rows
            self.faults.append((kind, name, 0))
        elif kind == "wrong unit":
            name = self.chance.choice(self.moving())
            true, other = UNITS[kind_of(name)]
            self.stated[name] = {"unit": other[0] if self.units[name] == true[0] else true[0]}
            self.faults.append((kind, name, 0))
        elif kind == "wrong sign":
            name = self.chance.choice([each for each in self.moving() if kind_of(each) != "force"] or self.moving())
            self.values[name] = [-value for value in self.values[name]]
            self.faults.append((kind, name, 0))
        elif kind == "swapped channels":
            pairs = [pair for pair in (("motor_angle", "load_angle"), ("motor_torque", "load_torque")) if all(each in self.moving() for each in pair)]
            if not pairs:
                pairs = [("motor_torque", "motor_angle")]
            one, other = self.chance.choice(pairs)
            self.values[one], self.values[other] = self.values[other], self.values[one]
            self.units[one], self.units[other] = self.units[other], self.units[one]
            if kind_of(one) != kind_of(other):
                self.stated[one], self.stated[other] = {"unit": self.units[other]}, {"unit": self.units[one]}
            self.faults.append((kind, one, 0))
        elif kind == "time unit":
            self.stated_time_unit = {"s": "ms", "ms": "s", "us": "ms"}[self.time_unit]
            self.faults.append((kind, None, 0))

    def driven(self):
        return self.bench.sidecar["runs"][0]["driven"]

    def clock_rows(self, clock):
        """Times of a clock's rows, in seconds of its own clock, and the indices of the samples."""
        rows = []
        for k, time in enumerate(self.time):
            if k in self.drop:
                continue
            shown = time - self.offset[clock] + (self.jitter[k] if self.jitter else 0.0)
            rows.append((k, shown))
            if k in self.twice:
                rows.append((k, shown))
        return rows

    def tables(self):
        for clock in ("a", "b"):
            names = [name for name in self.values if self.clock_of[name] == clock]
            if names:
                yield clock, names, self.clock_rows(clock)


def write_text(log, path, chance):
    delimiter, comma = chance.choice([(",", False), (";", True), ("\t", False), (" ", False)])
    bracket = chance.choice(["{} [{}]", "{} ({})"])
    files = []
    for clock, names, rows in log.tables():
        file = path.with_name(f"{path.name}_{clock}.csv")
        unit = {"s": 1.0, "ms": 1e3, "us": 1e6}[log.time_unit]
        head = [bracket.format("Time", log.time_unit)] + [bracket.format(name, log.units[name]) for name in names]
        if delimiter == " ":
            head = ["Time"] + names
        lines = [chance.choice(["", "% ", "# "]) + delimiter.join(head)] if delimiter != " " else ["# " + " ".join(head)]
        for k, time in rows:
            cells = [f"{time * unit:.9g}"] + [f"{log.values[name][k]:.9g}" for name in names]
            lines.append(delimiter.join(cell.replace(".", ",") if comma else cell for cell in cells))
        file.write_text("\n".join(lines) + "\n")
        files.append((file, clock, head, names))
    return files


def columns(log, names):
    return ["time"] + names


def write_mat(log, path, _chance):
    import numpy
    import scipy.io
    unit = {"s": 1.0, "ms": 1e3, "us": 1e6}[log.time_unit]
    files = []
    for clock, names, rows in log.tables():
        file = path.with_name(f"{path.name}_{clock}.mat")
        data = {"time": numpy.array([time * unit for _, time in rows])}
        for name in names:
            data[name] = numpy.array([log.values[name][k] for k, _ in rows])
        scipy.io.savemat(file, data, do_compression=True)
        files.append((file, clock, columns(log, names), names))
    return files


def write_hdf5(log, path, _chance):
    import h5py
    import numpy
    unit = {"s": 1.0, "ms": 1e3, "us": 1e6}[log.time_unit]
    files = []
    for clock, names, rows in log.tables():
        file = path.with_name(f"{path.name}_{clock}.h5")
        with h5py.File(file, "w") as out:
            out["time"] = numpy.array([time * unit for _, time in rows])
            for name in names:
                out[name] = numpy.array([log.values[name][k] for k, _ in rows])
        files.append((file, clock, columns(log, names), names))
    return files


def write_xlsx(log, path, _chance):
    import openpyxl
    unit = {"s": 1.0, "ms": 1e3, "us": 1e6}[log.time_unit]
    files = []
    for clock, names, rows in log.tables():
        file = path.with_name(f"{path.name}_{clock}.xlsx")
        book = openpyxl.Workbook(write_only=True)
        sheet = book.create_sheet("log")
        sheet.append(["time"] + names)
        for k, time in rows:
            sheet.append([time * unit] + [log.values[name][k] for name in names])
        book.save(file)
        files.append((file, clock, columns(log, names), names))
    return files


START = 1_700_000_000


def write_bag(log, path, _chance):
    import genpy
    import rosbag
    from std_msgs.msg import Float64
    file = path.with_name(path.name + ".bag")
    messages = []
    for clock, names, rows in log.tables():
        for name in names:
            for k, time in rows:
                messages.append((time, name, log.values[name][k]))
    messages.sort(key=lambda each: each[0])
    with rosbag.Bag(str(file), "w", compression="lz4") as bag:
        for time, name, value in messages:
            complete = math.floor(time)
            bag.write("/" + name, Float64(value), genpy.Time(START + complete, round((time - complete) * 1e9)))
    return [(file, clock, ["log_time", "data"], names) for clock, names, _ in log.tables()]


def write_db3(log, path, _chance):
    file = path.with_name(path.name + ".db3")
    with sqlite3.connect(file) as out:
        out.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, offered_qos_profiles TEXT)")
        out.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)")
        messages = []
        topic = 0
        for clock, names, rows in log.tables():
            for name in names:
                topic += 1
                out.execute("INSERT INTO topics VALUES (?, ?, 'std_msgs/msg/Float64', 'cdr', '')", (topic, "/" + name))
                for k, time in rows:
                    messages.append((START * 10**9 + round(time * 1e9), topic, b"\0\1\0\0" + struct.pack("<d", log.values[name][k])))
        messages.sort(key=lambda each: each[0])
        out.executemany("INSERT INTO messages(timestamp, topic_id, data) VALUES (?, ?, ?)", messages)
    return [(file, clock, ["log_time", "data"], names) for clock, names, _ in log.tables()]


def write_mcap(log, path, _chance):
    """As JSON messages, uncompressed, by the specification."""
    file = path.with_name(path.name + ".mcap")

    def text(value):
        return struct.pack("<I", len(value)) + value.encode()

    def record(opcode, body):
        return struct.pack("<BQ", opcode, len(body)) + body

    out = bytearray(b"\x89MCAP0\r\n" + record(1, text("") + text("import trial")))
    channels = {}
    messages = []
    for clock, names, rows in log.tables():
        for name in names:
            channels[name] = len(channels) + 1
            out += record(4, struct.pack("<HH", channels[name], 0) + text("/" + name) + text("json") + struct.pack("<I", 0))
            for k, time in rows:
                messages.append((START * 10**9 + round(time * 1e9), channels[name], json.dumps({"data": log.values[name][k]}).encode()))
    messages.sort(key=lambda each: each[0])
    for sequence, (time, channel, data) in enumerate(messages):
        out += record(5, struct.pack("<HIQQ", channel, sequence, time, time) + data)
    out += record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + b"\x89MCAP0\r\n"
    file.write_bytes(out)
    return [(file, clock, ["log_time", "data"], names) for clock, names, _ in log.tables()]


WRITERS = {"text": write_text, "mat": write_mat, "hdf5": write_hdf5, "xlsx": write_xlsx, "bag": write_bag, "rosbag2": write_db3,
           "mcap": write_mcap}
LONGEST_OFFSET_S = 1.0  # a range so wide says nothing
BAGS = ("bag", "rosbag2", "mcap")
FAULTS = ("repeated samples", "gap", "missing readings", "jitter", "clock offset", "clock offset of torque", "wrapped counter", "saturated",
          "constant channel", "wrong unit", "wrong sign", "swapped channels", "time unit")


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(each)}" for key, each in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def mapping(log, files, style):
    """What a careful person would write who does not know of the faults."""
    lines = []
    if style not in BAGS:
        lines.append(f'time = {{ column = {json.dumps("Time" if style == "text" else "time")}, '
                     f'unit = "{log.stated_time_unit or log.time_unit}" }}')
    lines.append("[channels]")
    several = len({file for file, *_ in files}) > 1
    for file, clock, head, names in files:
        for index, name in enumerate(names):
            entry = {"unit": log.units[name]}
            entry.update(log.stated.get(name, {}))
            if style in BAGS:
                entry["table"] = "/" + name
                entry["column"] = "data"
            else:
                entry["column"] = name
            if several:
                entry["file"] = file.name
            lines.append(f"{name} = {toml(entry)}")
    lines.append("[recording]")
    sidecar = log.bench.sidecar
    for key in ("mode", "nominal", "tension_sensors"):
        if key in sidecar:
            lines.append(f"{key} = {toml(sidecar[key])}")
    lines.append("[[runs]]")
    if several:
        lines.append(f"files = {toml([file.name for file, *_ in files])}")
    run = sidecar["runs"][0]
    for key in ("T0", "output", "driven"):
        if key in run:
            lines.append(f"{key} = {toml(run[key])}")
    return "\n".join(lines) + "\n"


def is_doubt(finding):
    """A clock of which the log does not tell the offset; nothing is shifted."""
    return finding["what"] == "clock offset" and not finding["repaired"] and finding["amount"] == 0


def judge(log, report, text):
    """(found by fault, false findings, numbers of the faults of which the import says that it cannot tell, clocks).

    A clock is (number of the fault, channel, error of the offset, its stated uncertainty, whether nothing was shifted), of each
    channel with the wrong clock; where nothing is shifted, the stated range lies about 0, and where nothing is said, it is 0.
    """
    findings = report["findings"] if report else []
    found = []
    explained = set()
    names = lambda finding: finding["channel"]
    doubted = set()
    clocks = []
    other = log.other_clock()
    for kind, channel, size in log.faults:
        hit = False
        if kind.startswith("clock offset") and other == "a":
            size = -size
        for index, finding in enumerate(findings):
            if finding["what"] != kind.replace(" of torque", ""):
                continue
            if kind.startswith("clock offset"):
                if log.clock_of.get(names(finding)) != other:
                    continue
                explained.add(index)
                limit = max(1e-3, 1.0 / log.bench.rate)
                if is_doubt(finding):
                    doubted.add(len(found))
                    continue
                hit |= abs(finding["amount"] - size) <= limit
                continue
            if channel and kind not in ("swapped channels",) and names(finding) and names(finding) != channel:
                continue
            explained.add(index)
            hit = True
        if kind.startswith("clock offset"):
            said = {names(finding): finding for finding in findings if finding["what"] == "clock offset"}
            for each in (each for each in log.changing() if log.clock_of[each] == other):
                finding = said.get(each, {"amount": 0.0, "uncertainty": 0.0, "repaired": True})
                clocks.append((len(found), each, abs(finding["amount"] - size), finding["uncertainty"], each in said and is_doubt(finding)))
        if not report and kind in ("wrong unit", "wrong sign", "swapped channels", "constant channel", "time unit", "gap"):
            hit = any(word in text for word in ([channel] if channel else []) + [kind])
        found.append(hit)
    expected = {kind for kind, *_ in log.faults}
    # What follows from a planted fault: resampling after lost rows or at other clocks, a sign that a wrap hides.
    follows = {"assumed", "unread"}
    if expected & {"gap", "missing readings", "repeated samples", "clock offset", "clock offset of torque", "jitter"} or len(set(log.clock_of.values())) > 1:
        follows |= {"jitter"}
    if "gap" in expected or "missing readings" in expected:
        follows |= {"missing readings", "gap", "short stretch"}
    if "jitter" in expected:
        follows |= {"missing readings", "unordered times", "gap"}
    if "time unit" in expected:
        follows |= {"clock offset", "gap", "short stretch", "jitter"}
    false = [finding for index, finding in enumerate(findings)
             if index not in explained and finding["what"] not in follows and not is_doubt(finding)]
    return found, false, {fault for fault in doubted if not found[fault]}, clocks


def run(logs, seed, formats, out=sys.stdout, keep=None):
    chance = random.Random(seed)
    by_kind = collections.defaultdict(lambda: [0, 0, 0])
    by_format = collections.defaultdict(lambda: [0, 0, 0])
    false_findings = []
    missed = []
    offsets = []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        truth = benches(folder)
        for number in range(logs):
            style = formats[number % len(formats)]
            bench = chance.choice(truth)
            several = chance.random() < 0.5 or style in BAGS
            log = PlantedLog(bench, chance, several)
            log.choose_units()
            if style in BAGS:
                log.time_unit = "s"
            count = (0, 1, 1, 1, 2, 2)[number // len(formats) % 6]
            kinds = []
            for _ in range(count):
                possible = [kind for kind in FAULTS if kind not in kinds]
                late = [name for name in log.moving() if log.clock_of[name] == "b"]
                # A torque alone can lag for other reasons: its offset is not always determined.
                unseen = {"clock offset", "clock offset of torque"}
                if late:
                    unseen.remove("clock offset" if "load_angle" in late else "clock offset of torque")
                possible = [kind for kind in possible if kind not in unseen]
                if style in BAGS and "time unit" in possible:
                    possible.remove("time unit")
                if {"wrong unit", "wrong sign", "swapped channels", "wrapped counter", "constant channel", "saturated"} & set(kinds):
                    # Two faults of the numbers of one channel can undo one another.
                    possible = [kind for kind in possible if kind in ("repeated samples", "gap", "missing readings", "jitter", "clock offset", "clock offset of torque")]
                if kinds == ["time unit"]:
                    possible = [kind for kind in possible if not kind.startswith("clock")]
                if kinds and kinds[0].startswith("clock"):
                    possible.remove("time unit") if "time unit" in possible else None
                kinds.append(chance.choice(possible))
                log.plant(kinds[-1])
            place = folder / f"log{number}"
            place.mkdir()
            files = WRITERS[style](log, place / "log", chance)
            (place / "import.toml").write_text(mapping(log, files, style))
            names = list(dict.fromkeys(str(file) for file, *_ in files))
            done = subprocess.run([PROGRAM, "import", *names, "--mapping", str(place / "import.toml"), "--try", "--json",
                                   "--progress", "none"], capture_output=True, text=True)
            report = json.loads(done.stdout) if done.returncode == 0 else None
            found, false, doubted, clocks = judge(log, report, done.stderr)
            offsets += [(number, bench, channel, log.faults[fault][2], error, uncertainty, unknown) for fault, channel, error, uncertainty, unknown in clocks]
            for number_of_fault, ((kind, channel, size), hit) in enumerate(zip(log.faults, found)):
                by_kind[kind][0] += 1
                by_kind[kind][1] += hit
                by_kind[kind][2] += number_of_fault in doubted
                if not hit:
                    missed.append((number, style, bench.name, kind, channel, size, done.stderr.strip()[:300]))
            by_format[style][0] += 1
            by_format[style][1] += len(found)
            by_format[style][2] += sum(found)
            if not log.faults and report is None:
                missed.append((number, style, bench.name, "no fault", None, 0, done.stderr.strip()[:300]))
            for finding in false:
                false_findings.append((number, style, bench.name, kinds, finding["what"], finding["repaired"], finding["words"][:200]))
            if keep and (not all(found) or false or (not log.faults and report is None)):
                shutil.copytree(place, pathlib.Path(keep) / f"log{number}", dirs_exist_ok=True)
            shutil.rmtree(place)
    print("fault                    planted  found           said to be unknown", file=out)
    for kind in FAULTS:
        planted, hit, doubted = by_kind[kind]
        if planted:
            print(f"{kind:23} {planted:8} {hit:6}  {hit / planted:6.1%} {doubted or '':>10}", file=out)
    print("clocks of                channels  within 1 ms or a sample  or in the stated range  said to be unknown", file=out)
    for kind in ("angle", "torque"):
        of_kind = [each for each in offsets if kind_of(each[2]) == kind]
        within = [error <= max(1e-3, 1.0 / bench.rate) for _, bench, _, _, error, _, _ in of_kind]
        covered = [hit or error <= uncertainty < LONGEST_OFFSET_S for hit, (_, _, _, _, error, uncertainty, _) in zip(within, of_kind)]
        print(f"{kind:24} {len(of_kind):8} {sum(within):24} {sum(covered):23} {sum(each[-1] for each in of_kind):19}", file=out)
    print("format    logs  faults  found", file=out)
    for style, (count, planted, hit) in by_format.items():
        print(f"{style:8} {count:5} {planted:7} {hit:6}", file=out)
    print(f"findings that no fault explains: {len(false_findings)}", file=out)
    return by_kind, false_findings, missed, offsets


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--logs", type=int, default=500)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--formats", nargs="*", default=list(WRITERS))
    options.add_argument("--keep", help="a folder for the logs that were not judged right")
    options.add_argument("--verbose", action="store_true")
    given = options.parse_args()
    _, false, missed, offsets = run(given.logs, given.seed, given.formats, keep=given.keep)
    if given.verbose:
        for each in missed:
            print("missed:", *each)
        for each in false:
            print("false:", *each)
        for number, bench, channel, size, error, uncertainty, unknown in offsets:
            print(f"clock: log {number}, {bench.name}, {channel}: offset {1e3 * size:.2f} ms, error {1e3 * error:.3f} ms ({error * bench.rate:.2f} samples), "
                  f"stated to {1e3 * uncertainty:.3f} ms{', not shifted' if unknown else ''}")


if __name__ == "__main__":
    main()
