#!/usr/bin/env bash
# The paper's Sec. III.B motions from capstan, and whichever of the two peers is installed on them.
#   race.sh CAPSTAN [SECONDS for each case, number of segments and start]
set -euo pipefail
capstan=${1:?usage: race.sh CAPSTAN [SECONDS]}
seconds=${2:-2}
here=$(dirname "${BASH_SOURCE[0]}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

motions=()
for named in paper=0.0015 mass=0.08; do
    for segments in 10 40 100; do
        motion=$work/${named%=*}$segments
        sed -e "s/@SEGMENTS@/$segments/" -e "s/@AMPLITUDE_M@/${named#*=}/" "$here/motion.toml.in" >"$motion.toml"
        "$capstan" simulate "$motion.toml" -o "$motion.csv"
        motions+=("${named%=*}=$motion.csv")
    done
done

with_scipy=
for python in python3 /usr/bin/python3; do
    if [[ -z $with_scipy ]] && "$python" -c 'import numpy, scipy' 2>/dev/null; then with_scipy=$python; fi
done
if [[ -n $with_scipy ]]; then
    "$with_scipy" "$here/scipy_fsolve.py" --seconds "$seconds" "${motions[@]}"
else
    echo "SciPy is not installed (Debian: python3-scipy); skipped."
fi
echo
if command -v octave-cli >/dev/null; then
    octave-cli --no-gui --no-init-file "$here/octave_fsolve.m" "$seconds" "${motions[@]}"
else
    echo "Octave is not installed (Debian: octave); skipped."
fi
