#!/usr/bin/env python3
"""Would the tests notice? Changes one thing in a room's sources at a time, as clang's syntax tree shows them, and runs the tests:

    tests/mutation/mutate.py engine/estimation                 its mutants, with the test programs of ROOMS below
    tests/mutation/mutate.py storage test_storage --count 100  a hundred of them, drawn by --seed, with one test program
    tests/mutation/mutate.py storage --resume                  goes on with what is in build-mutants/storage.jsonl
    tests/mutation/mutate.py storage --again --filter 'New.*'  runs new tests on those that had survived

A copy of the tree is built once with all mutants in, and a variable of the environment chooses one (schemata.py). First each
test is run to see which mutants it reaches; then for each mutant the tests that reach it are run, the fastest first, until one
fails. A mutant is killed when a test fails, crashes or takes far longer. What the compiler has to see as a constant needs a
build of its own: of those mutants some are drawn. Prints each survivor that survivors.md does not explain, and the score."""

import argparse
import collections
import concurrent.futures
import fnmatch
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

import schemata

SOURCE = pathlib.Path(__file__).resolve().parents[2]
ROOMS = {"engine/estimation": ["test_estimation", "test_ensemble", "test_controller"],
         "engine/solver": ["test_solver", "test_reference", "test_ensemble"],
         "storage": ["test_storage", "test_reports", "test_placement"]}
NOT_RUN = ["Speed.*"]  # its time limit is for a build without mutants
# As in the coverage preset one SIMD width; the library's assertions notice what reads beyond a vector or a span.
FLAGS = "-O1 -w -mssse3 -DNDEBUG -DHWY_COMPILE_ONLY_STATIC -D_GLIBCXX_ASSERTIONS"
SURVIVED = ("survived", "not reached")
ERROR = re.compile(r"^(\S+?):(\d+):\d+: (?:fatal )?error")
USE = re.compile(r"^(\S+?):(\d+):\d+:\s+required from")  # of what mutants.h cannot do


