#include "capstan/placement/fusion_stage.h"

#include <cmath>

#include "capstan/estimation/information_bound.h"
#include "capstan/placement/cell_statistics.h"
#include "capstan/placement/repetition_blocks.h"

namespace capstan {

namespace {

// The single-sensor estimates of one repetition as fusion methods read them.
class RepetitionProfiles {
  public:
    RepetitionProfiles(const PreparedScenario& scenario, int nodes)
        : scenario_(scenario),
          nodes_(nodes),
          unknown_N_(static_cast<std::size_t>(nodes) * nodes),
          known_N_(unknown_N_.size()),
          directions_(nodes),
          verified_(nodes),
          known_usable_(nodes) {}

    void fill(const SolvedReadings& solved, int repetition) {
        for (int sensor = 0; sensor < nodes_; ++sensor) {
            const std::size_t slot = solved.at(repetition, sensor);
            const double reading_N = solved.reading_N[slot];
            const SensorBranch& branch = scenario_.estimator.branches(sensor)[solved.branch[slot]];
            write_profile(branch, reading_N, unknown_N_, sensor);
            directions_[sensor] = branch.directions;
            verified_[sensor] = branch.verified;
            const auto& known = scenario_.known_branch[sensor];
            known_usable_[sensor] = known.has_value();
            if (known) {
                write_profile(*known, reading_N, known_N_, sensor);
            } else {
                std::copy(scenario_.previous.tension_N.begin(), scenario_.previous.tension_N.end(),
                          known_N_.begin() + static_cast<std::ptrdiff_t>(sensor) * nodes_);
            }
        }
    }

    SensorEstimates unknown() const { return {nodes_, unknown_N_, directions_, verified_}; }
    SensorEstimates known() const { return {nodes_, known_N_, {}, known_usable_}; }

  private:
    void write_profile(const SensorBranch& branch, double reading_N, std::vector<double>& all_N, int sensor) {
        double* profile_N = all_N.data() + static_cast<std::size_t>(sensor) * nodes_;
        for (int node = 0; node < nodes_; ++node) profile_N[node] = branch.tension_N(node, reading_N);
    }

    const PreparedScenario& scenario_;
    int nodes_;
    std::vector<double> unknown_N_;  // sensors x nodes
    std::vector<double> known_N_;    // sensors x nodes
    std::vector<DirectionBits> directions_;
    std::vector<std::uint8_t> verified_;
    std::vector<std::uint8_t> known_usable_;
};

bool on_curve(const FusionMethod& method) {
    return method.knowledge == Knowledge::feasible_curve;
}

// Shows the estimate of each set and method of one half of the catalogue, in one repetition.
class RepetitionFusion {
  public:
    RepetitionFusion(const PreparedStudy& study, const StudyPoint& point, const CurveLikelihood& likelihood,
                     std::span<const double> weight)
        : study_(study),
          scenario_(study.scenarios[point.scenario_index]),
          likelihood_(likelihood),
          weight_(weight),
          profiles_(scenario_, study.nodes()),
          tension_N_(study.nodes()),
          per_sensor_(static_cast<std::size_t>(study.nodes()) * scenario_.curve.points()),
          sum_(scenario_.curve.points()) {}

    template <typename Show>  // show(set index, method index, tension_N)
    void paper_methods(const SolvedReadings& solved, int repetition, const Show& show) {
        profiles_.fill(solved, repetition);
        FusionInput input;
        input.unknown = profiles_.unknown();
        input.known = profiles_.known();
        input.weight = weight_;
        for (std::size_t s = 0; s < study_.sensor_sets.size(); ++s) {
            input.sensors = study_.sensor_sets[s];
            const SensorVote vote = take_vote(input.unknown, input.sensors);
            input.vote = &vote;
            for (std::size_t m = 0; m < study_.methods.size(); ++m) {
                if (on_curve(*study_.methods[m])) continue;
                study_.methods[m]->fuse(input, tension_N_);
                show(s, m, tension_N_);
            }
        }
    }

