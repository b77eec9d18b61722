"""The mutants of a room's sources, and the sources with all of them in, each chosen at run time by its number (mutants.h).

An operator becomes its neighbour (< and <=, == and !=, && and ||, + and -, * and /, += and -=), a `!` is left out, true becomes
false, an integer one more, a call for its effect is left out; and a function of Highway becomes its neighbour. What has to be
a constant to the compiler cannot be chosen at run time: it is a mutant that needs a build of its own."""

import dataclasses
import json
import re
import shlex
import subprocess
import sys

NAMES = {"<": "less", "<=": "less_or_equal", ">": "greater", ">=": "greater_or_equal", "==": "equal", "!=": "unequal", "+": "plus",
         "-": "minus", "*": "times", "/": "divided", "+=": "add_to", "-=": "subtract_from"}
OPERATORS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&", "+": "-", "-": "+",
             "*": "/", "/": "*", "+=": "-=", "-=": "+="}
FUNCTIONS = {"Add": "Sub", "Sub": "Add", "Mul": "Div", "Div": "Mul", "Lt": "Le", "Le": "Lt", "Gt": "Ge", "Ge": "Gt", "Eq": "Ne", "Ne": "Eq",
             "And": "Or", "Or": "And", "Min": "Max", "Max": "Min"}
CALLS = ("CallExpr", "CXXMemberCallExpr", "ExprWithCleanups", "CXXOperatorCallExpr")


@dataclasses.dataclass(frozen=True, order=True)
class Mutant:
    """Of a file of the tree: what stands at `at` becomes something else; `begin` to `end` is the expression that it is in."""
    file: str
    at: int
    was: str
    becomes: str
    begin: int
    end: int
    kind: str
    constant: bool  # to the compiler

    def lines(self, text):
        """Of the expression: its first and last."""
        return text.count("\n", 0, self.begin) + 1, text.count("\n", 0, self.end) + 1

    def line(self, text):
        return text.count("\n", 0, self.at) + 1

    def change(self, text):
        """The line before and after, by which a mutant is known wherever the line has gone."""
        first = text.rfind("\n", 0, self.at) + 1
        last = text.find("\n", self.at)
        rest = text[self.at + len(self.was):last] if self.at + len(self.was) <= last else ""
        return text[first:last].strip(), (text[first:self.at] + self.becomes + rest).strip()

    def alone(self, text):
        return text[:self.at] + self.becomes + text[self.at + len(self.was):]

    def edits(self, number):
        """Its text where the number chooses: (place, characters left out, text put in, whether it closes a bracket)."""
        name = f"capstan_mutants::{NAMES.get(self.was)}<{number}>("
        active = f"(capstan_mutants::active({number})"
        if self.kind == "logical":
            return [(self.begin, 0, f"{active} != ({active} != bool(", False), (self.at, 2, f")) {self.was} {active} != bool(", False),
                    (self.end, 0, "))))", True)]
        if self.kind == "operator":
            return [(self.begin, 0, name, False), (self.at, len(self.was), ", ", False), (self.end, 0, ")", True)]
        if self.kind == "call":
            return [(self.begin, 0, f"{active} ? void() : void(", False), (self.end, 0, "))", True)]
        if self.kind == "function":
            both = ", ".join(f"[](auto... x) __attribute__((always_inline)) {{ return {name}(x...); }}"
                             for name in (self.becomes, self.was))
            return [(self.at, len(self.was) + 1, f"capstan_mutants::call<{number}>({both}, ", False)]
        name = f"capstan_mutants::{self.kind}<{number}>("
        return [(self.begin, 1 if self.kind == "negated" else 0, name, False), (self.end, 0, ")", True)]


def with_schemata(text, numbered):
    """The text in which each of the (number, mutant) can be chosen; of those that begin or end together the inner is inside."""
    edits = []
    for number, mutant in numbered:
        for at, length, inserted, closes in mutant.edits(number):
            width = mutant.end - mutant.begin
            edits.append(((at, not closes, width if closes else -width, number if not closes else -number), length, inserted))
    parts, done = [], 0
    for (at, *_), length, inserted in sorted(edits):
        parts += [text[done:at], inserted]
        done = max(done, at + length)
    return f'#include "capstan_mutants.h"\n#line 1\n{"".join(parts)}{text[done:]}'