def run(command, environment, cpu_s):
    """How it ended and what time of a processor it took."""
    with tempfile.TemporaryDirectory(prefix="capstan-mutant-", ignore_cleanup_errors=True) as scratch:
        process = subprocess.Popen(["prlimit", f"--cpu={int(cpu_s) + 1}", f"--as={8 << 30}", *command], process_group=0,
                                   env=os.environ | environment | {"TMPDIR": scratch}, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        stop = threading.Timer(10 * cpu_s + 60, os.killpg, (process.pid, signal.SIGKILL))  # whoever waits for ever
        stop.start()
        _, status, usage = os.wait4(process.pid, 0)
        stop.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        try:
            os.killpg(process.pid, signal.SIGKILL)  # children of a test that crashed
        except ProcessLookupError:
            pass
        for mounted in re.findall(rf" ({scratch}\S*) ", pathlib.Path("/proc/mounts").read_text()):  # by a test that crashed
            subprocess.run(["umount", "--lazy", mounted], check=False)
    return process.returncode, usage.ru_utime + usage.ru_stime


class Tree:
    """A copy of the sources with a build of its own, in which the room's files have all mutants in."""

    def __init__(self, folder, room, targets):
        self.folder, self.room, self.targets = folder / room.replace("/", "-"), room, targets
        self.kept = self.folder / "mutants.json"
        self.copy()
        if not (self.folder / "build/build.ninja").exists():
            subprocess.run(["cmake", "-S", self.folder, "-B", self.folder / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
                            "-DCAPSTAN_TESTS=ON", f"-DCMAKE_CXX_FLAGS_DEBUG={FLAGS} -I{self.folder}/mutants"], check=True,
                           stdout=subprocess.DEVNULL)
        self.texts = {}
        self.mutants, self.alone = self.find()
        self.write()

    def copy(self):
        """What git knows of the tree, where it differs; of the room itself the files are written later."""
        listed = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z", "--cached", "--others", "--exclude-standard"], check=True,
                                capture_output=True, text=True).stdout
        for name in filter(None, listed.split("\0")):
            if (SOURCE / name).is_file() and not (self.has_mutants(name) and (self.folder / name).exists()):
                self.put(name, (SOURCE / name).read_bytes())
        # Each source of the room by itself: a mutant that needs a build is built sooner, an error names its line.
        name = self.room.rpartition("/")[2]
        top = (SOURCE / "CMakeLists.txt").read_text()
        self.put("CMakeLists.txt", (top + f"set_target_properties(capstan_{name} PROPERTIES UNITY_BUILD OFF)\n").encode())
        self.put("mutants/capstan_mutants.h", (SOURCE / "tests/mutation/mutants.h").read_bytes())

    def has_mutants(self, name):
        return name == "CMakeLists.txt" or name.startswith(f"{self.room}/") and name.endswith((".h", ".cpp"))

    def put(self, name, content):
        path = self.folder / name
        if not path.exists() or path.read_bytes() != content:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
            if os.access(SOURCE / name, os.X_OK):
                path.chmod(0o755)

    def text(self, name):
        if name not in self.texts:
            self.texts[name] = (SOURCE / name).read_bytes().decode("latin-1")
        return self.texts[name]

    def find(self):
        """Those that can be chosen at run time, as far as is known, and the others."""
        files = [str(path.relative_to(SOURCE)) for path in sorted((SOURCE / self.room).rglob("*")) if path.suffix in (".h", ".cpp")]
        sources = [[name, self.text(name)] for name in files]
        kept = json.loads(self.kept.read_text()) if self.kept.exists() else {}
        if kept.get("sources") == sources:
            return [[schemata.Mutant(*each) for each in kept[group]] for group in ("mutants", "alone")]
        for name, text in sources:
            self.put(name, text.encode("latin-1"))
        subprocess.run(["cmake", self.folder / "build"], check=True, stdout=subprocess.DEVNULL)
        commands = {entry["file"]: entry["command"] for entry in json.loads((self.folder / "build/compile_commands.json").read_text())
                    if entry["file"].startswith(f"{self.folder}/{self.room}/")}
        found, seen = schemata.mutants_of(self.folder, self.room, commands)
        for name in set(files) - seen:
            print(f"{name}: not seen by clang, no mutants")
        mutants, alone = [m for m in found if not m.constant], [m for m in found if m.constant]
        self.write(mutants)
        return mutants, alone

    def write(self, mutants=None):
        mutants = self.mutants if mutants is None else mutants
        by_file = collections.defaultdict(list)
        for number, mutant in enumerate(mutants, 1):
            by_file[mutant.file].append((number, mutant))
        for name in by_file.keys() | {m.file for m in getattr(self, "alone", [])}:
            self.put(name, schemata.with_schemata(self.text(name), by_file[name]).encode("latin-1"))

    def ninja(self, *words):
        return subprocess.run(["ninja", "-C", self.folder / "build", "-j2", *words], capture_output=True, text=True, check=False)

    def build(self):
        """Takes out what does not compile with its number, by the lines of the errors, until all does."""
        while (built := self.ninja("-k0", *self.targets)).returncode != 0:
            bad = self.blamed(built.stdout)
            if not bad:
                sys.exit(built.stdout[-5000:])
            print(f"{len(bad)} mutants at lines with errors need a build of their own", flush=True)
            self.alone += sorted(bad)
            self.mutants = [m for m in self.mutants if m not in bad]
            self.write()
        sources = [[str(path.relative_to(SOURCE)), self.text(str(path.relative_to(SOURCE)))]
                   for path in sorted((SOURCE / self.room).rglob("*")) if path.suffix in (".h", ".cpp")]
        self.kept.write_text(json.dumps({"sources": sources, "mutants": [list(vars(m).values()) for m in self.mutants],
                                         "alone": [list(vars(m).values()) for m in self.alone]}))

    def blamed(self, errors):
        """The mutants at lines with errors; of what is wrong in a template, those of the innermost line that uses it."""
        bad, looking = set(), False
        for line in errors.splitlines():
            if "In instantiation of" in line:
                looking = True
            elif (use := USE.match(line)) and looking and (here := self.at_line(*use.groups())):
                bad |= here
                looking = False
            elif error := ERROR.match(line):
                bad |= self.at_line(*error.groups())
        return bad

    def at_line(self, path, line):
        """The mutants of a line; of one that has none, those of the shortest expression around it."""
        resolved = (self.folder / "build" / path).resolve()
        name = str(resolved.relative_to(self.folder)) if resolved.is_relative_to(self.folder) else ""
        here = [(m, *m.lines(self.text(name)), m.line(self.text(name))) for m in self.mutants if m.file == name]
        line = int(line)
        exact = {m for m, first, _, at in here if line in (first, at)}
        around = [(last - first, m) for m, first, last, _ in here if first <= line <= last]
        return exact or {m for width, m in around if width == min(around)[0]}

    def program(self, target):
        return next(path for path in (self.folder / "build/tests").rglob(target) if path.is_file())


