#pragma once
// From schema version 2 to 3, as version 3 was: what later versions change, they change in steps of their
// own.

namespace capstan::storage {

// Adds diagnoses, and the step and range of a sensor. What an older file's sensors had stands in its
// configuration only, so their new columns are NULL.
inline constexpr const char* migration_to_3 = R"sql(
ALTER TABLE noise_level ADD COLUMN quantisation_N REAL CHECK (quantisation_N >= 0);
ALTER TABLE noise_level ADD COLUMN range_N REAL CHECK (range_N > 0);
CREATE TABLE diagnosis (
    diagnosis_id INTEGER PRIMARY KEY,
    recording TEXT NOT NULL,
    log_file TEXT NOT NULL,
    log_sha256 TEXT NOT NULL CHECK (length(log_sha256) IN (0, 64)),
    program_version TEXT NOT NULL,
    runs TEXT NOT NULL CHECK (json_valid(runs)),
    verdict TEXT NOT NULL,
    confidence_fraction REAL NOT NULL CHECK (confidence_fraction BETWEEN 0 AND 1),
    component TEXT NOT NULL,
    cable_end TEXT NOT NULL,
    position_m REAL,
    worst_run INTEGER NOT NULL,
    worst_channel TEXT NOT NULL,
    friction_ratio REAL NOT NULL,
    stiffness_ratio REAL NOT NULL,
    pretension_ratio REAL NOT NULL,
    misfit_before_ratio REAL NOT NULL,
    misfit_after_ratio REAL NOT NULL,
    independent_samples_count REAL NOT NULL,
    sentence TEXT NOT NULL,
    gap_sentence TEXT NOT NULL
) STRICT;
CREATE TABLE diagnosis_effect (
    diagnosis_id INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,
    place INTEGER NOT NULL CHECK (place > 0),
    effect TEXT NOT NULL,
    probability_fraction REAL NOT NULL CHECK (probability_fraction BETWEEN 0 AND 1),
    PRIMARY KEY (diagnosis_id, place)
) STRICT, WITHOUT ROWID;
CREATE TABLE diagnosis_cause (
    diagnosis_id INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,
    cause_index INTEGER NOT NULL,
    effect TEXT NOT NULL,
    variant TEXT NOT NULL,
    component TEXT NOT NULL,
    cable_end TEXT NOT NULL,
    position_m REAL,
    PRIMARY KEY (diagnosis_id, cause_index)
) STRICT, WITHOUT ROWID;
CREATE TABLE diagnosis_number (
    diagnosis_id INTEGER NOT NULL,
    cause_index INTEGER NOT NULL,
    name TEXT NOT NULL,
    value_in_unit REAL NOT NULL,
    unit TEXT NOT NULL,
    PRIMARY KEY (diagnosis_id, cause_index, name),
    FOREIGN KEY (diagnosis_id, cause_index) REFERENCES diagnosis_cause ON DELETE CASCADE
) STRICT, WITHOUT ROWID;
CREATE TABLE diagnosis_candidate (
    diagnosis_id INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,
    candidate_index INTEGER NOT NULL,
    effects TEXT NOT NULL CHECK (json_valid(effects)),
    variants TEXT NOT NULL CHECK (json_valid(variants)),
    open_numbers INTEGER NOT NULL,
    misfit_ratio REAL NOT NULL,
    nominal_penalty_log REAL NOT NULL,
    visibility_ratios TEXT NOT NULL CHECK (json_valid(visibility_ratios)),
    evidence_log REAL NOT NULL,
    PRIMARY KEY (diagnosis_id, candidate_index)
) STRICT, WITHOUT ROWID;
CREATE TABLE diagnosis_channel (
    diagnosis_id INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,
    channel_index INTEGER NOT NULL,
    channel TEXT NOT NULL,
    unit TEXT NOT NULL,
    noise_in_unit REAL NOT NULL,
    rms_before_in_unit REAL NOT NULL,
    rms_after_in_unit REAL NOT NULL,
    rms_held_out_in_unit REAL NOT NULL,
    rms_runner_up_in_unit REAL NOT NULL,
    closed_fraction REAL,
    closed_low_fraction REAL,
    closed_high_fraction REAL,
    PRIMARY KEY (diagnosis_id, channel_index)
) STRICT, WITHOUT ROWID;
CREATE TABLE diagnosis_gap (
    diagnosis_id INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,
    part_index INTEGER NOT NULL,
    divided_by TEXT NOT NULL,
    part TEXT NOT NULL,
    energy_fraction REAL NOT NULL,
    low_fraction REAL NOT NULL,
    high_fraction REAL NOT NULL,
    samples_fraction REAL NOT NULL,
    PRIMARY KEY (diagnosis_id, part_index)
) STRICT, WITHOUT ROWID;
CREATE VIEW v_diagnosis AS
SELECT d.diagnosis_id, d.recording, d.verdict, d.confidence_fraction, d.component, d.cable_end, d.position_m,
       c.channel, c.unit, c.rms_before_in_unit, c.rms_after_in_unit, c.rms_held_out_in_unit,
       c.closed_fraction, c.closed_low_fraction, c.closed_high_fraction, d.sentence
FROM diagnosis d LEFT JOIN diagnosis_channel c ON c.diagnosis_id = d.diagnosis_id AND c.channel_index = (
    SELECT channel_index FROM diagnosis_channel j WHERE j.diagnosis_id = d.diagnosis_id
    ORDER BY j.channel <> 'load_torque', j.channel_index LIMIT 1);
)sql";

}  // namespace capstan::storage
