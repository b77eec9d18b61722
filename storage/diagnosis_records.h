#pragma once
// A diagnosis as plain values. Fields are named as the columns of schema.sql, which says what each one means.
// Rows of a list are numbered by their position.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace capstan::storage {

struct DiagnosisEffectRecord {  // its position is its place, from 1
    std::string effect;
    double probability_fraction = 0;
    bool operator==(const DiagnosisEffectRecord&) const = default;
};

struct DiagnosisNumberRecord {
    std::string name;
    double value_in_unit = 0;
    std::string unit;  // '': a ratio
    bool operator==(const DiagnosisNumberRecord&) const = default;
};

struct DiagnosisCauseRecord {  // its position is its cause_index
    std::string effect;
    std::string variant;
    std::string component;
    std::string cable_end;
    std::optional<double> position_m;
    std::vector<DiagnosisNumberRecord> numbers;  // come back in the order of their names
    bool operator==(const DiagnosisCauseRecord&) const = default;
};

struct DiagnosisCandidateRecord {  // its position is its candidate_index
    std::string effects;           // JSON, as variants and visibility_ratios
    std::string variants;
    int open_numbers = 0;
    double misfit_ratio = 0;
    double nominal_penalty_log = 0;
    std::string visibility_ratios;
    double evidence_log = 0;
    bool operator==(const DiagnosisCandidateRecord&) const = default;
};

struct DiagnosisChannelRecord {  // its position is its channel_index
    std::string channel;
    std::string unit;
    double noise_in_unit = 0;
    double rms_before_in_unit = 0;
    double rms_after_in_unit = 0;
    double rms_held_out_in_unit = 0;
    double rms_runner_up_in_unit = 0;
    std::optional<double> closed_fraction;  // nothing: no gap to close
    std::optional<double> closed_low_fraction;
    std::optional<double> closed_high_fraction;
    bool operator==(const DiagnosisChannelRecord&) const = default;
};

struct DiagnosisGapRecord {  // its position is its part_index
    std::string divided_by;
    std::string part;
    double energy_fraction = 0;
    double low_fraction = 0;
    double high_fraction = 0;
    double samples_fraction = 0;
    bool operator==(const DiagnosisGapRecord&) const = default;
};

struct DiagnosisRecord {
    std::int64_t diagnosis_id = 0;  // given by write_diagnosis
    std::string recording;
    std::string log_file;
    std::string log_sha256;
    std::string program_version;
    std::string runs;  // JSON
    std::string verdict;
    double confidence_fraction = 0;
    std::string component;
    std::string cable_end;
    std::optional<double> position_m;
    int worst_run = 0;
    std::string worst_channel;
    double friction_ratio = 1;
    double stiffness_ratio = 1;
    double pretension_ratio = 1;
    double misfit_before_ratio = 0;
    double misfit_after_ratio = 0;
    double independent_samples_count = 0;
    std::string sentence;
    std::string gap_sentence;
    std::vector<DiagnosisEffectRecord> effects;
    std::vector<DiagnosisCauseRecord> causes;
    std::vector<DiagnosisCandidateRecord> candidates;
    std::vector<DiagnosisChannelRecord> channels;
    std::vector<DiagnosisGapRecord> gap;
    bool operator==(const DiagnosisRecord&) const = default;
};

}  // namespace capstan::storage
