#!/bin/sh
# Starts a service and runs service_pages.mjs on it: run_service_pages.sh WORK_FOLDER CAPSTAN CONFIGS
# Exit code 77, ctest's "skipped", when the machine has no browser.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$1
capstan=$2
configs=$3
. "$here/browser_driver.sh"

rm -rf "$work/served"
mkdir -p "$work/served"
"$capstan" gap-trial --cases 1 --seed 4 --length short --severity strong --keep "$work/served/trial" --generate-only \
    --progress none >/dev/null
# A laboratory's file: the first run of a recording in degrees and milliseconds, with names that say little.
awk -F, 'BEGIN { print "Time [ms],Motor torque (Nm),ch3,Joint torque (Nm),ch5" }
         $1 == 1 { printf "%.3f,%s,%.7f,%s,%.7f\n", 1000 * $2, $3, $4 * 57.29577951308232, $5, $6 * 57.29577951308232 }' \
    "$configs/recordings/viscous-pair.csv" >"$work/served/laboratory.csv"
python3 "$here/../commands/tension_recording.py" "$capstan" "$work/served"
cp "$configs/recordings/viscous-pair.json" "$work/served/bench.json"
: >"$work/served/messages"
"$capstan" serve --db "$work/served/capstan.db" --port 0 --configs "$configs" 2>"$work/served/messages" &
service=$!
trap 'kill $service 2>/dev/null || true; wait $service 2>/dev/null || true' EXIT
address=
while [ -z "$address" ]; do
    kill -0 $service || { cat "$work/served/messages" >&2; exit 1; }
    address=$(sed -n 's/.* at \(http:[^ ]*\)$/\1/p' "$work/served/messages")
    sleep 0.1
done
CHROMIUM=$chromium node "$work/service_pages.mjs" "$work/screenshots" "$address" \
    "$work/served/trial/case001.csv" "$work/served/trial/case001.json" \
    "$work/served/laboratory.csv" "$work/served/b.csv"