class Tests:
    """Those of a test program: how long each takes, and which mutants it reaches."""

    def __init__(self, tree, target, asked, pool):
        self.target, self.program = target, str(tree.program(target))
        listed = subprocess.run([self.program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
        names, suite = [], ""
        for line in (line.partition("#")[0].rstrip() for line in listed.splitlines()):
            if line and not line.startswith(" "):
                suite = line
            elif line:
                names.append(suite + line.strip())
        names = [name for name in names if not any(fnmatch.fnmatch(name, pattern) for pattern in NOT_RUN)
                 and any(fnmatch.fnmatch(name, pattern) for pattern in asked.filter.split(":"))]
        self.of = {}
        for name, (ended, seconds, reached) in zip(names, pool.map(lambda name: self.record(name, len(tree.mutants)), names)):
            if ended != 0 or seconds > asked.longest_s:
                print(f"{target}: {name} is left out: {'fails without any mutant' if ended else f'takes {seconds:.0f} s'}", flush=True)
            else:
                self.of[name] = (seconds, reached)

    def record(self, name, count):
        with tempfile.NamedTemporaryFile() as file:
            file.write(bytes(count + 1))
            file.flush()
            ended, seconds = run([self.program, f"--gtest_filter={name}"], {"CAPSTAN_MUTANTS_REACHED": file.name}, 600)
            return ended, seconds, pathlib.Path(file.name).read_bytes()

    def groups(self, number):
        """The tests that reach a mutant, all of them if it has no number: the fastest first, each group longer than the one before."""
        tests = sorted((seconds, name) for name, (seconds, reached) in self.of.items() if number is None or reached[number])
        group, limit = [], 0.1
        for seconds, name in tests:
            if group and sum(s for s, _ in group) + seconds > limit:
                yield group
                group, limit = [], 3 * limit
            group.append((seconds, name))
        if group:
            yield group

    def fails(self, number):
        """In what way, if at all; None where no test fails."""
        for group in self.groups(number):
            ended, _ = run([self.program, "--gtest_fail_fast", "--gtest_filter=" + ":".join(name for _, name in group)],
                           {} if number is None else {"CAPSTAN_MUTANT": str(number)}, 2 + 5 * sum(seconds for seconds, _ in group))
            if ended != 0:
                return "late" if ended in (-signal.SIGXCPU, -signal.SIGKILL) else "crashed" if ended < 0 else "failed"
        return None

    def reach(self, number):
        return any(reached[number] for _, reached in self.of.values())


class Judge:
    def __init__(self, asked):
        self.asked = asked
        self.tree = Tree(asked.tree, asked.room, asked.tests or ROOMS[asked.room])
        self.kept = self.tree.folder.with_suffix(".jsonl")
        kept = self.kept.read_text() if (asked.resume or asked.again) and self.kept.exists() else ""
        rows = [json.loads(line) for line in kept.splitlines()]
        self.survived = {tuple(row["key"]): row for row in rows if asked.again and row["end"] in SURVIVED}
        self.done = {tuple(row["key"]): row for row in rows if tuple(row["key"]) not in self.survived}

    def keys(self):
        """Of each mutant what it is known by: file, line before and after, and which of those that are the same."""
        met = collections.Counter()
        for number, mutant in [*enumerate(self.tree.mutants, 1), *((None, m) for m in self.tree.alone)]:
            change = (mutant.file, *mutant.change(self.tree.text(mutant.file)))
            met[change] += 1
            yield (*change, met[change]), number, mutant

    def judged(self, number, programs):
        if not any(tests.reach(number) for tests in programs):
            return {"end": "not reached"}
        for tests in programs:
            if how := tests.fails(number):
                return {"end": how, "by": tests.target}
        return {"end": "survived"}

    def judged_alone(self, mutant, programs):
        name = mutant.file
        try:
            self.tree.put(name, mutant.alone(self.tree.text(name)).encode("latin-1"))
            for tests in programs:
                if self.tree.ninja(tests.target).returncode != 0:
                    return {"end": "does not compile"}
                if how := tests.fails(None):
                    return {"end": how, "by": tests.target}
            return {"end": "survived"}
        finally:
            self.tree.write()

    def kept_rows(self):
        rows = [json.loads(line) for line in self.kept.read_text().splitlines()]
        return rows, len(rows)

    def run(self):
        self.tree.build()
        with concurrent.futures.ThreadPoolExecutor(self.asked.jobs) as pool:
            programs = [Tests(self.tree, target, self.asked, pool) for target in self.tree.targets]
            keyed = list(self.keys())
            single = [key for key, number, _ in keyed if number is None]
            wanted = {key for key, number, _ in keyed if number is not None}
            wanted |= set(random.Random(self.asked.seed).sample(single, min(self.asked.builds, len(single))))
            if self.asked.count:
                wanted = set(random.Random(self.asked.seed).sample(sorted(wanted), min(self.asked.count, len(wanted))))
            todo = [(key, number, mutant) for key, number, mutant in keyed if key in wanted and key not in self.done]
            with open(self.kept, "w") as kept:
                def keep(key, mutant, result):
                    row = {**result, "key": key, "line": mutant.line(self.tree.text(mutant.file))}
                    self.done[key] = row
                    kept.write(json.dumps(row) + "\n")
                    kept.flush()
                for row in self.done.values():
                    kept.write(json.dumps(row) + "\n")
                by_number = [(key, number, mutant) for key, number, mutant in todo if number is not None]
                for (key, _, mutant), result in zip(by_number, pool.map(lambda each: self.judged(each[1], programs), by_number)):
                    keep(key, mutant, self.survived.get(key, result) if result["end"] in SURVIVED else result)
                for key, number, mutant in todo:
                    if number is None:
                        keep(key, mutant, self.judged_alone(mutant, programs))
        return [self.done[key] for key, *_ in keyed if key in self.done], len(keyed)


def explanations():
    """What survivors.md explains: patterns of a file, a line before and the line after, in which [...] stands for any text."""
    text = pathlib.Path(__file__).with_name("survivors.md").read_text()
    return [[re.compile(re.escape(part).replace(r"\[\.\.\.\]", ".*")) for part in line]
            for line in re.findall(r"^- `(.*?)`: `(.*?)` becomes `(.*?)`", text, re.MULTILINE)]


def report(room, rows, total):
    built = [row for row in rows if row["end"] != "does not compile"]
    survivors = [row for row in built if row["end"] in SURVIVED]
    known = explanations()
    unexplained = [row for row in survivors
                   if not any(all(part.fullmatch(text) for part, text in zip(line, row["key"])) for line in known)]
    for row in unexplained:
        file, before, after, _ = row["key"]
        print(f"{file}:{row['line']}: `{before}` becomes `{after}`{' (not reached)' if row['end'] == 'not reached' else ''}")
    killed = len(built) - len(survivors)
    by = collections.Counter(row["by"] for row in built if "by" in row)
    print(f"{room}: {len(rows)} of {total} mutants, {len(rows) - len(built)} did not compile; {killed} of {len(built)} killed "
          f"({100.0 * killed / max(len(built), 1):.1f}%; {', '.join(f'{name} {count}' for name, count in by.most_common())}); "
          f"{len(survivors)} survived, {len(survivors) - len(unexplained)} of them explained in survivors.md, {len(unexplained)} not")
    return unexplained


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("room")
    parser.add_argument("tests", nargs="*", help="targets of the build, those of ROOMS unless told")
    parser.add_argument("--count", type=int, default=0, help="0: all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--builds", type=int, default=20, help="so many of those that need a build of their own, drawn by --seed")
    parser.add_argument("--jobs", type=int, default=2, help="mutants at a time")
    parser.add_argument("--longest-s", type=float, default=10.0, help="a test that takes longer is left out")
    parser.add_argument("--filter", default="*", help="only the tests of such names, as for --gtest_filter")
    parser.add_argument("--tree", type=pathlib.Path, default=SOURCE / "build-mutants", help="where the copies are")
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--report", action="store_true", help="of what is kept, without running anything")
    chosen = parser.parse_args()
    sys.exit(1 if report(chosen.room, *(Judge(chosen).kept_rows() if chosen.report else Judge(chosen).run())) else 0)
