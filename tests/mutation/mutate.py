#!/usr/bin/env python3
"""Would the tests notice? Changes one thing in a room's sources at a time, as clang's syntax tree shows them, and runs a test:

    tests/mutation/mutate.py storage test_storage                 50 mutants, drawn by --seed, in a copy of the tree
    tests/mutation/mutate.py engine/solver test_solver --count 0  all of them
    tests/mutation/mutate.py storage test_storage --resume        goes on with what is in build-mutants/storage.jsonl

A mutant is killed when it does not compile, when the test fails, or when it takes ten times as long. Prints the score and
every survivor with its line."""

import argparse
import json
import pathlib
import random
import re
import shlex
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
OPERATORS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&", "+": "-", "-": "+",
             "*": "/", "/": "*", "+=": "-=", "-=": "+="}


def copy_of_sources(folder):
    """A tree that may be changed, with a build of its own in which each source is compiled by itself."""
    if not (folder / "CMakeLists.txt").exists():
        folder.mkdir(parents=True, exist_ok=True)
        archive = subprocess.run(["git", "-C", SOURCE, "archive", "HEAD"], check=True, capture_output=True).stdout
        subprocess.run(["tar", "-x", "-C", folder], input=archive, check=True)
    if not (folder / "build/build.ninja").exists():
        subprocess.run(["cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCAPSTAN_TESTS=ON",
                        "-DCAPSTAN_UNITY=OFF", "-DCAPSTAN_PRECOMPILE=OFF"], check=True, stdout=subprocess.DEVNULL)


def compile_command(tree, path):
    for entry in json.loads((tree / "build/compile_commands.json").read_text()):
        if entry["file"] == str(path):
            return [word for word in shlex.split(entry["command"]) if "ccache" not in word and "=pch_defines" not in word]
    return None


def syntax_tree(tree, path):
    """The nodes that stand in the file itself, each with its kind and offsets; clang names a file only where it changes."""
    words = compile_command(tree, path)
    compiler = next(k for k, word in enumerate(words) if re.search(r"(c\+\+|g\+\+)[-0-9]*$", word))
    flags = [word for word in words[compiler + 1:] if word.startswith(("-I", "-D", "-std", "-isystem")) or words[words.index(word) - 1] == "-isystem"]
    namespace = re.search(r"^namespace ([\w:]+) \{", path.read_text(), re.MULTILINE)
    dumped = subprocess.run(["clang++", *flags, "-fsyntax-only", "-w", "-Xclang", "-ast-dump=json", "-Xclang",
                             f"-ast-dump-filter={namespace.group(1) if namespace else ''}", str(path)],
                            capture_output=True, text=True, cwd=tree / "build", check=False).stdout
    decoder, at, nodes, here = json.JSONDecoder(), 0, [], [None]

    def locate(place):
        if "file" in place:
            here[0] = place["file"]
        for inner in ("spellingLoc", "expansionLoc"):
            if inner in place:
                locate(place[inner])

    def walk(node, depth):
        if not isinstance(node, dict):
            return
        locate(node.get("loc", {}))
        begin, end = node.get("range", {}).get("begin", {}), node.get("range", {}).get("end", {})
        locate(begin)
        in_file = here[0] == str(path)
        locate(end)
        if in_file and "offset" in begin and "offset" in end:
            nodes.append(node)
        for inner in node.get("inner", ()):
            walk(inner, depth + 1)

    sys.setrecursionlimit(100000)
    while True:
        at = dumped.find("{", at)
        if at < 0:
            return nodes
        here[0] = None
        node, at = decoder.raw_decode(dumped, at)
        walk(node, 0)


def end_of(node):
    return node["range"]["end"]["offset"] + node["range"]["end"].get("tokLen", 0)


