#!/bin/sh
# Exports a study as Parquet and has it read by hyparquet: run_read_parquet.sh WORK_FOLDER CAPSTAN CONFIGS
# Exit code 77, ctest's "skipped", when the machine has no Node.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$1
capstan=$2
configs=$3
for tool in node npm; do
    command -v "$tool" >/dev/null 2>&1 || { echo "Skipped: '$tool' is missing."; exit 77; }
done

mkdir -p "$work"
if ! cmp -s "$here/package-lock.json" "$work/installed-lock.json"; then
    cp "$here/package.json" "$here/package-lock.json" "$here/.npmrc" "$work/"
    npm --prefix "$work" ci --ignore-scripts --loglevel=error
    cp "$here/package-lock.json" "$work/installed-lock.json"
fi
cp "$here/read_parquet.mjs" "$work/"
rm -rf "$work/parquet" "$work/json" "$work/quick.db"
"$capstan" study run "$configs/quick.toml" --db "$work/quick.db" --progress none >/dev/null
"$capstan" export "$work/parquet" --format parquet --db "$work/quick.db" 2>/dev/null
"$capstan" export "$work/json" --format json --db "$work/quick.db" 2>/dev/null
node "$work/read_parquet.mjs" "$work/parquet" "$work/json"
