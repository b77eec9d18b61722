#!/usr/bin/env python3
"""The bill of materials of a built capstan: everything of others that is in it or that it needs to run, as SPDX 2.3
(JSON) on standard output.

    tests/supply/bill_of_materials.py BUILD_FOLDER > capstan.spdx.json

Three sources, none of them a list kept by hand: the shared libraries that the loader finds (ldd), the headers that the
compiler read (ninja's record of dependencies), and the lock file of the scripts inside a report page. Debian's package
manager says which package a file is of, and that package's copyright file under which licenses it comes."""
import base64
import datetime
import hashlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path

source_folder = Path(__file__).resolve().parents[2]
web_lock_file = source_folder / "reports" / "web" / "package-lock.json"


def output_of(*command, cwd=None):
    return subprocess.run(command, cwd=cwd, check=True, capture_output=True, text=True).stdout


def shared_libraries(program):
    """Paths of what the loader takes in; the loader itself is among them."""
    paths = []
    for line in output_of("ldd", program).splitlines():
        found = re.search(r"(/\S+) \(0x", line)
        if found:
            paths.append(found.group(1))
        elif "not found" in line:
            raise SystemExit(f"{program}: {line.strip()}")
    return paths


def python_modules(build):
    """The extension of the Python package, where it is built."""
    return sorted(build.glob("python/capstan/_core.*.so"))


def headers_read(build):
    """Paths outside the source and build folders that the compiler read for what the program is linked of."""
    targets = ["capstan", *(str(module.relative_to(build)) for module in python_modules(build))]
    inputs = set(output_of("ninja", "-t", "inputs", *targets, cwd=build).split())
    headers = set()
    ours = (str(source_folder) + "/", str(build) + "/")
    taken = False
    for line in output_of("ninja", "-t", "deps", cwd=build).splitlines():
        if not line.startswith(" "):
            taken = line.split(":")[0] in inputs
        elif taken:
            path = str((build / line.strip()).resolve())
            if not path.startswith(ours):
                headers.add(path)
    if not headers:
        raise SystemExit(f"{build}: ninja has no record of headers; was it built there?")
    return sorted(headers)


def debian_packages(paths):
    """{package: [paths]}; a path that no package owns is an error: nobody would know what it is."""
    packages = {}
    unowned = []
    known = {}
    paths = sorted(set(paths))
    for start in range(0, len(paths), 500):
        # One directory of a merged /usr may go by either name.
        wanted = [name for path in paths[start:start + 500] for name in both_names(path)]
        answer = subprocess.run(["dpkg-query", "--search", *wanted], capture_output=True, text=True)
        for line in answer.stdout.splitlines():
            owner, _, path = line.partition(": ")
            if not owner.startswith("diversion"):
                known[path] = owner.split(",")[0].split(":")[0]
    for path in paths:
        owner = next((known[name] for name in both_names(path) if name in known), None)
        if owner is None:
            unowned.append(path)
        else:
            packages.setdefault(owner, []).append(path)
    if unowned:
        raise SystemExit("no Debian package owns " + ", ".join(unowned))
    return packages


def both_names(path):
    resolved = str(Path(path).resolve())
    names = [path, resolved]
    for name in (path, resolved):
        names.append(name[len("/usr"):] if name.startswith("/usr/") else "/usr" + name)
    return list(dict.fromkeys(names))


def licenses_of(package):
    """What the package's copyright file calls its licenses, as comments for a person: Debian's names are not SPDX's."""
    file = Path("/usr/share/doc") / package / "copyright"
    text = file.read_text(errors="replace") if file.exists() else ""
    names = re.findall(r"^License:[ \t]*(\S[^\n]*)", text, re.MULTILINE)
    return ", ".join(dict.fromkeys(name.strip() for name in names)) or "see " + str(file)


def spdx_id(kind, name):
    return f"SPDXRef-{kind}-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)


def debian_entries(packages, linked):
    shown = output_of("dpkg-query", "--show",
                      "--showformat=${Package} ${Version} ${source:Package} ${Architecture}\\n", *packages)
    return [debian_entry(*line.split(), line.split()[0] in linked) for line in sorted(shown.splitlines())]


def debian_entry(package, version, source, architecture, linked):
    return {
        "SPDXID": spdx_id("debian", package),
        "name": package,
        "versionInfo": version,
        "supplier": "Organization: Debian",
        "downloadLocation": "NOASSERTION",
        "filesAnalyzed": False,
        "licenseConcluded": "NOASSERTION",
        "licenseDeclared": "NOASSERTION",
        "licenseComments": licenses_of(package),
        "copyrightText": "NOASSERTION",
        "sourceInfo": f"source package {source}; " + ("shared library" if linked else "headers compiled in"),
        "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                          "referenceLocator": f"pkg:deb/debian/{package}@{version}?arch={architecture}"}],
    }


def npm_entries():
    entries = []
    for path, package in json.loads(web_lock_file.read_text())["packages"].items():
        if not path or package.get("dev"):
            continue
        name = path.rpartition("node_modules/")[2]
        algorithm, _, digest = package["integrity"].partition("-")
        entries.append({
            "SPDXID": spdx_id("npm", path),
            "name": name,
            "versionInfo": package["version"],
            "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False,
            "licenseConcluded": "NOASSERTION",
            "licenseDeclared": package.get("license", "NOASSERTION"),
            "copyrightText": "NOASSERTION",
            "sourceInfo": "npm package of the scripts inside report pages",
            "checksums": [{"algorithm": algorithm.upper(), "checksumValue": base64.b64decode(digest).hex()}],
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:npm/{name.replace('@', '%40')}@{package['version']}"}],
        })
    return entries


def bill(build):
    program = build / "capstan"
    version = output_of(program, "--version").split()[1]
    linked = debian_packages([path for part in (program, *python_modules(build)) for path in shared_libraries(part)])
    compiled = debian_packages(headers_read(build))
    packages = debian_entries(set(linked) | set(compiled), linked) + npm_entries()
    ours = {"SPDXID": "SPDXRef-capstan", "name": "capstan", "versionInfo": version, "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False, "licenseConcluded": "Apache-2.0", "licenseDeclared": "Apache-2.0",
            "copyrightText": "NOASSERTION", "primaryPackagePurpose": "APPLICATION"}
    # The document's own name and time must not differ where what it lists does not.
    digest = hashlib.sha256(json.dumps(packages, sort_keys=True).encode()).hexdigest()
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", program.stat().st_mtime))
    created = datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    return {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"capstan-{version}",
        "documentNamespace": f"urn:capstan:spdx:{version}:{digest}",
        "creationInfo": {"created": created, "creators": ["Tool: tests/supply/bill_of_materials.py"]},
        "documentDescribes": ["SPDXRef-capstan"],
        "packages": [ours, *packages],
        "relationships": [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
                           "relatedSpdxElement": "SPDXRef-capstan"}] +
                         [{"spdxElementId": "SPDXRef-capstan", "relatedSpdxElement": package["SPDXID"],
                           "relationshipType": "DYNAMIC_LINK" if "shared library" in package["sourceInfo"] else "CONTAINS"}
                          for package in packages],
    }


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit("usage: bill_of_materials.py BUILD_FOLDER")
    json.dump(bill(Path(sys.argv[1]).resolve()), sys.stdout, indent=2)
    print()
