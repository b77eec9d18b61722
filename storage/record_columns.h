#pragma once
// Which fields of a record are which columns: the one list that both writing and reading follow.
// Keys and references are missing here; a record holds them as positions or not at all.

#include <string_view>
#include <tuple>

#include "capstan/storage/records.h"

namespace capstan::storage {

// names: as SQL wants them. fields(record): the same, in the same order, as references.
template <class Record>
struct Columns;

template <>
struct Columns<StudyRecord> {
    static constexpr std::string_view names =
        "name, config_toml, program_version, seed, repetitions, segments, status";
    static auto fields(auto& row) {
        return std::tie(row.name, row.config_toml, row.program_version, row.seed, row.repetitions,
                        row.segments, row.status);
    }
};

template <>
struct Columns<CableSegmentRecord> {
    static constexpr std::string_view names = "segment, start_m, length_m, bend_radius_m, wrap_angle_rad";
    static auto fields(auto& row) {
        return std::tie(row.segment, row.start_m, row.length_m, row.bend_radius_m, row.wrap_angle_rad);
    }
};

template <>
struct Columns<RegimeRecord> {
    static constexpr std::string_view names = "regime, duty_fraction";
    static auto fields(auto& row) { return std::tie(row.regime, row.duty_fraction); }
};

template <>
struct Columns<ScenarioRecord> {
    static constexpr std::string_view names =
        "regime, sample, time_s, motion, proximal_displacement_m, proximal_increment_m";
    static auto fields(auto& row) {
        return std::tie(row.regime, row.sample, row.time_s, row.motion, row.proximal_displacement_m,
                        row.proximal_increment_m);
    }
};

template <>
struct Columns<ScenarioNodeRecord> {
    static constexpr std::string_view names =
        "node, arc_length_m, true_tension_N, true_displacement_m, previous_tension_N, "
        "previous_displacement_m, direction";
    static auto fields(auto& row) {
        return std::tie(row.node, row.arc_length_m, row.true_tension_N, row.true_displacement_m,
                        row.previous_tension_N, row.previous_displacement_m, row.direction);
    }
};

template <>
struct Columns<NoiseLevelRecord> {
    static constexpr std::string_view names =
        "label, multiplicative_ratio, additive_N, bias_N, quantisation_N, range_N";
    static auto fields(auto& row) {
        return std::tie(row.label, row.multiplicative_ratio, row.additive_N, row.bias_N, row.quantisation_N,
                        row.range_N);
    }
};

template <>
struct Columns<FusionMethodRecord> {
    static constexpr std::string_view names = "method, title, knowledge, meaning";
    static auto fields(auto& row) { return std::tie(row.method, row.title, row.knowledge, row.meaning); }
};

template <>
struct Columns<LayoutRecord> {
    static constexpr std::string_view names = "family, start, sensor_count, label";
    static auto fields(auto& row) { return std::tie(row.family, row.start, row.sensor_count, row.label); }
};

template <>
struct Columns<SingleSensorRecord> {
    static constexpr std::string_view names =
        "knowledge, sensor_node, mean_abs_error_N, standard_error_N, unverified_fraction, "
        "ambiguous_fraction, at_rest_fraction";
    static auto fields(auto& row) {
        return std::tie(row.knowledge, row.sensor_node, row.mean_abs_error_N, row.standard_error_N,
                        row.unverified_fraction, row.ambiguous_fraction, row.at_rest_fraction);
    }
};

template <>
struct Columns<SingleSensorNodeRecord> {
    static constexpr std::string_view names =
        "node, mean_abs_error_N, mean_tension_N, tension_q025_N, tension_q975_N";
    static auto fields(auto& row) {
        return std::tie(row.node, row.mean_abs_error_N, row.mean_tension_N, row.tension_q025_N,
                        row.tension_q975_N);
    }
};

template <>
struct Columns<SensorWeightRecord> {
    static constexpr std::string_view names = "sensor_node, weight_fraction";
    static auto fields(auto& row) { return std::tie(row.sensor_node, row.weight_fraction); }
};

template <>
struct Columns<KnownDirectionBoundRecord> {
    static constexpr std::string_view names = "mean_abs_error_N";
    static auto fields(auto& row) { return std::tie(row.mean_abs_error_N); }
};

template <>
struct Columns<CellRecord> {
    static constexpr std::string_view names =
        "method, repetitions, mean_abs_error_N, standard_error_N, interval_low_N, interval_high_N, "
        "rms_error_N, bias_N, worst_node, worst_node_error_N, error_q05_N, error_q50_N, "
        "error_q95_N, unverified_fraction, ambiguous_fraction";
    static auto fields(auto& row) {
        return std::tie(row.method, row.repetitions, row.mean_abs_error_N, row.standard_error_N,
                        row.interval_low_N, row.interval_high_N, row.rms_error_N, row.bias_N, row.worst_node,
                        row.worst_node_error_N, row.error_q05_N, row.error_q50_N, row.error_q95_N,
                        row.unverified_fraction, row.ambiguous_fraction);
    }
};

template <>
struct Columns<CellNodeRecord> {
    static constexpr std::string_view names = "node, mean_abs_error_N, bias_N";
    static auto fields(auto& row) { return std::tie(row.node, row.mean_abs_error_N, row.bias_N); }
};

template <>
struct Columns<RecommendationRecord> {
    static constexpr std::string_view names =
        "scope, regime, method, sensor_count, error_N, interval_low_N, interval_high_N, sentence";
    static auto fields(auto& row) {
        return std::tie(row.scope, row.regime, row.method, row.sensor_count, row.error_N, row.interval_low_N,
                        row.interval_high_N, row.sentence);
    }
};

template <>
struct Columns<RecommendationCountRecord> {
    static constexpr std::string_view names =
        "sensor_count, method, error_N, interval_low_N, interval_high_N";
    static auto fields(auto& row) {
        return std::tie(row.sensor_count, row.method, row.error_N, row.interval_low_N, row.interval_high_N);
    }
};

template <>
struct Columns<RecommendationAlternativeRecord> {
    static constexpr std::string_view names = "method, difference_N, interval_low_N, interval_high_N";
    static auto fields(auto& row) {
        return std::tie(row.method, row.difference_N, row.interval_low_N, row.interval_high_N);
    }
};

template <>
struct Columns<PaperComparisonRecord> {
    static constexpr std::string_view names = "quantity, paper_N, ours_N, standard_error_N, relation, reason";
    static auto fields(auto& row) {
        return std::tie(row.quantity, row.paper_N, row.ours_N, row.standard_error_N, row.relation,
                        row.reason);
    }
};

}  // namespace capstan::storage
