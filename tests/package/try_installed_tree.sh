#!/usr/bin/env bash
# Installs the build into a folder and uses what is there: try_installed_tree.sh BUILD_FOLDER WORK_FOLDER COMPILER
set -euo pipefail
build=$1
work=$2
compiler=$3
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
examples=$(echo "$work"/usr/share/doc/*/examples)
cmake -S "$examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$work/usr" -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$work/examples"
for program in step_a_cable estimate_at_1_kHz score_a_layout; do
    echo "--- $program"
    "$work/examples/$program"
done
