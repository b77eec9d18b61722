#!/bin/sh
# Runs studies for real, with fewer repetitions, and writes their report pages: make_real_reports.sh CAPSTAN CONFIGS FOLDER
set -eu
capstan=$1
configs=$2
folder=$3
mkdir -p "$folder"
for study in paper noise-instants wrist-instants; do
    rm -f "$folder/real-$study.db" "$folder/real-$study.db-wal" "$folder/real-$study.db-shm"
    "$capstan" study run "$configs/$study.toml" --repetitions 100 --db "$folder/real-$study.db" --progress none >/dev/null
    "$capstan" report --db "$folder/real-$study.db" -o "$folder/real-$study.html"
done
