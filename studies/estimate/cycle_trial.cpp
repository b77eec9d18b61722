#include "capstan/estimate/cycle_trial.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "capstan/estimation/recursive_estimator.h"
#include "capstan/estimation/recursive_fusion.h"
#include "capstan/plan/true_motion.h"
#include "capstan/platform/parallel_for.h"
#include "capstan/platform/statistics.h"
#include "capstan/platform/work_meter.h"

namespace capstan::estimate {

namespace {

// In parts of what the plan says the distal end may do in a sample.
constexpr double wander_fractions[] = {1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0};
constexpr int choosing_repetitions = 2;
constexpr std::uint32_t first_choosing_repetition = 1u << 31;

struct Cycle {
    const StudyPlan& plan;
    QuasiStaticStep model;
    CableState start;
    std::vector<double> proximal_m;              // samples
    std::vector<std::vector<double>> tension_N;  // samples x nodes
};

Cycle simulated(const StudyPlan& plan) {
    const QuasiStaticStep model(Cable(plan.transmission.cable), plan.transmission.rules);
    Cycle cycle{plan, model, pretensioned(model.cable()), {}, {}};
    simulate(model, plan.motion, [&](const TrueSample& sample) {
        cycle.proximal_m.push_back(sample.now.displacement_m.front());
        cycle.tension_N.push_back(sample.now.tension_N);
    });
    return cycle;
}

// samples x nodes
std::vector<std::vector<double>> readings_of(const Cycle& cycle, std::uint32_t repetition) {
    std::vector<std::vector<double>> readings_N;
    const NoiseLevel& noise = cycle.plan.noise_levels.front().level;
    for (std::size_t k = 0; k < cycle.tension_N.size(); ++k) {
        std::vector<double> reading_N(cycle.tension_N[k].size());
        const DrawAddress address{cycle.plan.seed, static_cast<std::uint32_t>(k), repetition};
        read_tensions(noise, draw_readings(address, static_cast<int>(reading_N.size()), noise),
                      cycle.tension_N[k], reading_N);
        readings_N.push_back(std::move(reading_N));
    }
    return readings_N;
}

struct Tally {
    double error_N = 0.0;
    double within = 0.0;
    double band_N = 0.0;
    double log_evidence = 0.0;
};

Tally recursive(const Cycle& cycle, const Layout& layout, const std::vector<std::vector<double>>& readings_N,
                double wander_m, int members, std::uint64_t seed) {
    RecursiveSettings settings;
    settings.members = members;
    settings.wander.distal_m = wander_m;
    settings.seed = seed;
    RecursiveEstimator estimator(cycle.model, cycle.start, settings);
    std::vector<TensionReading> readings;
    for (const int node : layout.nodes)
        readings.push_back(
            {spot_of_node(cycle.model.cable(), node), 0.0, cycle.plan.noise_levels.front().level});
    Tally tally;
    note_work();
    for (std::size_t k = 0; k < cycle.tension_N.size(); ++k) {
        for (std::size_t i = 0; i < readings.size(); ++i)
            readings[i].value_N = readings_N[k][static_cast<std::size_t>(layout.nodes[i])];
        const double distal_m = cycle.start.displacement_m.back();
        tally.log_evidence += estimator.step({cycle.proximal_m[k], distal_m}, readings).log_evidence;
        for (std::size_t node = 0; node < cycle.tension_N[k].size(); ++node) {
            const double error_N = std::abs(estimator.mean_N()[node] - cycle.tension_N[k][node]);
            const double half_N = two_sided_95 * estimator.deviation_N()[node];
            tally.error_N += error_N;
            tally.band_N += half_N;
            tally.within += error_N <= half_N;
        }
    }
    return tally;
}

double likeliest_wander_m(const Cycle& cycle, const Layout& layout, const CycleOptions& options) {
    double best = -std::numeric_limits<double>::infinity();
    double chosen_m = 0.0;
    for (const double fraction : wander_fractions) {
        const double wander_m = fraction * cycle.plan.largest_distal_increment_m;
        double evidence = 0.0;
        for (std::uint32_t r = 0; r < choosing_repetitions; ++r) {
            const auto readings_N = readings_of(cycle, first_choosing_repetition + r);
            evidence +=
                recursive(cycle, layout, readings_N, wander_m, options.members, cycle.plan.seed).log_evidence;
        }
        if (evidence > best) {
            best = evidence;
            chosen_m = wander_m;
        }
    }
    return chosen_m;
}

double paper_error_N(const Cycle& cycle, const Layout& layout,
                     const std::vector<std::vector<double>>& readings_N, const FusionMethod& method) {
    RecursiveFusion fusion(cycle.model, cycle.start, method, cycle.plan.distal_side);
    std::vector<NodeReading> readings;
    for (const int node : layout.nodes) readings.push_back({node, 0.0});
    double error_N = 0.0;
    for (std::size_t k = 0; k < cycle.tension_N.size(); ++k) {
        for (NodeReading& reading : readings)
            reading.value_N = readings_N[k][static_cast<std::size_t>(reading.node)];
        fusion.step(cycle.proximal_m[k], readings);
        for (std::size_t node = 0; node < cycle.tension_N[k].size(); ++node)
            error_N += std::abs(fusion.estimate().tension_N[node] - cycle.tension_N[k][node]);
    }
    return error_N;
}

CycleScore score_of(const Cycle& cycle, const Layout& layout, const CycleOptions& options) {
    CycleScore score;
    score.layout = layout;
    score.wander_m = likeliest_wander_m(cycle, layout, options);
    const double tensions = static_cast<double>(cycle.tension_N.size() * cycle.start.tension_N.size());
    const double count = tensions * options.repetitions;
    for (int repetition = 0; repetition < options.repetitions; ++repetition) {
        const auto number = static_cast<std::uint32_t>(repetition);
        const auto readings_N = readings_of(cycle, number);
        const Tally tally =
            recursive(cycle, layout, readings_N, score.wander_m, options.members, cycle.plan.seed + number);
        score.error_N += tally.error_N / count;
        score.coverage += tally.within / count;
        score.band_N += tally.band_N / count;
        score.paper_mean_N += paper_error_N(cycle, layout, readings_N, mean_method) / count;
        score.paper_mean_r_N += paper_error_N(cycle, layout, readings_N, mean_r_method) / count;
    }
    return score;
}

}  // namespace

std::vector<CycleScore> score_cycles(const StudyPlan& plan, const CycleOptions& options) {
    const Cycle cycle = simulated(plan);
    const int nodes = cycle.model.cable().nodes();
    std::vector<Layout> layouts;
    for (const std::string& family : plan.layout_families) {
        for (const int count : plan.sensor_counts) {
            for (Layout& layout : find_layout_family(family)->layouts(count, nodes))
                layouts.push_back(std::move(layout));
        }
    }
    for (const std::vector<int>& explicit_nodes : plan.explicit_layouts)
        layouts.push_back(explicit_layout(explicit_nodes));
    expect_work(
        static_cast<double>(layouts.size()) *
        (options.repetitions + choosing_repetitions * static_cast<double>(std::size(wander_fractions))));
    std::vector<CycleScore> scores(layouts.size());
    parallel_for_each_index(static_cast<int>(layouts.size()), options.jobs, [&](int k) {
        const auto index = static_cast<std::size_t>(k);
        scores[index] = score_of(cycle, layouts[index], options);
    });
    return scores;
}

}  // namespace capstan::estimate
