#!/usr/bin/env bash
# Makes the wheel of a build, installs it into a fresh environment and uses it: try_wheel.sh BUILD_FOLDER WORK_FOLDER PYTHON
# Exit code 77, ctest's "skipped", where Debian's pip or venv is missing.
set -euo pipefail
build=$1
work=$2
python=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if ! "$python" -c "import ensurepip, pip, venv" 2>/dev/null; then
    echo "Skipped: Debian's python3-venv or python3-pip is missing."
    exit 77
fi
rm -rf "$work"
mkdir -p "$work"
"$python" -m pip wheel --quiet --no-index --no-deps --disable-pip-version-check --wheel-dir "$work" \
    --config-settings "build-dir=$build" "$here/../../studies/python"
"$python" -m venv --system-site-packages "$work/environment"
"$work/environment/bin/python" -m pip install --quiet --no-index --disable-pip-version-check "$work"/capstan-*.whl
env -u PYTHONPATH "$work/environment/bin/python" -B "$here/use_python_package.py" \
    "$here/../../configs/recordings/viscous-pair.csv"