def syntax_tree(command, path):
    """(file, node, whether it has to be a constant) of the nodes that stand in files of the project; clang names a file only
    where it changes."""
    words = shlex.split(command)
    flags = [word for k, word in enumerate(words) if word.startswith(("-I", "-D", "-std", "-m", "-isystem")) or words[k - 1] == "-isystem"]
    dumped = subprocess.run(["clang++", *flags, "-fsyntax-only", "-w", "-Xclang", "-ast-dump=json", "-Xclang", "-ast-dump-filter=capstan",
                             str(path)], capture_output=True, text=True, check=False).stdout
    here = [None]

    def locate(place):
        if "file" in place:
            here[0] = place["file"]
        for inner in ("spellingLoc", "expansionLoc"):
            if inner in place:
                locate(place[inner])

    def walk(node, constant):
        if not isinstance(node, dict):
            return
        locate(node.get("loc", {}))
        begin, end = node.get("range", {}).get("begin", {}), node.get("range", {}).get("end", {})
        locate(begin)
        file = here[0]
        locate(end)
        kind = node.get("kind")
        written = not node.get("isImplicit") and not node.get("explicitlyDefaulted")
        if kind in ("CXXConstructorDecl", "CXXDestructorDecl", "CXXMethodDecl") and not written:
            return
        declared = bool(node.get("constexpr")) and written and node.get("name") != "operator()"  # of a lambda it is implied
        constant = kind != "LambdaExpr" and (constant or declared or kind in ("ConstantExpr", "StaticAssertDecl"))
        if "offset" in begin and "offset" in end:
            yield file, node, constant
        for inner in node.get("inner", ()):
            yield from walk(inner, constant)

    sys.setrecursionlimit(100000)
    decoder, at = json.JSONDecoder(), 0
    while (at := dumped.find("{", at)) >= 0:
        here[0] = None
        node, at = decoder.raw_decode(dumped, at)
        yield from walk(node, False)


def span(node):
    """Where it begins and ends; None where a macro does."""
    begin, end = node.get("range", {}).get("begin", {}), node.get("range", {}).get("end", {})
    return (begin["offset"], end["offset"] + end.get("tokLen", 0)) if "offset" in begin and "offset" in end else None


def calls_for_effect(node):
    """The statements below a block, a branch or a loop that are calls."""
    inner = node.get("inner", [])
    if node["kind"] == "CompoundStmt":
        below = inner
    elif node["kind"] == "IfStmt":
        below = inner[-2:] if node.get("hasElse") else inner[-1:]
    elif node["kind"] in ("ForStmt", "CXXForRangeStmt", "WhileStmt"):
        below = inner[-1:]
    else:
        below = []
    return [span(each) for each in below if each.get("kind") in CALLS and span(each)]


def mutants_of_node(text, node):
    """(place, was, becomes, begin, end, kind)"""
    begin, end = span(node)
    kind, inner, written = node["kind"], node.get("inner", []), text[begin:end]
    if kind in ("BinaryOperator", "CompoundAssignOperator") and node.get("opcode") in OPERATORS and len(inner) == 2:
        left, right = span(inner[0]), span(inner[1])
        opcode = node["opcode"]
        if left and right and text[left[1]:right[0]].strip() == opcode:
            at = left[1] + text[left[1]:right[0]].index(opcode)
            yield at, opcode, OPERATORS[opcode], begin, end, "logical" if opcode in ("&&", "||") else "operator"
    elif kind == "CXXOperatorCallExpr" and len(inner) == 3:
        left, right = span(inner[1]), span(inner[2])
        between = text[left[1]:right[0]].strip() if left and right else ""
        if between in ("==", "!=", "<", "<=", ">", ">="):
            yield left[1] + text[left[1]:right[0]].index(between), between, OPERATORS[between], begin, end, "operator"
    elif kind == "UnaryOperator" and node.get("opcode") == "!" and written[:1] == "!" and span(inner[0]) and span(inner[0])[0] > begin:
        yield begin, "!", "", begin, end, "negated"
    elif kind == "CXXBoolLiteralExpr" and written in ("true", "false"):
        yield begin, written, "false" if written == "true" else "true", begin, end, "flag"
    elif kind == "IntegerLiteral" and written.isdigit():
        yield begin, written, str(int(written) + 1), begin, end, "literal"
    elif kind == "CallExpr" and (called := re.match(r"hn::(\w+)\(", written)) and called.group(1) in FUNCTIONS:
        yield begin, f"hn::{called.group(1)}", f"hn::{FUNCTIONS[called.group(1)]}", begin, end, "function"
    for first, last in calls_for_effect(node):
        yield first, text[first:last], "", first, last, "call"


def mutants_of(tree, room, commands):
    """All of a room, in order; `commands` has how each of its sources is compiled. And the files in which clang saw any code."""
    texts, found = {}, {}
    for path, command in sorted(commands.items()):
        for file, node, constant in syntax_tree(command, path):
            if file not in texts:
                resolved = (tree / file).resolve() if file else None
                name = str(resolved.relative_to(tree)) if resolved and resolved.is_relative_to(tree) else ""
                texts[file] = (name, resolved.read_bytes().decode("latin-1")) if name.startswith(f"{room}/") else None
            if texts[file]:
                name, text = texts[file]
                for mutant in mutants_of_node(text, node):
                    key = (name, *mutant)
                    found[key] = found.get(key, False) or constant
    return sorted(Mutant(*key, constant) for key, constant in found.items()), {entry[0] for entry in texts.values() if entry}
