"""Builds the wheel with CMake: a build backend (PEP 517) of the standard library alone.

The setting build-dir names a build folder; one that is configured already is used as it is:
    pip install ./studies/python --config-settings build-dir=$PWD/build
"""

import base64
import hashlib
import re
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parents[1]


def _version() -> str:
    found = re.search(r"project\(capstan VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())
    assert found is not None
    return found.group(1)


def _built_package(build: Path) -> Path:
    if not (build / "CMakeCache.txt").exists():
        # Its own interpreter, whatever stands first on the PATH.
        settings = ["-DCMAKE_BUILD_TYPE=Release", "-DCAPSTAN_TESTS=OFF", "-DCAPSTAN_PYTHON=ON"]
        interpreter = f"-DPython_EXECUTABLE={sys.executable}"
        subprocess.run(["cmake", "-S", SOURCE, "-B", build, "-G", "Ninja", *settings, interpreter], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "capstan_python"], check=True)
    package = build / "python" / "capstan"
    extension = package / ("_core" + sysconfig.get_config_var("EXT_SUFFIX"))
    if not extension.exists():
        raise SystemExit(f"{build}: its module is not for {sys.executable}; name another build folder with build-dir")
    return package


def _metadata() -> str:
    project = tomllib.loads((HERE / "pyproject.toml").read_text())["project"]
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {project['name']}",
        f"Version: {_version()}",
        f"Summary: {project['description']}",
        f"License: {project['license']['text']}",
        f"Requires-Python: {project['requires-python']}",
        *(f"Requires-Dist: {each}" for each in project["dependencies"]),
    ]
    for extra, packages in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {each}; extra == "{extra}"' for each in packages)]
    return "\n".join(lines) + "\n\n" + (HERE / "README.md").read_text()


def _record_line(name: str, data: bytes) -> str:
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def build_wheel(wheel_directory: str, config_settings: dict[str, str] | None = None, metadata_directory: object = None) -> str:
    """Writes the wheel into the folder, and gives its name."""
    package = _built_package(Path((config_settings or {}).get("build-dir", SOURCE / "build-wheel")).resolve())
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
    info = f"capstan-{_version()}.dist-info"
    files = {f"capstan/{file.name}": file.read_bytes() for file in sorted(package.iterdir()) if file.is_file()}
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: capstan\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    files[f"{info}/LICENSE"] = (SOURCE / "LICENSE").read_bytes()
    record = "".join(_record_line(name, data) for name, data in files.items()) + f"{info}/RECORD,,\n"
    files[f"{info}/RECORD"] = record.encode()
    name = f"capstan-{_version()}-{tag}.whl"
    with zipfile.ZipFile(Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in files.items():
            wheel.writestr(path, data)
    return name


def build_sdist(sdist_directory: str, config_settings: object = None) -> str:
    """The package is a part of its repository, and not made without it."""
    raise RuntimeError("capstan has no source distribution; install it from its repository")
