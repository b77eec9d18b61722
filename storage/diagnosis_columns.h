#pragma once
// The columns of the records of a diagnosis; see record_columns.h.

#include "capstan/storage/diagnosis_records.h"
#include "capstan/storage/record_columns.h"

namespace capstan::storage {

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
};

template <>
inline constexpr auto columns<DiagnosisEffectRecord> = std::tuple{
    Column{"effect", &DiagnosisEffectRecord::effect},
    Column{"probability_fraction", &DiagnosisEffectRecord::probability_fraction},
};

template <>
inline constexpr auto columns<DiagnosisCauseRecord> = std::tuple{
    Column{"effect", &DiagnosisCauseRecord::effect},
    Column{"variant", &DiagnosisCauseRecord::variant},
    Column{"component", &DiagnosisCauseRecord::component},
    Column{"cable_end", &DiagnosisCauseRecord::cable_end},
    Column{"position_m", &DiagnosisCauseRecord::position_m},
};

template <>
inline constexpr auto columns<DiagnosisNumberRecord> = std::tuple{
    Column{"name", &DiagnosisNumberRecord::name},
    Column{"value_in_unit", &DiagnosisNumberRecord::value_in_unit},
    Column{"unit", &DiagnosisNumberRecord::unit},
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

template <>
inline constexpr auto columns<DiagnosisGapRecord> = std::tuple{
    Column{"divided_by", &DiagnosisGapRecord::divided_by},
    Column{"part", &DiagnosisGapRecord::part},
    Column{"energy_fraction", &DiagnosisGapRecord::energy_fraction},
    Column{"low_fraction", &DiagnosisGapRecord::low_fraction},
    Column{"high_fraction", &DiagnosisGapRecord::high_fraction},
    Column{"samples_fraction", &DiagnosisGapRecord::samples_fraction},
};

}  // namespace capstan::storage