def mutants_of(tree, path):
    """(offset, length, text in its place) of each."""
    text = path.read_bytes().decode()
    found = set()
    for node in syntax_tree(tree, path):
        begin, kind, inner = node["range"]["begin"]["offset"], node["kind"], node.get("inner", [])
        if kind in ("BinaryOperator", "CompoundAssignOperator") and node.get("opcode") in OPERATORS and len(inner) == 2:
            left, right = inner[0].get("range", {}), inner[1].get("range", {})
            if "offset" not in left.get("end", {}) or "offset" not in right.get("begin", {}):
                continue
            between = left["end"]["offset"] + left["end"].get("tokLen", 0), right["begin"]["offset"]
            gap = text[between[0]:between[1]]
            if gap.strip() == node["opcode"]:
                found.add((between[0] + gap.index(node["opcode"]), len(node["opcode"]), OPERATORS[node["opcode"]]))
        elif kind == "UnaryOperator" and node.get("opcode") == "!" and text[begin] == "!":
            found.add((begin, 1, ""))
        elif kind == "CXXBoolLiteralExpr" and text[begin:end_of(node)] in ("true", "false"):
            found.add((begin, end_of(node) - begin, "false" if text[begin] == "t" else "true"))
        elif kind == "IntegerLiteral" and text[begin:end_of(node)].isdigit():
            found.add((begin, end_of(node) - begin, str(int(text[begin:end_of(node)]) + 1)))
        elif kind == "CompoundStmt":
            for statement in inner:  # a call for its effect is left out
                if statement.get("kind") in ("CallExpr", "CXXMemberCallExpr", "ExprWithCleanups", "CXXOperatorCallExpr"):
                    first, last = statement.get("range", {}).get("begin", {}).get("offset"), statement.get("range", {}).get("end", {})
                    if first is not None and "offset" in last:
                        found.add((first, last["offset"] + last.get("tokLen", 0) - first, ""))
    return sorted(found)


def run(command, limit_s):
    try:
        return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=limit_s, check=False).returncode
    except subprocess.TimeoutExpired:
        return "late"


class Room:
    def __init__(self, asked):
        self.tree, self.asked = asked.tree, asked
        self.kept = asked.tree.parent / f"{asked.tree.name}-{asked.room.replace('/', '-')}.jsonl"
        copy_of_sources(self.tree)
        self.build = ["ninja", "-C", str(self.tree / "build"), "-j2", asked.test]
        subprocess.run(self.build, check=True, stdout=subprocess.DEVNULL)
        self.program = next(path for path in (self.tree / "build/tests").rglob(asked.test) if path.is_file())
        begun = time.monotonic()
        if run([str(self.program), *asked.arguments], 3600) != 0:
            sys.exit(f"{self.program} fails without any mutant")
        self.usual_s = time.monotonic() - begun

    def all_mutants(self):
        for path in sorted((self.tree / self.asked.room).rglob("*.cpp")):
            if compile_command(self.tree, path):
                for mutant in mutants_of(self.tree, path):
                    yield path, mutant

    def judge(self, path, mutant):
        offset, length, replacement = mutant
        right = path.read_bytes().decode()
        try:
            path.write_bytes((right[:offset] + replacement + right[offset + length:]).encode())
            built = run(self.build, 600)
            if built != 0:
                return "does not compile"
            ended = run([str(self.program), *self.asked.arguments], 10 * self.usual_s + 10)
            return "survived" if ended == 0 else "late" if ended == "late" else "failed"
        finally:
            path.write_bytes(right.encode())

    def run(self):
        mutants = list(self.all_mutants())
        random.Random(self.asked.seed).shuffle(mutants)
        chosen = mutants[:self.asked.count] if self.asked.count else mutants
        done = [json.loads(line) for line in self.kept.read_text().splitlines()] if self.asked.resume and self.kept.exists() else []
        known = {(row["file"], row["offset"], row["becomes"]) for row in done}
        end = time.monotonic() + 60 * self.asked.minutes
        with open(self.kept, "a" if done else "w") as kept:
            for path, (offset, length, becomes) in chosen:
                name = str(path.relative_to(self.tree))
                if (name, offset, becomes) in known:
                    continue
                if time.monotonic() > end:
                    break
                text = path.read_bytes().decode()
                row = {"file": name, "line": text.count("\n", 0, offset) + 1, "offset": offset, "was": text[offset:offset + length],
                       "becomes": becomes, "end": self.judge(path, (offset, length, becomes))}
                kept.write(json.dumps(row) + "\n")
                kept.flush()
                done.append(row)
        subprocess.run(self.build, check=False, stdout=subprocess.DEVNULL)
        return done, len(mutants)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("room")
    parser.add_argument("test", help="a target of the build")
    parser.add_argument("arguments", nargs="*", help="of the test")
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=480.0)
    parser.add_argument("--tree", type=pathlib.Path, default=SOURCE / "build-mutants", help="the copy that is changed")
    parser.add_argument("--resume", action="store_true")
    room = Room(parser.parse_args())
    rows, total = room.run()
    real = [row for row in rows if row["end"] != "does not compile"]
    survivors = [row for row in real if row["end"] == "survived"]
    for row in survivors:
        print(f"{row['file']}:{row['line']}: '{row['was']}' -> '{row['becomes']}'")
    print(f"{room.asked.room}: {len(rows)} of {total} mutants, {len(rows) - len(real)} did not compile; "
          f"{len(real) - len(survivors)} of {len(real)} killed ({100.0 * (len(real) - len(survivors)) / max(len(real), 1):.1f}%)")
