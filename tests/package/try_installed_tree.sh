#!/usr/bin/env bash
# Installs the build into a folder and uses what is there: try_installed_tree.sh BUILD_FOLDER WORK_FOLDER COMPILER
set -euo pipefail
build=$1
work=$2
compiler=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
rm -rf "$work"
mkdir -p "$work"

cmake --install "$build" --prefix "$work/usr" >"$work/installed"
"$work/usr/bin/capstan" study run "$work/usr/share/capstan/configs/quick.toml" --db "$work/quick.db" --progress none >/dev/null
"$work/usr/bin/capstan" doctor --db "$work/quick.db"
for page in capstan capstan-study-run capstan-serve; do
    test -s "$work/usr/share/man/man1/$page.1"
done
test -s "$work/usr/share/bash-completion/completions/capstan"

# The examples know nothing but the installed tree.
recording=$work/usr/share/capstan/configs/recordings/viscous-pair.csv
examples=$work/usr/share/doc/libcapstan-dev/examples
cmake -S "$examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$work/usr" -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$work/examples"
for program in step_a_cable estimate_at_1_kHz observe_at_1_kHz score_a_layout diagnose_a_recording print_an_answer; do
    echo "--- $program"
    if [[ $program == observe_at_1_kHz ]]; then "$work/examples/$program" 1; else "$work/examples/$program" "$recording"; fi
done
if ldd "$work/examples/diagnose_a_recording" | grep sqlite; then
    echo "A diagnosis needs no database, but the example is linked with SQLite." >&2
    exit 1
fi
mkdir "$work/misspelled"
printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(misspelled NONE)' 'find_package(capstan REQUIRED COMPONENTS slover)' \
    >"$work/misspelled/CMakeLists.txt"
if cmake -S "$work/misspelled" -B "$work/misspelled" -DCMAKE_PREFIX_PATH="$work/usr" >"$work/refused" 2>&1 ||
    ! tr -s '\n ' ' ' <"$work/refused" | grep -q "capstan has no component slover"; then
    echo "A component that does not exist was not refused by its name." >&2
    exit 1
fi

# The Python package, where it was built.
modules=$work/usr/lib/python3/dist-packages
if [[ -d $modules/capstan ]]; then
    PYTHONPATH=$modules /usr/bin/python3 -B "$here/use_python_package.py" "$recording"
fi
