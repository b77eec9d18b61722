#pragma once
// The columns of each record, one row per column: its name in SQL and the member that holds its value.
// Writing and reading both follow this list. Keys and references are not in it; a record holds them as
// positions or not at all.

#include <string_view>
#include <tuple>

#include "capstan/storage/records.h"

namespace capstan::storage {

template <class Record, class Value>
struct Column {
    std::string_view name;
    Value Record::*member;
};
template <class Record, class Value>
Column(const char*, Value Record::*) -> Column<Record, Value>;

template <class Record>
inline constexpr auto columns = nullptr;

template <>
inline constexpr auto columns<StudyRecord> = std::tuple{
    Column{"name", &StudyRecord::name},
    Column{"config_toml", &StudyRecord::config_toml},
    Column{"program_version", &StudyRecord::program_version},
    Column{"seed", &StudyRecord::seed},
    Column{"repetitions", &StudyRecord::repetitions},
    Column{"segments", &StudyRecord::segments},
    Column{"status", &StudyRecord::status},
};

template <>
inline constexpr auto columns<CableSegmentRecord> = std::tuple{
    Column{"segment", &CableSegmentRecord::segment},
    Column{"start_m", &CableSegmentRecord::start_m},
    Column{"length_m", &CableSegmentRecord::length_m},
    Column{"bend_radius_m", &CableSegmentRecord::bend_radius_m},
    Column{"wrap_angle_rad", &CableSegmentRecord::wrap_angle_rad},
};

template <>
inline constexpr auto columns<RegimeRecord> = std::tuple{
    Column{"regime", &RegimeRecord::regime},
    Column{"duty_fraction", &RegimeRecord::duty_fraction},
};

template <>
inline constexpr auto columns<ScenarioRecord> = std::tuple{
    Column{"regime", &ScenarioRecord::regime},
    Column{"sample", &ScenarioRecord::sample},
    Column{"time_s", &ScenarioRecord::time_s},
    Column{"motion", &ScenarioRecord::motion},
    Column{"proximal_displacement_m", &ScenarioRecord::proximal_displacement_m},
    Column{"proximal_increment_m", &ScenarioRecord::proximal_increment_m},
};

template <>
inline constexpr auto columns<ScenarioNodeRecord> = std::tuple{
    Column{"node", &ScenarioNodeRecord::node},
    Column{"arc_length_m", &ScenarioNodeRecord::arc_length_m},
    Column{"true_tension_N", &ScenarioNodeRecord::true_tension_N},
    Column{"true_displacement_m", &ScenarioNodeRecord::true_displacement_m},
    Column{"previous_tension_N", &ScenarioNodeRecord::previous_tension_N},
    Column{"previous_displacement_m", &ScenarioNodeRecord::previous_displacement_m},
    Column{"direction", &ScenarioNodeRecord::direction},
};

template <>
inline constexpr auto columns<NoiseLevelRecord> = std::tuple{
    Column{"label", &NoiseLevelRecord::label},
    Column{"multiplicative_ratio", &NoiseLevelRecord::multiplicative_ratio},
    Column{"additive_N", &NoiseLevelRecord::additive_N},
    Column{"bias_N", &NoiseLevelRecord::bias_N},
    Column{"quantisation_N", &NoiseLevelRecord::quantisation_N},
    Column{"range_N", &NoiseLevelRecord::range_N},
};

template <>
inline constexpr auto columns<FusionMethodRecord> = std::tuple{
    Column{"method", &FusionMethodRecord::method},
    Column{"title", &FusionMethodRecord::title},
    Column{"knowledge", &FusionMethodRecord::knowledge},
    Column{"meaning", &FusionMethodRecord::meaning},
};

template <>
inline constexpr auto columns<LayoutRecord> = std::tuple{
    Column{"family", &LayoutRecord::family},
    Column{"start", &LayoutRecord::start},
    Column{"sensor_count", &LayoutRecord::sensor_count},
    Column{"label", &LayoutRecord::label},
};

template <>
inline constexpr auto columns<SingleSensorRecord> = std::tuple{
    Column{"knowledge", &SingleSensorRecord::knowledge},
    Column{"sensor_node", &SingleSensorRecord::sensor_node},
    Column{"mean_abs_error_N", &SingleSensorRecord::mean_abs_error_N},
    Column{"standard_error_N", &SingleSensorRecord::standard_error_N},
    Column{"unverified_fraction", &SingleSensorRecord::unverified_fraction},
    Column{"ambiguous_fraction", &SingleSensorRecord::ambiguous_fraction},
    Column{"at_rest_fraction", &SingleSensorRecord::at_rest_fraction},
};

template <>
inline constexpr auto columns<SingleSensorNodeRecord> = std::tuple{
    Column{"node", &SingleSensorNodeRecord::node},
    Column{"mean_abs_error_N", &SingleSensorNodeRecord::mean_abs_error_N},
    Column{"mean_tension_N", &SingleSensorNodeRecord::mean_tension_N},
    Column{"tension_q025_N", &SingleSensorNodeRecord::tension_q025_N},
    Column{"tension_q975_N", &SingleSensorNodeRecord::tension_q975_N},
};

template <>
inline constexpr auto columns<SensorWeightRecord> = std::tuple{
    Column{"sensor_node", &SensorWeightRecord::sensor_node},
    Column{"weight_fraction", &SensorWeightRecord::weight_fraction},
};

template <>
inline constexpr auto columns<KnownDirectionBoundRecord> = std::tuple{
    Column{"mean_abs_error_N", &KnownDirectionBoundRecord::mean_abs_error_N},
};

template <>
inline constexpr auto columns<CellRecord> = std::tuple{
    Column{"method", &CellRecord::method},
    Column{"repetitions", &CellRecord::repetitions},
    Column{"mean_abs_error_N", &CellRecord::mean_abs_error_N},
    Column{"standard_error_N", &CellRecord::standard_error_N},
    Column{"interval_low_N", &CellRecord::interval_low_N},
    Column{"interval_high_N", &CellRecord::interval_high_N},
    Column{"rms_error_N", &CellRecord::rms_error_N},
    Column{"bias_N", &CellRecord::bias_N},
    Column{"worst_node", &CellRecord::worst_node},
    Column{"worst_node_error_N", &CellRecord::worst_node_error_N},
    Column{"error_q05_N", &CellRecord::error_q05_N},
    Column{"error_q50_N", &CellRecord::error_q50_N},
    Column{"error_q95_N", &CellRecord::error_q95_N},
    Column{"unverified_fraction", &CellRecord::unverified_fraction},
    Column{"ambiguous_fraction", &CellRecord::ambiguous_fraction},
};

template <>
inline constexpr auto columns<CellNodeRecord> = std::tuple{
    Column{"node", &CellNodeRecord::node},
    Column{"mean_abs_error_N", &CellNodeRecord::mean_abs_error_N},
    Column{"bias_N", &CellNodeRecord::bias_N},
};

template <>
inline constexpr auto columns<RecommendationRecord> = std::tuple{
    Column{"scope", &RecommendationRecord::scope},
    Column{"regime", &RecommendationRecord::regime},
    Column{"method", &RecommendationRecord::method},
    Column{"sensor_count", &RecommendationRecord::sensor_count},
    Column{"error_N", &RecommendationRecord::error_N},
    Column{"interval_low_N", &RecommendationRecord::interval_low_N},
    Column{"interval_high_N", &RecommendationRecord::interval_high_N},
    Column{"sentence", &RecommendationRecord::sentence},
};

template <>
inline constexpr auto columns<RecommendationCountRecord> = std::tuple{
    Column{"sensor_count", &RecommendationCountRecord::sensor_count},
    Column{"method", &RecommendationCountRecord::method},
    Column{"error_N", &RecommendationCountRecord::error_N},
    Column{"interval_low_N", &RecommendationCountRecord::interval_low_N},
    Column{"interval_high_N", &RecommendationCountRecord::interval_high_N},
};

template <>
inline constexpr auto columns<RecommendationAlternativeRecord> = std::tuple{
    Column{"method", &RecommendationAlternativeRecord::method},
    Column{"difference_N", &RecommendationAlternativeRecord::difference_N},
    Column{"interval_low_N", &RecommendationAlternativeRecord::interval_low_N},
    Column{"interval_high_N", &RecommendationAlternativeRecord::interval_high_N},
};

template <>
inline constexpr auto columns<WorldCandidateRecord> = std::tuple{
    Column{"sensors", &WorldCandidateRecord::sensors},
    Column{"words", &WorldCandidateRecord::words},
    Column{"families", &WorldCandidateRecord::families},
    Column{"sensor_count", &WorldCandidateRecord::sensor_count},
    Column{"price", &WorldCandidateRecord::price},
};

template <>
inline constexpr auto columns<WorldErrorRecord> = std::tuple{
    Column{"candidate_index", &WorldErrorRecord::candidate_index},
    Column{"condition", &WorldErrorRecord::condition},
    Column{"world", &WorldErrorRecord::world},
    Column{"mean_abs_error_N", &WorldErrorRecord::mean_abs_error_N},
    Column{"load_end_error_N", &WorldErrorRecord::load_end_error_N},
    Column{"worst_place_error_N", &WorldErrorRecord::worst_place_error_N},
    Column{"mean_square_error_N2", &WorldErrorRecord::mean_square_error_N2},
    Column{"covered_fraction", &WorldErrorRecord::covered_fraction},
};

template <>
inline constexpr auto columns<WorldRecommendationRecord> = std::tuple{
    Column{"objective", &WorldRecommendationRecord::objective},
    Column{"candidate_index", &WorldRecommendationRecord::candidate_index},
    Column{"estimator", &WorldRecommendationRecord::estimator},
    Column{"expected_error_N", &WorldRecommendationRecord::expected_error_N},
    Column{"error_95_N", &WorldRecommendationRecord::error_95_N},
    Column{"interval_low_N", &WorldRecommendationRecord::interval_low_N},
    Column{"interval_high_N", &WorldRecommendationRecord::interval_high_N},
    Column{"no_sensor_error_N", &WorldRecommendationRecord::no_sensor_error_N},
    Column{"beats_no_sensor", &WorldRecommendationRecord::beats_no_sensor},
    Column{"sentence", &WorldRecommendationRecord::sentence},
};

template <>
inline constexpr auto columns<PaperComparisonRecord> = std::tuple{
    Column{"quantity", &PaperComparisonRecord::quantity},
    Column{"paper_N", &PaperComparisonRecord::paper_N},
    Column{"ours_N", &PaperComparisonRecord::ours_N},
    Column{"standard_error_N", &PaperComparisonRecord::standard_error_N},
    Column{"relation", &PaperComparisonRecord::relation},
    Column{"reason", &PaperComparisonRecord::reason},
};

}  // namespace capstan::storage