    template <typename Show>
    void curve_methods(const SolvedReadings& solved, int repetition, const Show& show) {
        const int points = scenario_.curve.points();
        for (int sensor = 0; sensor < study_.nodes(); ++sensor) {
            likelihood_.log_likelihood(
                sensor, solved.reading_N[solved.at(repetition, sensor)],
                std::span<double>(per_sensor_).subspan(static_cast<std::size_t>(sensor) * points, points));
        }
        FusionInput input;
        input.curve = &scenario_.curve;
        input.log_likelihood = sum_;
        for (std::size_t s = 0; s < study_.sensor_sets.size(); ++s) {
            input.sensors = study_.sensor_sets[s];
            add_log_likelihoods(per_sensor_, input.sensors, sum_);
            for (std::size_t m = 0; m < study_.methods.size(); ++m) {
                if (!on_curve(*study_.methods[m])) continue;
                study_.methods[m]->fuse(input, tension_N_);
                show(s, m, tension_N_);
            }
        }
    }

  private:
    const PreparedStudy& study_;
    const PreparedScenario& scenario_;
    const CurveLikelihood& likelihood_;
    std::span<const double> weight_;
    RepetitionProfiles profiles_;
    std::vector<double> tension_N_;   // nodes
    std::vector<double> per_sensor_;  // nodes x points
    std::vector<double> sum_;         // points
};

// Errors of all cells of a scenario and noise level, block by block and repetition by repetition.
struct ErrorTable {
    std::vector<std::vector<BlockSums>> block_sums;       // cells x blocks
    std::vector<std::vector<double>> repetition_error_N;  // cells x repetitions
};

void add_error(BlockSums& sums, double& repetition_error_N, std::span<const double> tension_N,
               std::span<const double> truth_N) {
    const double share = 1.0 / static_cast<double>(truth_N.size());
    double absolute_N = 0.0;
    double squared_N2 = 0.0;
    for (std::size_t node = 0; node < truth_N.size(); ++node) {
        const double error_N = tension_N[node] - truth_N[node];
        absolute_N += std::abs(error_N);
        squared_N2 += error_N * error_N;
        sums.node_abs_error_N[node] += std::abs(error_N);
        sums.node_signed_error_N[node] += error_N;
    }
    repetition_error_N = absolute_N * share;
    sums.error_N += repetition_error_N;
    sums.squared_error_N2 += squared_N2 * share;
}

void count_verification(BlockSums& sums, const SolvedReadings& solved, int repetition,
                        std::span<const int> sensors) {
    for (const int sensor : sensors) {
        const int verifying = solved.verifying[solved.at(repetition, sensor)];
        sums.unverified += verifying == 0;
        sums.ambiguous += verifying > 1;
    }
}

std::vector<storage::SensorWeightRecord> weight_shares(std::span<const double> weight) {
    double total = 0.0;
    for (const double w : weight) total += w;
    std::vector<storage::SensorWeightRecord> records;
    for (std::size_t node = 0; node < weight.size(); ++node) {
        records.push_back({static_cast<int>(node) + 1, weight[node] / total});
    }
    return records;
}

std::vector<storage::KnownDirectionBoundRecord> bounds(const PreparedStudy& study, const StudyPoint& point) {
    const PreparedScenario& scenario = study.scenarios[point.scenario_index];
    std::vector<storage::KnownDirectionBoundRecord> records;
    for (std::size_t s = 0; s < study.sensor_sets.size(); ++s) {
        const double bound_N =
            known_direction_bound_N(scenario.known_branch, scenario.truth.tension_N, study.sensor_sets[s],
                                    study.plan.noise_levels[point.noise_index].level);
        if (std::isfinite(bound_N)) records.push_back({static_cast<int>(s), bound_N});
    }
    return records;
}

}  // namespace

storage::FusionResult fuse_readings(const PreparedStudy& study, const StudyPoint& point,
                                    const SolvedReadings& solved, std::span<const double> weight, int jobs,
                                    FusionTimes& times) {
    const PreparedScenario& scenario = study.scenarios[point.scenario_index];
    const CurveLikelihood likelihood(scenario.curve, study.plan.noise_levels[point.noise_index].level);
    const RepetitionBlocks blocks{study.plan.repetitions};
    const std::size_t methods = study.methods.size();
    ErrorTable table;
    const std::vector<double> zeros(study.nodes(), 0.0);
    table.block_sums.assign(study.cells(),
                            std::vector<BlockSums>(blocks.count(), {0, 0, 0, 0, zeros, zeros}));
    table.repetition_error_N.assign(study.cells(), std::vector<double>(study.plan.repetitions));

    std::vector<FusionTimes> block_times(blocks.count());
    parallel_for_each_index(blocks.count(), jobs, [&](int block) {
        RepetitionFusion fusion(study, point, likelihood, weight);
        int repetition = 0;
        const auto add = [&](std::size_t s, std::size_t m, std::span<const double> tension_N) {
            BlockSums& sums = table.block_sums[s * methods + m][block];
            add_error(sums, table.repetition_error_N[s * methods + m][repetition], tension_N,
                      scenario.truth.tension_N);
            if (study.methods[m]->knowledge == Knowledge::direction_unknown) {
                count_verification(sums, solved, repetition, study.sensor_sets[s]);
            }
        };
        const double start_s = thread_processor_time_s();
        for (repetition = blocks.first(block); repetition < blocks.end(block); ++repetition) {
            fusion.paper_methods(solved, repetition, add);
        }
        const double middle_s = thread_processor_time_s();
        if (study.uses(Knowledge::feasible_curve)) {
            for (repetition = blocks.first(block); repetition < blocks.end(block); ++repetition) {
                fusion.curve_methods(solved, repetition, add);
            }
        }
        block_times[block].paper_methods_s = middle_s - start_s;
        block_times[block].feasible_curve_s = thread_processor_time_s() - middle_s;
    });

    storage::FusionResult result{
        point.scenario_index, point.noise_index, weight_shares(weight), {}, bounds(study, point)};
    result.cells.resize(study.cells());
    std::vector<int> block_sizes;
    for (int block = 0; block < blocks.count(); ++block) block_sizes.push_back(blocks.size(block));
    std::vector<double> set_times_s(study.sensor_sets.size());
    parallel_for_each_index(static_cast<int>(study.sensor_sets.size()), jobs, [&](int s) {
        const double start_s = thread_processor_time_s();
        for (std::size_t m = 0; m < methods; ++m) {
            const std::size_t cell = s * methods + m;
            result.cells[cell] =
                summarise_cell({s, study.methods[m]->name, static_cast<int>(study.sensor_sets[s].size()),
                                table.block_sums[cell], block_sizes, table.repetition_error_N[cell]});
        }
        set_times_s[s] = thread_processor_time_s() - start_s;
    });
    for (const FusionTimes& block : block_times) {
        times.paper_methods_s += block.paper_methods_s;
        times.feasible_curve_s += block.feasible_curve_s;
    }
    for (const double time_s : set_times_s) times.statistics_s += time_s;
    return result;
}

std::vector<std::vector<double>> fuse_repetition(const PreparedStudy& study, const StudyPoint& point,
                                                 const SolvedReadings& solved, std::span<const double> weight,
                                                 int repetition) {
    const CurveLikelihood likelihood(study.scenarios[point.scenario_index].curve,
                                     study.plan.noise_levels[point.noise_index].level);
    RepetitionFusion fusion(study, point, likelihood, weight);
    std::vector<std::vector<double>> estimates(study.cells());
    const auto keep = [&](std::size_t s, std::size_t m, std::span<const double> tension_N) {
        estimates[s * study.methods.size() + m].assign(tension_N.begin(), tension_N.end());
    };
    fusion.paper_methods(solved, repetition, keep);
    if (study.uses(Knowledge::feasible_curve)) fusion.curve_methods(solved, repetition, keep);
    return estimates;
}

}  // namespace capstan
