#pragma once
// The rows of schema.sql as plain values. Fields are named as the columns; schema.sql says what each one
// means. A record points to another by position (scenario_index, noise_index, set_index), never by a row id:
// the store turns positions into ids and back.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace capstan::storage {

struct StudyRecord {
    std::int64_t study_id = 0;  // given by begin_study
    std::string name;
    std::string config_toml;
    std::string program_version;
    std::uint64_t seed = 0;
    int repetitions = 0;
    int segments = 0;
    std::string status = "running";  // 'running' or 'complete'; kept by the store
    bool operator==(const StudyRecord&) const = default;
};

struct CableSegmentRecord {
    int segment = 0;  // from 1
    double start_m = 0;
    double length_m = 0;
    std::optional<double> bend_radius_m;  // nothing: straight
    double wrap_angle_rad = 0;
    bool operator==(const CableSegmentRecord&) const = default;
};

struct RegimeRecord {
    std::string regime;
    double duty_fraction = 0;
    bool operator==(const RegimeRecord&) const = default;
};

struct ScenarioNodeRecord {
    int node = 0;  // from 1
    double arc_length_m = 0;
    double true_tension_N = 0;
    double true_displacement_m = 0;
    double previous_tension_N = 0;
    double previous_displacement_m = 0;
    int direction = 0;  // -1, 0, 1
    bool operator==(const ScenarioNodeRecord&) const = default;
};

struct ScenarioRecord {  // its position is its scenario_index
    std::string regime;
    int sample = 0;
    double time_s = 0;
    std::string motion;  // 'forward' or 'backward'
    double proximal_displacement_m = 0;
    double proximal_increment_m = 0;
    std::vector<ScenarioNodeRecord> nodes;
    bool operator==(const ScenarioRecord&) const = default;
};

struct NoiseLevelRecord {  // its position is its noise_index
    std::string label;
    double multiplicative_ratio = 0;
    double additive_N = 0;
    double bias_N = 0;
    std::optional<double> quantisation_N{};  // nothing: stored before version 3
    std::optional<double> range_N{};
    bool operator==(const NoiseLevelRecord&) const = default;
};

struct FusionMethodRecord {  // its position is its method_index
    std::string method;
    std::string title;
    std::string knowledge;  // 'direction_known', 'direction_unknown' or 'feasible_curve'
    std::string meaning;
    bool operator==(const FusionMethodRecord&) const = default;
};

// Sensor nodes as the database keeps them: '[1,6,11]', which SQLite's json_each can take apart in a query.
std::string node_list_text(const std::vector<int>& nodes);
std::vector<int> parse_node_list(std::string_view text);

struct SensorSetRecord {  // its position is its set_index
    std::vector<int> nodes;
    bool operator==(const SensorSetRecord&) const = default;
};

struct LayoutRecord {
    std::string family;
    std::string start;  // '', 'proximal' or 'distal'
    int sensor_count = 0;
    std::string label;
    int set_index = 0;
    bool operator==(const LayoutRecord&) const = default;
};

struct WorkUnitRecord {  // its position is its unit_index
    std::string stage;   // 'single_sensor' or 'fusion'
    int scenario_index = 0;
    int noise_index = 0;
    bool operator==(const WorkUnitRecord&) const = default;
};

struct WorldCandidateRecord {  // its position is its candidate_index
    std::string sensors;
    std::string words;
    std::string families;
    int sensor_count = 0;
    double price = 0;
    bool operator==(const WorldCandidateRecord&) const = default;
};

// Everything that is known before the first draw.
struct StudyDescription {
    StudyRecord study;
    std::vector<CableSegmentRecord> cable_segments;
    std::vector<RegimeRecord> regimes;
    std::vector<ScenarioRecord> scenarios;
    std::vector<NoiseLevelRecord> noise_levels;
    std::vector<FusionMethodRecord> fusion_methods;
    std::vector<SensorSetRecord> sensor_sets;
    std::vector<LayoutRecord> layouts;
    std::vector<WorkUnitRecord> work_units;
    std::vector<WorldCandidateRecord>
        world_candidates{};  // of a study with [uncertainty], which has no units
    bool operator==(const StudyDescription&) const = default;
};

// Which part of the studies in a file the file is to compute.
struct ShardRecord {
    int shard = 0;   // from 1
    int shards = 0;  // at least shard
    bool operator==(const ShardRecord&) const = default;
};

struct SingleSensorNodeRecord {
    int node = 0;
    double mean_abs_error_N = 0;
    double mean_tension_N = 0;
    double tension_q025_N = 0;
    double tension_q975_N = 0;
    bool operator==(const SingleSensorNodeRecord&) const = default;
};

