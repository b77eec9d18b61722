"""The bill of materials is complete: whatever is linked, included or embedded is on it, found here by other ways than it
was made by."""
import json
import os
import re
import subprocess
import unittest
from pathlib import Path

import bill_of_materials

BUILD = Path(os.environ["CAPSTAN_BUILD"])
SOURCE = Path(os.environ["CAPSTAN_SOURCE"])
ROOMS = ["engine", "storage", "reports", "studies"]
# What the compiler brings itself: the language's own library, and the headers of the system.
OF_THE_COMPILER = ("libstdc++", "libgcc", "libc6", "linux-libc")

# An include of the source and the package that brings it; a new one has to be added here, knowingly.
PACKAGE_OF_INCLUDE = {
    "Eigen": "libeigen3-dev", "Random123": "librandom123-dev", "boost": "libboost1.74-dev", "fmt": "libfmt-dev",
    "hwy": "libhwy-dev", "nlohmann": "nlohmann-json3-dev", "openssl": "libssl-dev",
    "sqlite3.h": "libsqlite3-dev", "tbb": "libtbb-dev", "oneapi": "libtbb-dev", "toml++": "libtomlplusplus-dev",
    "bzlib.h": "libbz2-dev", "expat.h": "libexpat1-dev", "hdf5.h": "libhdf5-dev", "lz4frame.h": "liblz4-dev",
    "matio.h": "libmatio-dev", "minizip": "libminizip-dev", "zlib.h": "zlib1g-dev", "zstd.h": "libzstd-dev",
    "pybind11": "pybind11-dev",
}


def sources():
    for room in ROOMS:
        yield from (SOURCE / room).rglob("*.h")
        yield from (SOURCE / room).rglob("*.cpp")


def includes():
    """First parts of what stands in angle brackets."""
    found = set()
    for file in sources():
        if "node_modules" in file.parts or "examples" in file.parts:
            continue
        for name in re.findall(r"^\s*#\s*include\s*<([^>]+)>", file.read_text(), re.MULTILINE):
            found.add(name.split("/")[0])
    return found


class BillOfMaterials(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bill = json.loads(json.dumps(bill_of_materials.bill(BUILD.resolve())))
        cls.by_name = {}
        for package in cls.bill["packages"]:
            cls.by_name.setdefault(package["name"], []).append(package)

    def test_has_what_spdx_asks_for(self):
        for key in ("spdxVersion", "dataLicense", "SPDXID", "name", "documentNamespace", "creationInfo", "packages"):
            self.assertIn(key, self.bill)
        ids = [package["SPDXID"] for package in self.bill["packages"]]
        self.assertEqual(len(ids), len(set(ids)), "an SPDXID is there twice")
        for package in self.bill["packages"]:
            self.assertRegex(package["SPDXID"], r"^SPDXRef-[A-Za-z0-9.-]+$")
            for key in ("name", "versionInfo", "downloadLocation", "licenseConcluded", "licenseDeclared", "copyrightText"):
                self.assertTrue(package[key], f"{package['name']}: {key}")
        for relation in self.bill["relationships"]:
            self.assertIn(relation["relatedSpdxElement"], ids)

    def test_every_library_that_the_program_asks_for_is_on_it(self):
        """The program's own list of needed libraries, and theirs, without the loader's help."""
        seen, todo = {}, [BUILD / "capstan", *bill_of_materials.python_modules(BUILD)]
        while todo:
            text = subprocess.run(["objdump", "--private-headers", todo.pop()], check=True, capture_output=True,
                                  text=True).stdout
            for name in re.findall(r"NEEDED\s+(\S+)", text):
                if name not in seen:
                    seen[name] = self.path_of(name)
                    todo.append(seen[name])
        owner_of = self.owners_of(seen.values())
        for name, path in seen.items():
            owners = {owner_of[other] for other in self.names_of(path) if other in owner_of}
            self.assertTrue(owners & set(self.by_name), f"{name} of {owners} is not on the bill")
        self.assertIn("libtbb.so.12", seen)
        self.assertGreater(len(seen), 10)

    @staticmethod
    def names_of(path):
        """All that a merged /usr gives a file."""
        names = {str(path), str(path.resolve())}
        return names | {name[len("/usr"):] if name.startswith("/usr/") else "/usr" + name for name in names}

    def owners_of(self, paths):
        names = sorted({name for path in paths for name in self.names_of(path)})
        answer = subprocess.run(["dpkg-query", "--search", *names], capture_output=True, text=True)
        return {line.partition(": ")[2]: line.split(":")[0] for line in answer.stdout.splitlines()}

    @staticmethod
    def path_of(library):
        cache = subprocess.run(["/sbin/ldconfig", "-p"], check=True, capture_output=True, text=True).stdout
        return Path(re.search(re.escape(library) + r" \([^)]*x86-64[^)]*\) => (\S+)", cache).group(1))

    def test_every_include_is_of_a_package_on_it(self):
        standard = {name for name in includes() if name not in PACKAGE_OF_INCLUDE}
        for name in standard:
            self.assertRegex(name, r"^([a-z_]+|(sys|arpa|netinet)|[a-z_]+\.h)$")
            self.assertFalse((Path("/usr/include") / name).exists() and self.is_a_third_party(name),
                             f"<{name}> belongs into PACKAGE_OF_INCLUDE and on the bill")
        left_out = set() if bill_of_materials.python_modules(BUILD) else {"pybind11"}
        for name in includes() & set(PACKAGE_OF_INCLUDE) - left_out:
            self.assertIn(PACKAGE_OF_INCLUDE[name], self.by_name, f"<{name}>")

    @staticmethod
    def is_a_third_party(name):
        owner = subprocess.run(["dpkg-query", "--search", f"/usr/include/{name}"], capture_output=True, text=True).stdout
        packages = {package.split(":")[0].strip() for line in owner.splitlines() for package in line.split(": ")[0].split(",")}
        return not any(package.startswith(OF_THE_COMPILER) for package in packages)

    def test_every_script_of_the_report_page_is_on_it(self):
        installed = BUILD / "reports" / "web" / "node_modules" / ".package-lock.json"
        for path, package in json.loads(installed.read_text())["packages"].items():
            name = path.rpartition("node_modules/")[2]
            versions = [entry["versionInfo"] for entry in self.by_name.get(name, [])]
            self.assertIn(package["version"], versions, name)

    def test_is_the_same_when_made_again(self):
        self.assertEqual(self.bill, json.loads(json.dumps(bill_of_materials.bill(BUILD.resolve()))))


if __name__ == "__main__":
    unittest.main()
