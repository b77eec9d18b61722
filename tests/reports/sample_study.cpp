#include "sample_study.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "capstan/storage/study_store.h"

namespace capstan::sample {
namespace {

using namespace storage;

constexpr int segments = 10;
constexpr int nodes = segments + 1;
constexpr double wrap_per_segment_rad = 0.2 / 0.28;
constexpr double friction_coefficient = 0.21;
constexpr double normal_95 = 1.959963984540054;

// A repeatable wobble in [-1, 1], so that the curves do not look drawn with a ruler.
double wobble(double a, double b = 0, double c = 0) {
    return std::sin(12.9898 * a + 78.233 * b + 37.719 * c) * std::cos(4.1 * a + 7.7 * b - 3.3 * c);
}

std::vector<int> node_range(int first, int count) {
    std::vector<int> range;
    for (int k = 0; k < count; ++k) range.push_back(first + k);
    return range;
}

std::vector<int> even_nodes(int count, bool from_proximal) {
    std::set<int> chosen;
    for (int k = 0; k < count; ++k) {
        const int step = static_cast<int>(std::floor(static_cast<double>(k) * nodes / count));
        chosen.insert(from_proximal ? 1 + step : nodes - step);
    }
    return {chosen.begin(), chosen.end()};
}

std::vector<int> both_nodes(int count) {
    std::set<int> chosen;
    for (int k = 0; k < count; ++k) chosen.insert(k % 2 == 0 ? nodes - k / 2 : 1 + k / 2);
    return {chosen.begin(), chosen.end()};
}

struct Instant {
    const char* regime;
    int sample;
    bool forward;
};

std::vector<Instant> instants(const SampleOptions& options) {
    std::vector<Instant> list{{"mass", 112, false}, {"mass", 142, true}};
    if (options.with_partial_regime) {
        list.push_back({"partial_proximal", 6, true});
        list.push_back({"partial_proximal", 104, false});
    }
    return list;
}

bool is_partial(const std::string& regime) {
    return regime != "mass";
}

double true_tension_N(const Instant& instant, int node) {
    const double sign = instant.forward ? 1 : -1;
    const double growth = friction_coefficient * wrap_per_segment_rad * sign;
    if (is_partial(instant.regime)) return 10 * std::exp(growth * std::min(node - 8, 0));
    return (instant.forward ? 4.2 : 14) * std::exp(growth * (node - 1));
}

ScenarioRecord scenario(const Instant& instant) {
    ScenarioRecord record{instant.regime,
                          instant.sample,
                          instant.sample * 0.01,
                          instant.forward ? "forward" : "backward",
                          0.01 * std::sin(instant.sample * 0.0628),
                          (instant.forward ? 1 : -1) * 6e-4,
                          {}};
    for (int node = 1; node <= nodes; ++node) {
        const double tension_N = true_tension_N(instant, node);
        const int moving = is_partial(instant.regime) && node > 8 ? 0 : 1;
        record.nodes.push_back({node, 0.2 * (node - 1), tension_N, -0.001 * (nodes - node), tension_N * 0.98,
                                -0.0011 * (nodes - node), instant.forward ? moving : -moving});
    }
    return record;
}

std::vector<FusionMethodRecord> methods() {
    return {
        {"mean_known", "Mean, direction known", "direction_known", "The mean of the single-sensor estimates"},
        {"mean", "Mean", "direction_unknown", "The mean of the single-sensor estimates"},
        {"mean_r", "Mean-R", "direction_unknown", "The mean over sensors that agree with the consensus"},
        {"w_mean", "W Mean", "direction_unknown", "Weighted by 1 / single-sensor error"},
        {"w_mean_r", "W Mean-R", "direction_unknown", "Weighted, only sensors that agree"},
        {"maximum_likelihood", "Maximum likelihood", "feasible_curve",
         "Most likely point of the feasible curve"},
        {"posterior_mean", "Posterior mean", "feasible_curve", "Mean over the feasible curve"}};
}

// Between 0 (all at the distal end) and 1 (all at the proximal end).
double proximal_fraction(const std::vector<int>& sensor_nodes) {
    double sum = 0;
    for (int node : sensor_nodes) sum += static_cast<double>(nodes - node) / segments;
    return sum / static_cast<double>(sensor_nodes.size());
}

double error_N(const Instant& instant, double noise, const std::vector<int>& sensor_nodes,
               const std::string& method) {
    const double m = static_cast<double>(sensor_nodes.size());
    const double scale = noise / 0.1;
    double proximal = proximal_fraction(sensor_nodes);
    if (is_partial(instant.regime)) proximal = 0.6 * std::abs(proximal - 0.45) + 0.15;
    const double shift =
        1 + 0.05 * wobble(m, proximal * 9, instant.sample) + (instant.forward ? 0.12 : -0.12);
    const std::map<std::string, double> by_method{
        {"mean_known", 0.335 / std::sqrt(m) / shift},
        {"mean", 0.33 + 0.08 / m + 0.9 * proximal / std::pow(m, 0.3)},
        {"mean_r", 0.30 + 0.10 / m + 0.7 * proximal / std::pow(m, 0.4)},
        {"w_mean", 0.31 + 0.09 / m + 0.6 * proximal / std::pow(m, 0.3)},
        {"w_mean_r", 0.42 + 0.05 / m + 0.7 * proximal / std::pow(m, 0.2)},
        {"maximum_likelihood", 0.21 / std::pow(m, 0.42) + 0.03 * proximal},
        {"posterior_mean", 0.23 / std::pow(m, 0.35) + 0.01 * proximal}};
    return scale * by_method.at(method) * shift;
}

CellRecord cell(const Instant& instant, double noise, int set_index, const std::vector<int>& sensor_nodes,
                const std::string& method, bool with_nodes) {
    CellRecord record;
    record.set_index = set_index;
    record.method = method;
    record.repetitions = 2000;
    record.mean_abs_error_N = error_N(instant, noise, sensor_nodes, method);
    record.standard_error_N = 0.018 * record.mean_abs_error_N;
    record.interval_low_N = record.mean_abs_error_N - normal_95 * record.standard_error_N;
    record.interval_high_N = record.mean_abs_error_N + normal_95 * record.standard_error_N;
    record.rms_error_N = 1.25 * record.mean_abs_error_N;
    record.bias_N = 0.1 * record.mean_abs_error_N;
    record.worst_node = instant.forward ? nodes : 1;
    record.worst_node_error_N = 1.6 * record.mean_abs_error_N;
    record.error_q05_N = 0.1 * record.mean_abs_error_N;
    record.error_q50_N = 0.8 * record.mean_abs_error_N;
    record.error_q95_N = 2.6 * record.mean_abs_error_N;
    record.unverified_fraction = 0.3 * (1 - proximal_fraction(sensor_nodes));
    record.ambiguous_fraction = 0.4 * proximal_fraction(sensor_nodes);
    for (int node = 1; with_nodes && node <= nodes; ++node) {
        const double error = record.mean_abs_error_N * (0.5 + 1.1 * std::pow((node - 1.0) / segments, 1.5));
        record.nodes.push_back({node, error, 0.2 * error * wobble(node)});
    }
    for (int block = 0; block < 4; ++block) record.block_mean_abs_error_N.push_back(record.mean_abs_error_N);
    return record;
}

SingleSensorRecord single_sensor(const Instant& instant, double noise, bool known, int sensor) {
    SingleSensorRecord record;
    record.knowledge = known ? "direction_known" : "direction_unknown";
    record.sensor_node = sensor;
    const double proximal = static_cast<double>(nodes - sensor) / segments;
    const bool rests = is_partial(instant.regime) && sensor > 8;
    const double mean_N = known ? 0.335 : 0.41 + 1.0 * std::pow(proximal, 1.4) + 0.03 * wobble(sensor);
    record.mean_abs_error_N = mean_N * noise / 0.1 * (instant.forward ? 1.1 : 0.9);
    record.standard_error_N = 0.02 * record.mean_abs_error_N;
    record.unverified_fraction = known ? 0 : 0.49 * (1 - proximal) * (instant.forward ? 1 : 0.4);
    record.ambiguous_fraction = known ? 0 : 0.42 * proximal * proximal;
    record.at_rest_fraction = rests ? 0.9 : 0.03;
    for (int node = 1; node <= nodes; ++node) {
        const double tension_N = true_tension_N(instant, node);
        const double spread = tension_N * noise * (known ? 1 : 1 + 1.5 * proximal);
        const double bias = known ? 0 : 0.6 * proximal * wobble(instant.sample, 2) * tension_N * noise;
        record.nodes.push_back({node, record.mean_abs_error_N * (0.4 + 0.11 * node), tension_N + bias,
                                tension_N + bias - normal_95 * spread,
                                tension_N + bias + normal_95 * spread});
    }
    return record;
}

std::vector<CableSegmentRecord> cable(bool mixed_bends) {
    std::vector<CableSegmentRecord> list;
    for (int k = 0; k < segments; ++k) {
        std::optional<double> radius_m = 0.28;
        if (mixed_bends) {
            if (k == 0 || k == 4 || k == 5 || k == 9) radius_m.reset();
            if (k == 6 || k == 7) radius_m = 0.06;
        }
        list.push_back({k + 1, 0.2 * k, 0.2, radius_m, radius_m ? 0.2 / *radius_m : 0});
    }
    return list;
}

StudyDescription describe(const SampleOptions& options) {
    StudyDescription description;
    description.study = {0,
                         options.name,
                         "[cable]\nlength_m = 2.0\nbend_radius_m = 0.28\n\n[study]\nrepetitions = 2000\n",
                         "0.1.0",
                         20170601,
                         2000,
                         segments,
                         "running"};
    description.cable_segments = cable(options.mixed_bends);
    description.regimes = {{"mass", options.with_partial_regime ? 0.6 : 1.0}};
    if (options.with_partial_regime) description.regimes.push_back({"partial_proximal", 0.4});
    for (const Instant& instant : instants(options)) description.scenarios.push_back(scenario(instant));
    const std::vector<NoiseLevelRecord> levels{
        {"10 %", 0.1, 0, 0}, {"5 %", 0.05, 0, 0}, {"0.2 N", 0, 0.2, 0}};
    description.noise_levels.assign(levels.begin(), levels.begin() + options.noise_levels);
    description.fusion_methods = methods();

    auto set_index = [&](std::vector<int> sensor_nodes) {
        auto& sets = description.sensor_sets;
        for (std::size_t k = 0; k < sets.size(); ++k) {
            if (sets[k].nodes == sensor_nodes) return static_cast<int>(k);
        }
        sets.push_back({sensor_nodes});
        return static_cast<int>(sets.size()) - 1;
    };
    for (int m = 1; m <= nodes; ++m) {
        const std::string count = std::to_string(m) + (m == 1 ? " sensor" : " sensors");
        auto add = [&](const char* family, const char* start, const std::string& title,
                       std::vector<int> where) {
            description.layouts.push_back(
                {family, start, m, title + ", " + count, set_index(std::move(where))});
        };
        add("even", "proximal", "Even from the proximal end", even_nodes(m, true));
        add("even", "distal", "Even from the distal end", even_nodes(m, false));
        add("distal", "", "Distal", node_range(nodes - m + 1, m));
        add("both", "", "Both ends", both_nodes(m));
    }
    for (int s = 0; s < static_cast<int>(description.scenarios.size()); ++s) {
        for (int n = 0; n < options.noise_levels; ++n) {
            description.work_units.push_back({"single_sensor", s, n});
            description.work_units.push_back({"fusion", s, n});
        }
    }
    return description;
}

RecommendationRecord recommend(const SampleOptions& options, const StudyDescription& description,
                               int noise_index, double noise, const std::string& scope,
                               const std::string& regime) {
    auto objective_N = [&](int set_index, const std::string& method) {
        double sum = 0;
        int count = 0;
        for (const Instant& instant : instants(options)) {
            if (scope == "regime" && regime != instant.regime) continue;
            sum += error_N(instant, noise, description.sensor_sets[static_cast<std::size_t>(set_index)].nodes,
                           method);
            ++count;
        }
        return (scope == "minimax_regret" ? 0.12 : 1.0) * sum / count;
    };
    RecommendationRecord record;
    record.noise_index = noise_index;
    record.scope = scope;
    record.regime = regime;
    record.sensor_count = 4;
    for (int m = 1; m <= nodes; ++m) {
        RecommendationCountRecord best;
        best.error_N = 1e9;
        for (const LayoutRecord& layout : description.layouts) {
            if (layout.sensor_count != m) continue;
            const double error = objective_N(layout.set_index, "maximum_likelihood");
            if (error < best.error_N) {
                best = {m, layout.set_index, "maximum_likelihood", error, error * 0.965, error * 1.035};
            }
        }
        record.counts.push_back(best);
        if (m != record.sensor_count) continue;
        record.set_index = best.set_index;
        record.method = best.method;
        record.error_N = best.error_N;
        record.interval_low_N = best.interval_low_N;
        record.interval_high_N = best.interval_high_N;
        for (const LayoutRecord& layout : description.layouts) {
            if (layout.sensor_count != m || layout.set_index == best.set_index) continue;
            const double difference = objective_N(layout.set_index, best.method) - best.error_N;
            record.alternatives.push_back(
                {layout.set_index, best.method, difference, difference - 0.006, difference + 0.006});
        }
    }
    const std::string where = scope != "regime"    ? "Across the regimes"
                              : is_partial(regime) ? "In partial motion"
                                                   : "In mass motion";
    record.sentence = where + ", put 4 sensors at the marked nodes and fuse them by maximum likelihood: " +
                      "a fifth sensor lowers the error by less than 0.01 N.";
    return record;
}

std::vector<PaperComparisonRecord> paper_rows() {
    return {
        {"Known direction: largest difference between layouts", 0.01, 0.004, 0.0005, "<",
         "Agrees: only the number of sensors counts."},
        {"Single sensor at node 1", 1.6, 1.36, 0.02, "=",
         "The paper's instants are not stated; nearby instants give 1.2 to 1.7 N."},
        {"Single sensor at node 11", 0.37, 0.41, 0.006, "=",
         "No pattern verifies in half of the draws, and the fallback is not described."},
        {"W Mean, all layouts and counts", 0.42, 0.41, 0.004, "=", "Agrees."},
        {"Mean-R, all layouts and counts", 0.47, 0.45, 0.004, "=", "Agrees within the choice of instants."},
        {"Mean, all layouts and counts", 0.49, 0.53, 0.005, "=", "The instants differ."},
        {"W Mean-R, all layouts and counts", 0.57, 0.57, 0.005, "=", "Agrees."},
        {"Distal, 6-11 sensors, Mean", 0.33, 0.38, 0.004, "=", "The instants differ."},
        {"Gain from 1 to 11 sensors, Even", 0.67, 0.44, 0.02, "=",
         "Follows from the smaller error at node 1."},
        {"Partial motion, Mean-R", 0.52, 0.61, 0.006, "=", "The paper does not give its pair of instants."},
        {"Partial motion, W Mean", 4.7, 1.05, 0.01, "=",
         "Weights that sum to one cannot give the paper's number."},
        {"Maximum likelihood, Distal, 3 sensors", std::nullopt, 0.126, 0.002, "=", "Not in the paper."}};
}

}  // namespace

std::int64_t add_sample_study(const std::filesystem::path& file, const SampleOptions& options) {
    Database database = Database::open_or_create(file);
    const StudyDescription description = describe(options);
    const std::int64_t study_id = begin_study(database, description);

    const std::vector<Instant> when = instants(options);
    const double noise_ratios[] = {0.1, 0.05, 0.03};
    for (int unit = 0; unit < static_cast<int>(description.work_units.size()); ++unit) {
        const WorkUnitRecord& work = description.work_units[static_cast<std::size_t>(unit)];
        const Instant& instant = when[static_cast<std::size_t>(work.scenario_index)];
        const double noise = noise_ratios[work.noise_index];
        if (work.stage == "single_sensor") {
            SingleSensorResult result{work.scenario_index, work.noise_index, {}};
            for (bool known : {true, false}) {
                for (int sensor = 1; sensor <= nodes; ++sensor) {
                    result.sensors.push_back(single_sensor(instant, noise, known, sensor));
                }
            }
            write_single_sensor(database, study_id, unit, result);
            continue;
        }
        FusionResult result{work.scenario_index, work.noise_index, {}, {}, {}};
        for (int sensor = 1; sensor <= nodes; ++sensor) result.weights.push_back({sensor, 1.0 / nodes});
        for (int set = 0; set < static_cast<int>(description.sensor_sets.size()); ++set) {
            const auto& sensor_nodes = description.sensor_sets[static_cast<std::size_t>(set)].nodes;
            result.bounds.push_back(
                {set, 3.35 * noise / std::sqrt(static_cast<double>(sensor_nodes.size()))});
            for (const FusionMethodRecord& method : description.fusion_methods) {
                result.cells.push_back(
                    cell(instant, noise, set, sensor_nodes, method.method, options.with_node_errors));
            }
        }
        write_fusion(database, study_id, unit, result);
    }

    std::vector<RecommendationRecord> recommendations;
    for (int n = 0; n < options.noise_levels; ++n) {
        for (const RegimeRecord& regime : description.regimes) {
            recommendations.push_back(
                recommend(options, description, n, noise_ratios[n], "regime", regime.regime));
        }
        recommendations.push_back(recommend(options, description, n, noise_ratios[n], "minimax_regret", ""));
        recommendations.push_back(recommend(options, description, n, noise_ratios[n], "duty_cycle", ""));
    }
    finish_study(database, study_id, recommendations,
                 options.with_paper_comparison ? paper_rows() : std::vector<PaperComparisonRecord>{});
    return study_id;
}

}  // namespace capstan::sample
