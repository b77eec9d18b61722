#include "example_study.h"

namespace capstan::storage {
namespace {

// No two fields alike: a swapped column shows.
class Distinct {
  public:
    explicit Distinct(double start) : last_(start) {}
    double next() { return last_ += 0.1234567890123; }

  private:
    double last_;
};

std::vector<ScenarioNodeRecord> scenario_nodes(int count, Distinct& value) {
    std::vector<ScenarioNodeRecord> nodes;
    for (int node = 1; node <= count; ++node) {
        nodes.push_back(
            {node, value.next(), value.next(), value.next(), value.next(), value.next(), node % 3 - 1});
    }
    return nodes;
}

CellRecord cell(int set_index, const std::string& method, const ExampleSize& size, Distinct& value) {
    CellRecord record{set_index,
                      method,
                      2000,
                      value.next(),
                      value.next(),
                      value.next(),
                      value.next(),
                      value.next(),
                      -value.next(),
                      2,
                      value.next(),
                      value.next(),
                      value.next(),
                      value.next(),
                      0.25,
                      0.125,
                      {},
                      {}};
    for (int node = 1; node <= size.nodes; ++node)
        record.nodes.push_back({node, value.next(), -value.next()});
    for (int block = 0; block < size.blocks; ++block) record.block_mean_abs_error_N.push_back(value.next());
    return record;
}

}  // namespace

StudyDescription example_study(const ExampleSize& size) {
    Distinct value(1);
    StudyDescription description;
    description.study = {
        0, "example", "[study]\nname = \"it's; an \\\"example\\\"\"\n", "0.1.0", 0xfedcba9876543210u, 80,
        2, "running"};
    description.cable_segments = {{1, 0.0, 0.3, std::nullopt, 0.0}, {2, 0.3, 0.2, 0.05, 3.14}};
    description.regimes = {{"mass", 0.75}, {"partial_proximal", 0.25}};
    for (int i = 0; i < size.scenarios; ++i) {
        description.scenarios.push_back({i % 2 == 0 ? "mass" : "partial_proximal", 100 + i, value.next(),
                                         i % 2 == 0 ? "forward" : "backward", value.next(), -value.next(),
                                         scenario_nodes(size.nodes, value)});
    }
    for (int i = 0; i < size.noise_levels; ++i) {
        description.noise_levels.push_back(
            {"level " + std::to_string(i), 0.1 * i, 0.2, 0.3, 0.01 * i, 200.0});
    }
    description.fusion_methods = {
        {"w_mean_r", "W Mean-R", "direction_unknown", "weighted, of the sensors' kind"},
        {"mean", "Mean", "direction_known", "the plain mean"}};
    for (int i = 0; i < size.sensor_sets; ++i) description.sensor_sets.push_back({{1, i + 2}});
    description.layouts = {{"even", "proximal", 2, "Even from the proximal end", 0},
                           {"distal", "", 2, "Distal", size.sensor_sets - 1},
                           {"explicit", "", 2, "Also the first set", 0}};
    for (int scenario = 0; scenario < size.scenarios; ++scenario) {
        for (int noise = 0; noise < size.noise_levels; ++noise) {
            description.work_units.push_back({"single_sensor", scenario, noise});
            description.work_units.push_back({"fusion", scenario, noise});
        }
    }
    return description;
}

SingleSensorResult example_single_sensor(int scenario_index, int noise_index, const ExampleSize& size) {
    Distinct value(10 + scenario_index + 0.01 * noise_index);
    SingleSensorResult result{scenario_index, noise_index, {}};
    for (const char* knowledge : {"direction_known", "direction_unknown"}) {
        for (int sensor = 1; sensor <= size.nodes; ++sensor) {
            SingleSensorRecord record{knowledge, sensor, value.next(), value.next(), 0.1, 0.2, 0.3, {}};
            for (int node = 1; node <= size.nodes; ++node) {
                record.nodes.push_back({node, value.next(), value.next(), value.next(), value.next()});
            }
            result.sensors.push_back(record);
        }
    }
    return result;
}

FusionResult example_fusion(int scenario_index, int noise_index, const ExampleSize& size) {
    Distinct value(100 + scenario_index + 0.01 * noise_index);
    FusionResult result{scenario_index, noise_index, {}, {}, {}};
    for (int sensor = 1; sensor <= size.nodes; ++sensor) result.weights.push_back({sensor, 1.0 / size.nodes});
    for (int set = 0; set < size.sensor_sets; ++set) {
        for (const char* method : {"w_mean_r", "mean"})
            result.cells.push_back(cell(set, method, size, value));
        result.bounds.push_back({set, value.next()});
    }
    return result;
}

std::vector<RecommendationRecord> example_recommendations() {
    return {{0,
             "regime",
             "mass",
             1,
             "mean",
             2,
             0.5,
             0.4,
             0.6,
             "Put two sensors there.",
             {{1, 0, "mean", 0.9, 0.8, 1.0}, {2, 1, "w_mean_r", 0.51, 0.41, 0.61}},
             {{0, "mean", 0.01, -0.02, 0.03}, {2, "w_mean_r", 0.04, -0.05, 0.06}}},
            {1, "minimax_regret", "", 2, "w_mean_r", 2, 0.7, 0.65, 0.75, "Regret it least.", {}, {}}};
}

std::vector<PaperComparisonRecord> example_paper_comparison() {
    return {{"Even, 3 sensors", 0.42, 0.43, 0.001, "=", "they agree"},
            {"Distal, 3 sensors", std::nullopt, 0.53, 0.002, "<", "the paper gives no number"}};
}

void write_unit(Database& database, std::int64_t study_id, int unit_index, const ExampleSize& size) {
    const int scenario = unit_index / 2 / size.noise_levels;
    const int noise = unit_index / 2 % size.noise_levels;
    if (unit_index % 2 == 0) {
        write_single_sensor(database, study_id, unit_index, example_single_sensor(scenario, noise, size));
    } else {
        write_fusion(database, study_id, unit_index, example_fusion(scenario, noise, size));
    }
}

}  // namespace capstan::storage