struct SingleSensorRecord {
    std::string knowledge;  // 'direction_known' or 'direction_unknown'
    int sensor_node = 0;
    double mean_abs_error_N = 0;
    double standard_error_N = 0;
    double unverified_fraction = 0;
    double ambiguous_fraction = 0;
    double at_rest_fraction = 0;
    std::vector<SingleSensorNodeRecord> nodes;
    bool operator==(const SingleSensorRecord&) const = default;
};

struct SingleSensorResult {
    int scenario_index = 0;
    int noise_index = 0;
    std::vector<SingleSensorRecord> sensors;
    bool operator==(const SingleSensorResult&) const = default;
};

struct SensorWeightRecord {
    int sensor_node = 0;
    double weight_fraction = 0;
    bool operator==(const SensorWeightRecord&) const = default;
};

struct CellNodeRecord {
    int node = 0;
    double mean_abs_error_N = 0;
    double bias_N = 0;
    bool operator==(const CellNodeRecord&) const = default;
};

struct CellRecord {
    int set_index = 0;
    std::string method;
    int repetitions = 0;
    double mean_abs_error_N = 0;
    double standard_error_N = 0;
    double interval_low_N = 0;
    double interval_high_N = 0;
    double rms_error_N = 0;
    double bias_N = 0;
    int worst_node = 0;
    double worst_node_error_N = 0;
    double error_q05_N = 0;
    double error_q50_N = 0;
    double error_q95_N = 0;
    double unverified_fraction = 0;
    double ambiguous_fraction = 0;
    std::vector<CellNodeRecord> nodes;
    std::vector<double> block_mean_abs_error_N;  // blocks
    bool operator==(const CellRecord&) const = default;
};

struct KnownDirectionBoundRecord {
    int set_index = 0;
    double mean_abs_error_N = 0;
    bool operator==(const KnownDirectionBoundRecord&) const = default;
};

struct FusionResult {
    int scenario_index = 0;
    int noise_index = 0;
    std::vector<SensorWeightRecord> weights;
    std::vector<CellRecord> cells;
    std::vector<KnownDirectionBoundRecord> bounds;
    bool operator==(const FusionResult&) const = default;
};

struct RecommendationCountRecord {
    int sensor_count = 0;
    int set_index = 0;
    std::string method;
    double error_N = 0;
    double interval_low_N = 0;
    double interval_high_N = 0;
    bool operator==(const RecommendationCountRecord&) const = default;
};

struct RecommendationAlternativeRecord {
    int set_index = 0;
    std::string method;
    double difference_N = 0;
    double interval_low_N = 0;
    double interval_high_N = 0;
    bool operator==(const RecommendationAlternativeRecord&) const = default;
};

struct RecommendationRecord {
    int noise_index = 0;
    std::string scope;   // 'regime', 'minimax_regret' or 'duty_cycle'
    std::string regime;  // '' unless scope is 'regime'
    int set_index = 0;
    std::string method;
    int sensor_count = 0;
    double error_N = 0;
    double interval_low_N = 0;
    double interval_high_N = 0;
    std::string sentence;
    std::vector<RecommendationCountRecord> counts;
    std::vector<RecommendationAlternativeRecord> alternatives;
    bool operator==(const RecommendationRecord&) const = default;
};

struct WorldErrorRecord {
    int candidate_index = 0;
    std::string condition;
    int world = 0;
    double mean_abs_error_N = 0;
    double load_end_error_N = 0;
    double worst_place_error_N = 0;
    double mean_square_error_N2 = 0;
    double covered_fraction = 0;
    bool operator==(const WorldErrorRecord&) const = default;
};

struct WorldRecommendationRecord {
    std::string objective;
    int candidate_index = 0;
    std::string estimator;
    double expected_error_N = 0;
    double error_95_N = 0;
    double interval_low_N = 0;
    double interval_high_N = 0;
    double no_sensor_error_N = 0;
    int beats_no_sensor = 0;  // 0 or 1
    std::string sentence;
    bool operator==(const WorldRecommendationRecord&) const = default;
};

struct PaperComparisonRecord {  // its position is its row_index
    std::string quantity;
    std::optional<double> paper_N;  // nothing: the paper gives no number
    double ours_N = 0;
    double standard_error_N = 0;
    std::string relation = "=";  // '=' or '<'
    std::string reason;
    bool operator==(const PaperComparisonRecord&) const = default;
};

}  // namespace capstan::storage
