#!/usr/bin/env python3
"""cppcheck and clang-tidy over the rooms' sources, at the settings of .clang-tidy and cppcheck_suppressions.txt:

    tests/supply/check_code.py BUILD_FOLDER [FILE...]

The build folder must be built: its commands say how each file is compiled, its record of dependencies what each reads. A
file that was clean is not looked at again until it, one of our headers in it, or the settings change. Files are named to
look at those only. Fails with what was found."""
import concurrent.futures
import hashlib
import json
import subprocess
import sys
from pathlib import Path

source = Path(__file__).resolve().parents[2]
here = Path(__file__).resolve().parent
ROOMS = ["engine", "storage", "studies", "reports"]
AT_ONCE = 2


def compiled_files(build):
    """{source file: object} of the rooms."""
    files = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = Path(entry["file"]).resolve()
        if any(path.is_relative_to(source / room) for room in ROOMS):
            files[path] = entry["output"] if "output" in entry else object_of(entry["command"])
    return files


def object_of(command):
    words = command.split()
    return words[words.index("-o") + 1]


def what_each_reads(build):
    """{object: our files in it}, from ninja's record."""
    reads, current = {}, None
    text = subprocess.run(["ninja", "-t", "deps"], cwd=build, check=True, capture_output=True, text=True).stdout
    for line in text.splitlines():
        if line and not line.startswith(" "):
            current = reads.setdefault(line.split(":")[0], [])
        elif line.strip():
            path = (build / line.strip()).resolve()
            if path.is_relative_to(source):
                current.append(path)
    return reads


def state_of(path, read):
    digest = hashlib.sha256((source / ".clang-tidy").read_bytes())
    for file in sorted({path, *read}):
        digest.update(str(file.relative_to(source)).encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()


def tidy(build, wanted):
    files = compiled_files(build)
    reads = what_each_reads(build)
    stamps = build / "clang_tidy"

    def look_at(path):
        stamp = stamps / (str(path.relative_to(source)) + ".clean")
        state = state_of(path, reads.get(files[path], []))
        if stamp.exists() and stamp.read_text() == state:
            return ""
        answer = subprocess.run(["clang-tidy", "-p", str(build), "--quiet", "--extra-arg=-Wno-unknown-warning-option", str(path)],
                                capture_output=True, text=True)
        if answer.returncode == 0:
            stamp.parent.mkdir(parents=True, exist_ok=True)
            stamp.write_text(state)
            return ""
        return answer.stdout or answer.stderr

    chosen = [path for path in sorted(files) if not wanted or path in wanted]
    found = 0
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        for path, words in zip(chosen, pool.map(look_at, chosen)):
            if words:
                found += 1
                print(words, flush=True)
    print(f"clang-tidy: {len(chosen)} files, {found} with findings")
    return found == 0


def cppcheck(build):
    record = build / "cppcheck"
    record.mkdir(exist_ok=True)
    answer = subprocess.run(
        ["cppcheck", "--std=c++20", "--language=c++", "--enable=warning,performance,portability", "--inline-suppr", "--quiet",
         f"-j{AT_ONCE}", f"--cppcheck-build-dir={record}", f"--suppressions-list={here / 'cppcheck_suppressions.txt'}",
         "--error-exitcode=1", *ROOMS], cwd=source)
    print("cppcheck: " + ("no finding" if answer.returncode == 0 else "findings above"))
    return answer.returncode == 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    folder = Path(sys.argv[1]).resolve()
    clean = [cppcheck(folder), tidy(folder, {Path(name).resolve() for name in sys.argv[2:]})]
    sys.exit(0 if all(clean) else 1)
