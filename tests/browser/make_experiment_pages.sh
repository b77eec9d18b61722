#!/bin/sh
# Writes one page of each kind that is not a study's report: make_experiment_pages.sh CAPSTAN CONFIGS FOLDER
set -eu
capstan=$1
configs=$2
folder=$3
mkdir -p "$folder"
"$capstan" paper exp1 --html "$folder/exp1.html" >/dev/null
"$capstan" paper exp2 --html "$folder/exp2.html" >/dev/null
"$capstan" paper solver --seconds 0.01 --html "$folder/solver.html" >/dev/null
"$capstan" place "$configs/paper.toml" --repetitions 20 --html "$folder/place.html" -o /dev/null
python3 "$(dirname "$0")/../commands/tension_recording.py" "$capstan" "$folder"
mv "$folder/b.csv" "$folder/tensions.csv"
mv "$folder/b.json" "$folder/tensions.json"
"$capstan" estimate "$folder/tensions.csv" --html "$folder/estimate.html" -o /dev/null
"$capstan" simulate "$configs/bench-slack.toml" --html "$folder/bench.html" -o /dev/null

# A simulated bench with more friction than the model of its recording knows.
"$capstan" simulate "$configs/bench-ramps.toml" -o "$folder/recording.csv"
cat >"$folder/recording.json" <<'SIDECAR'
{"case": "Ramps & <dwells>", "schema": 1, "mode": "pull_pull", "sample_rate_hz": 200,
 "units": {"t": "s", "motor_torque": "N m", "motor_angle": "rad", "load_angle": "rad", "load_torque": "N m"},
 "nominal": {"L": 2.0, "R_profile": [{"s0": 0, "s1": 2, "R": 0.7}], "r_input": 0.02, "r_load": 0.104, "K": 1000.0,
             "mu_d": 0.18, "mu_s": 0.5},
 "nominal_units": {"L": "m", "R": "m", "r_input": "m", "r_load": "m", "K": "N/m (end to end, one cable)", "T0": "N"},
 "noise_std": {"motor_torque": 0.0003, "load_torque": 0.01},
 "encoder_step": {"motor_angle": 0.00078, "load_angle": 0.00016},
 "runs": [{"run": 1, "protocol": "ramp_locked", "t_session_start": 0.0, "duration": 18.0, "T0": 4.0,
           "output": "locked", "driven": ["motor_torque", "load_angle"]}]}
SIDECAR
"$capstan" simulate "$folder/recording.csv" --html "$folder/recording.html" -o /dev/null

# A log and its import.
"$capstan" import --suggest "$configs/recordings/viscous-pair.csv" --kind pull_pull -o - >"$folder/import.toml" 2>/dev/null
"$capstan" import "$configs/recordings/viscous-pair.csv" --mapping "$folder/import.toml" --try --progress none --html "$folder/import.html" >/dev/null

# Why a bench disagrees with its model.
rm -rf "$folder/trial"
"$capstan" gap-trial --cases 1 --seed 4 --length short --severity strong --keep "$folder/trial" --generate-only \
    --progress none >/dev/null
"$capstan" diagnose "$folder/trial/case001.csv" --fit 1 --baselines --progress none --html "$folder/diagnosis.html" -o /dev/null

# Two studies beside each other.
rm -f "$folder"/compared.db*
for repetitions in 40 60; do
    "$capstan" study run "$configs/quick.toml" --repetitions "$repetitions" --db "$folder/compared.db" --progress none >/dev/null
done
"$capstan" report --compare 1 2 --db "$folder/compared.db" -o "$folder/comparison.html" 2>/dev/null
