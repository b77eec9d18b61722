#pragma once
// Which fields of a diagnosis are which columns; see record_columns.h.

#include "capstan/storage/diagnosis_records.h"
#include "capstan/storage/record_columns.h"

namespace capstan::storage {

template <>
struct Columns<DiagnosisRecord> {
    static constexpr std::string_view names =
        "recording, log_file, log_sha256, program_version, runs, verdict, confidence_fraction, component, "
        "cable_end, position_m, worst_run, worst_channel, friction_ratio, stiffness_ratio, pretension_ratio, "
        "misfit_before_ratio, misfit_after_ratio, independent_samples_count, sentence, gap_sentence";
    static auto fields(auto& row) {
        return std::tie(row.recording, row.log_file, row.log_sha256, row.program_version, row.runs,
                        row.verdict, row.confidence_fraction, row.component, row.cable_end, row.position_m,
                        row.worst_run, row.worst_channel, row.friction_ratio, row.stiffness_ratio,
                        row.pretension_ratio, row.misfit_before_ratio, row.misfit_after_ratio,
                        row.independent_samples_count, row.sentence, row.gap_sentence);
    }
};

template <>
struct Columns<DiagnosisEffectRecord> {
    static constexpr std::string_view names = "effect, probability_fraction";
    static auto fields(auto& row) { return std::tie(row.effect, row.probability_fraction); }
};

template <>
struct Columns<DiagnosisCauseRecord> {
    static constexpr std::string_view names = "effect, variant, component, cable_end, position_m";
    static auto fields(auto& row) {
        return std::tie(row.effect, row.variant, row.component, row.cable_end, row.position_m);
    }
};

template <>
struct Columns<DiagnosisNumberRecord> {
    static constexpr std::string_view names = "name, value_in_unit, unit";
    static auto fields(auto& row) { return std::tie(row.name, row.value_in_unit, row.unit); }
};

template <>
struct Columns<DiagnosisCandidateRecord> {
    static constexpr std::string_view names =
        "effects, variants, open_numbers, misfit_ratio, nominal_penalty_log, visibility_ratios, evidence_log";
    static auto fields(auto& row) {
        return std::tie(row.effects, row.variants, row.open_numbers, row.misfit_ratio,
                        row.nominal_penalty_log, row.visibility_ratios, row.evidence_log);
    }
};

template <>
struct Columns<DiagnosisChannelRecord> {
    static constexpr std::string_view names =
        "channel, unit, noise_in_unit, rms_before_in_unit, rms_after_in_unit, rms_held_out_in_unit, "
        "rms_runner_up_in_unit, closed_fraction, closed_low_fraction, closed_high_fraction";
    static auto fields(auto& row) {
        return std::tie(row.channel, row.unit, row.noise_in_unit, row.rms_before_in_unit,
                        row.rms_after_in_unit, row.rms_held_out_in_unit, row.rms_runner_up_in_unit,
                        row.closed_fraction, row.closed_low_fraction, row.closed_high_fraction);
    }
};

template <>
struct Columns<DiagnosisGapRecord> {
    static constexpr std::string_view names =
        "divided_by, part, energy_fraction, low_fraction, high_fraction, samples_fraction";
    static auto fields(auto& row) {
        return std::tie(row.divided_by, row.part, row.energy_fraction, row.low_fraction, row.high_fraction,
                        row.samples_fraction);
    }
};

}  // namespace capstan::storage
