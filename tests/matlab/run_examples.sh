#!/usr/bin/env bash
# Runs the MATLAB blocks of a document in Octave, in a folder that has configs: run_examples.sh OCTAVE SOURCE DOCUMENT WORK_FOLDER
set -euo pipefail
octave=$1 source=$2 document=$3 work=$4
rm -rf "$work"
mkdir -p "$work/studies"
ln -s "$source/configs" "$work/configs"
ln -s "$source/studies/matlab" "$work/studies/matlab"
awk '/^```matlab/ {inside = 1; next} /^```/ {inside = 0} inside' "$document" >"$work/read_me.m"
grep -q capstan.place "$work/read_me.m"
sed -i '/^plot/d' "$work/read_me.m"  # a machine without a screen may have no graphics
cd "$work"
"$octave" --no-gui --no-init-file --no-history -q read_me.m
