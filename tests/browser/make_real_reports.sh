#!/bin/sh
# Runs studies for real, with fewer repetitions, and writes their report pages: make_real_reports.sh CAPSTAN CONFIGS FOLDER
set -eu
capstan=$1
configs=$2
folder=$3
mkdir -p "$folder"
for study in paper noise-sweep wrist-exosuit; do
    rm -f "$folder/$study.db" "$folder/$study.db-wal" "$folder/$study.db-shm"
    "$capstan" study run "$configs/$study.toml" --repetitions 100 --db "$folder/$study.db" --progress none >/dev/null
    "$capstan" report --db "$folder/$study.db" -o "$folder/real-$study.html"
done
