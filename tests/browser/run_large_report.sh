#!/bin/sh
# Writes the report of a study of more than 100,000 cells and runs large_report.mjs on it:
# run_large_report.sh WORK_FOLDER CAPSTAN CONFIG
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$1
capstan=$2
config=$3
. "$here/browser_driver.sh"

rm -f "$work"/large.db*
"$capstan" study run "$config" --db "$work/large.db" --progress none >/dev/null
"$capstan" report --db "$work/large.db" -o "$work/large.html" 2>/dev/null
cells=$("$capstan" query "SELECT count(*) FROM cell" --format csv --db "$work/large.db" | tail -n 1)
rm -f "$work"/large.db*
CHROMIUM=$chromium exec node "$work/large_report.mjs" "$work/screenshots" "$cells" "$work/large.html"
