#pragma once
// A diagnosis as plain values. Fields are named as the columns of schema.sql, which says what each one means.
// Rows of a list are numbered by their position.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capstan/storage/record_columns.h"

namespace capstan::storage {

struct DiagnosisEffectRecord {  // its position is its place, from 1
    std::string effect;
    double probability_fraction = 0;
    std::optional<double> present_fraction{};  // none: of a diagnosis before it was stored
    std::string varies{};
    bool operator==(const DiagnosisEffectRecord&) const = default;
};
template <>
inline constexpr auto columns<DiagnosisEffectRecord> = std::tuple{
    Column{"effect", &DiagnosisEffectRecord::effect},
    Column{"probability_fraction", &DiagnosisEffectRecord::probability_fraction},
    Column{"present_fraction", &DiagnosisEffectRecord::present_fraction},
    Column{"varies", &DiagnosisEffectRecord::varies},
};

struct DiagnosisNumberRecord {
    std::string name;
    double value_in_unit = 0;
    std::string unit;  // '': a ratio
    std::optional<double> low_in_unit;
    std::optional<double> high_in_unit;
    bool operator==(const DiagnosisNumberRecord&) const = default;
};
template <>
inline constexpr auto columns<DiagnosisNumberRecord> = std::tuple{
    Column{"name", &DiagnosisNumberRecord::name},
    Column{"value_in_unit", &DiagnosisNumberRecord::value_in_unit},
    Column{"unit", &DiagnosisNumberRecord::unit},
    Column{"low_in_unit", &DiagnosisNumberRecord::low_in_unit},
    Column{"high_in_unit", &DiagnosisNumberRecord::high_in_unit},
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
template <>
inline constexpr auto columns<DiagnosisCauseRecord> = std::tuple{
    Column{"effect", &DiagnosisCauseRecord::effect},
    Column{"variant", &DiagnosisCauseRecord::variant},
    Column{"component", &DiagnosisCauseRecord::component},
    Column{"cable_end", &DiagnosisCauseRecord::cable_end},
    Column{"position_m", &DiagnosisCauseRecord::position_m},
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
template <>
inline constexpr auto columns<DiagnosisCandidateRecord> = std::tuple{
    Column{"effects", &DiagnosisCandidateRecord::effects},
    Column{"variants", &DiagnosisCandidateRecord::variants},
    Column{"open_numbers", &DiagnosisCandidateRecord::open_numbers},
    Column{"misfit_ratio", &DiagnosisCandidateRecord::misfit_ratio},
    Column{"nominal_penalty_log", &DiagnosisCandidateRecord::nominal_penalty_log},
    Column{"visibility_ratios", &DiagnosisCandidateRecord::visibility_ratios},
    Column{"evidence_log", &DiagnosisCandidateRecord::evidence_log},
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
template <>
inline constexpr auto columns<DiagnosisChannelRecord> = std::tuple{
    Column{"channel", &DiagnosisChannelRecord::channel},
    Column{"unit", &DiagnosisChannelRecord::unit},
    Column{"noise_in_unit", &DiagnosisChannelRecord::noise_in_unit},
    Column{"rms_before_in_unit", &DiagnosisChannelRecord::rms_before_in_unit},
    Column{"rms_after_in_unit", &DiagnosisChannelRecord::rms_after_in_unit},
    Column{"rms_held_out_in_unit", &DiagnosisChannelRecord::rms_held_out_in_unit},
    Column{"rms_runner_up_in_unit", &DiagnosisChannelRecord::rms_runner_up_in_unit},
    Column{"closed_fraction", &DiagnosisChannelRecord::closed_fraction},
    Column{"closed_low_fraction", &DiagnosisChannelRecord::closed_low_fraction},
    Column{"closed_high_fraction", &DiagnosisChannelRecord::closed_high_fraction},
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
template <>
inline constexpr auto columns<DiagnosisGapRecord> = std::tuple{
    Column{"divided_by", &DiagnosisGapRecord::divided_by},
    Column{"part", &DiagnosisGapRecord::part},
    Column{"energy_fraction", &DiagnosisGapRecord::energy_fraction},
    Column{"low_fraction", &DiagnosisGapRecord::low_fraction},
    Column{"high_fraction", &DiagnosisGapRecord::high_fraction},
    Column{"samples_fraction", &DiagnosisGapRecord::samples_fraction},
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
    std::optional<double> friction_low_ratio;
    std::optional<double> friction_high_ratio;
    std::optional<double> stiffness_low_ratio;
    std::optional<double> stiffness_high_ratio;
    std::optional<double> pretension_low_ratio;
    std::optional<double> pretension_high_ratio;
    std::vector<DiagnosisEffectRecord> effects;
    std::vector<DiagnosisCauseRecord> causes;
    std::vector<DiagnosisCandidateRecord> candidates;
    std::vector<DiagnosisChannelRecord> channels;
    std::vector<DiagnosisGapRecord> gap;
    bool operator==(const DiagnosisRecord&) const = default;
};
template <>
inline constexpr auto columns<DiagnosisRecord> = std::tuple{
    Column{"recording", &DiagnosisRecord::recording},
    Column{"log_file", &DiagnosisRecord::log_file},
    Column{"log_sha256", &DiagnosisRecord::log_sha256},
    Column{"program_version", &DiagnosisRecord::program_version},
    Column{"runs", &DiagnosisRecord::runs},
    Column{"verdict", &DiagnosisRecord::verdict},
    Column{"confidence_fraction", &DiagnosisRecord::confidence_fraction},
    Column{"component", &DiagnosisRecord::component},
    Column{"cable_end", &DiagnosisRecord::cable_end},
    Column{"position_m", &DiagnosisRecord::position_m},
    Column{"worst_run", &DiagnosisRecord::worst_run},
    Column{"worst_channel", &DiagnosisRecord::worst_channel},
    Column{"friction_ratio", &DiagnosisRecord::friction_ratio},
    Column{"stiffness_ratio", &DiagnosisRecord::stiffness_ratio},
    Column{"pretension_ratio", &DiagnosisRecord::pretension_ratio},
    Column{"misfit_before_ratio", &DiagnosisRecord::misfit_before_ratio},
    Column{"misfit_after_ratio", &DiagnosisRecord::misfit_after_ratio},
    Column{"independent_samples_count", &DiagnosisRecord::independent_samples_count},
    Column{"sentence", &DiagnosisRecord::sentence},
    Column{"gap_sentence", &DiagnosisRecord::gap_sentence},
    Column{"friction_low_ratio", &DiagnosisRecord::friction_low_ratio},
    Column{"friction_high_ratio", &DiagnosisRecord::friction_high_ratio},
    Column{"stiffness_low_ratio", &DiagnosisRecord::stiffness_low_ratio},
    Column{"stiffness_high_ratio", &DiagnosisRecord::stiffness_high_ratio},
    Column{"pretension_low_ratio", &DiagnosisRecord::pretension_low_ratio},
    Column{"pretension_high_ratio", &DiagnosisRecord::pretension_high_ratio},
};

}  // namespace capstan::storage
