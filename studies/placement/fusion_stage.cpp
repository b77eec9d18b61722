#include "capstan/placement/fusion_stage.h"

#include <algorithm>
#include <cmath>

#include "capstan/estimation/information_bound.h"
#include "capstan/placement/cell_statistics.h"
#include "capstan/placement/repetition_blocks.h"
#include "capstan/placement/repetition_profiles.h"
#include "capstan/platform/clocks.h"
#include "capstan/platform/parallel_for.h"

namespace capstan {

namespace {

bool on_curve(const FusionMethod& method) {
    return method.knowledge == Knowledge::feasible_curve;
}

// Repetitions fused together: few enough that their profiles and likelihoods stay in the nearest caches.
constexpr int at_a_time = 10;

// The estimates of one sensor set over consecutive repetitions: methods of one half of the catalogue x
// repetitions x nodes.
struct SetEstimates {
    std::size_t set = 0;
    int first_repetition = 0;
    int repetitions = 0;
    int nodes = 0;
    std::vector<double> tension_N;

    int end_repetition() const { return first_repetition + repetitions; }
    std::span<double> of(std::size_t method, int repetition) {
        const std::size_t row = method * repetitions + (repetition - first_repetition);
        return std::span<double>(tension_N).subspan(row * nodes, nodes);
    }
};

// Fuses consecutive repetitions, half of the catalogue at a time, set after set, so that what belongs to one
// set stays near while all repetitions pass.
class BlockFusion {
  public:
    BlockFusion(const PreparedStudy& study, const StudyPoint& point, const SolvedReadings& solved,
                const CurveLikelihood& likelihood, std::span<const double> weight)
        : study_(study),
          scenario_(study.scenarios[point.scenario_index]),
          solved_(solved),
          likelihood_(likelihood),
          weight_(weight) {}

    // show(SetEstimates) once for each set
    template <typename Show>
    void paper_methods(int first, int end, const Show& show) {
        std::vector<RepetitionProfiles> profiles(end - first, RepetitionProfiles(scenario_, study_.nodes()));
        for (int r = first; r < end; ++r) profiles[r - first].fill(solved_, r);
        FusionInput input;
        input.weight = weight_;
        for_each_set(first, end, show, [&](SetEstimates& estimates, int r) {
            input.sensors = study_.sensor_sets[estimates.set];
            input.unknown = profiles[r - first].unknown();
            input.known = profiles[r - first].known();
            const SensorVote vote = take_vote(input.unknown, input.sensors);
            input.vote = &vote;
            fuse_half(input, estimates, r, false);
        });
    }

    template <typename Show>
    void curve_methods(int first, int end, const Show& show) {
        const std::size_t points = scenario_.curve.points();
        const std::size_t size = study_.nodes() * points;
        std::vector<double> per_sensor(size * (end - first));  // repetitions x nodes x points
        for (int r = first; r < end; ++r) {
            for (int sensor = 0; sensor < study_.nodes(); ++sensor) {
                const std::size_t start = (r - first) * size + sensor * points;
                likelihood_.log_likelihood(sensor, solved_.reading_N[solved_.at(r, sensor)],
                                           std::span<double>(per_sensor).subspan(start, points));
            }
        }
        std::vector<double> sum(points);
        FusionInput input;
        input.curve = &scenario_.curve;
        input.log_likelihood = sum;
        for_each_set(first, end, show, [&](SetEstimates& estimates, int r) {
            input.sensors = study_.sensor_sets[estimates.set];
            add_log_likelihoods(std::span<const double>(per_sensor).subspan((r - first) * size, size),
                                input.sensors, sum);
            fuse_half(input, estimates, r, true);
        });
    }

  private:
    template <typename Show, typename Fuse>
    void for_each_set(int first, int end, const Show& show, const Fuse& fuse) {
        SetEstimates estimates{0, first, end - first, study_.nodes(), {}};
        estimates.tension_N.resize(study_.methods.size() * (end - first) * study_.nodes());
        for (std::size_t s = 0; s < study_.sensor_sets.size(); ++s) {
            estimates.set = s;
            for (int r = first; r < end; ++r) fuse(estimates, r);
            show(estimates);
        }
    }

    void fuse_half(const FusionInput& input, SetEstimates& estimates, int repetition, bool curve) {
        for (std::size_t m = 0; m < study_.methods.size(); ++m) {
            if (on_curve(*study_.methods[m]) == curve) {
                study_.methods[m]->fuse(input, estimates.of(m, repetition));
            }
        }
    }

    const PreparedStudy& study_;
    const PreparedScenario& scenario_;
    const SolvedReadings& solved_;
    const CurveLikelihood& likelihood_;
    std::span<const double> weight_;
};

// Errors of all cells of a scenario and noise level, block by block and repetition by repetition.
struct ErrorTable {
    std::vector<std::vector<BlockSums>> block_sums;       // cells x blocks
    std::vector<std::vector<double>> repetition_error_N;  // cells x repetitions
};

void add_error(BlockSums& sums, double& repetition_error_N, std::span<const double> tension_N,
               std::span<const double> truth_N) {
    const double fraction = 1.0 / static_cast<double>(truth_N.size());
    double* node_abs_N = sums.node_abs_error_N.data();
    double* node_signed_N = sums.node_signed_error_N.data();
    double absolute_N = 0.0;
    double squared_N2 = 0.0;
    for (std::size_t node = 0; node < truth_N.size(); ++node) {
        const double error_N = tension_N[node] - truth_N[node];
        absolute_N += std::abs(error_N);
        squared_N2 += error_N * error_N;
        node_abs_N[node] += std::abs(error_N);
        node_signed_N[node] += error_N;
    }
    repetition_error_N = absolute_N * fraction;
    sums.error_N += repetition_error_N;
    sums.squared_error_N2 += squared_N2 * fraction;
}

// Shares out the processor time of a block over what it went to, by wall time.
class BlockClock {
  public:
    /// The time since the last call, or since the beginning, went to `part`.
    void enter(double FusionTimes::*part) {
        const double now_s = wall_time_s();
        wall_.*part += now_s - last_s_;
        last_s_ = now_s;
    }

    FusionTimes processor_times() const {
        const double wall_s = wall_.paper_methods_s + wall_.feasible_curve_s + wall_.statistics_s;
        const double scale = (thread_processor_time_s() - processor_start_s_) / wall_s;
        return {wall_.paper_methods_s * scale, wall_.feasible_curve_s * scale, wall_.statistics_s * scale};
    }

  private:
    double processor_start_s_ = thread_processor_time_s();
    double last_s_ = wall_time_s();
    FusionTimes wall_;
};

struct Verification {
    int unverified = 0;
    int ambiguous = 0;
};

Verification count_verification(const SolvedReadings& solved, const SetEstimates& estimates,
                                std::span<const int> sensors) {
    Verification count;
    for (int r = 0; r < estimates.repetitions; ++r) {
        for (const int sensor : sensors) {
            const int verifying = solved.verifying[solved.at(estimates.first_repetition + r, sensor)];
            count.unverified += verifying == 0;
            count.ambiguous += verifying > 1;
        }
    }
    return count;
}

std::vector<storage::SensorWeightRecord> weight_fractions(std::span<const double> weight) {
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
        BlockFusion fusion(study, point, solved, likelihood, weight);
        BlockClock clock;
        const auto sum_up = [&](SetEstimates& estimates, bool curve) {
            clock.enter(curve ? &FusionTimes::feasible_curve_s : &FusionTimes::paper_methods_s);
            const Verification verification =
                count_verification(solved, estimates, study.sensor_sets[estimates.set]);
            for (std::size_t m = 0; m < methods; ++m) {
                if (on_curve(*study.methods[m]) != curve) continue;
                const std::size_t cell = estimates.set * methods + m;
                BlockSums& sums = table.block_sums[cell][block];
                for (int r = estimates.first_repetition; r < estimates.end_repetition(); ++r) {
                    add_error(sums, table.repetition_error_N[cell][r], estimates.of(m, r),
                              scenario.truth.tension_N);
                }
                if (study.methods[m]->knowledge == Knowledge::direction_unknown) {
                    sums.unverified += verification.unverified;
                    sums.ambiguous += verification.ambiguous;
                }
            }
            clock.enter(&FusionTimes::statistics_s);
        };
        const int end = blocks.end(block);
        for (int first = blocks.first(block); first < end; first += at_a_time) {
            const int past = std::min(first + at_a_time, end);
            if (study.uses(Knowledge::direction_known) || study.uses(Knowledge::direction_unknown)) {
                fusion.paper_methods(first, past, [&](SetEstimates& estimates) { sum_up(estimates, false); });
            }
            if (study.uses(Knowledge::feasible_curve)) {
                fusion.curve_methods(first, past, [&](SetEstimates& estimates) { sum_up(estimates, true); });
            }
        }
        block_times[block] = clock.processor_times();
    });

    storage::FusionResult result{
        point.scenario_index, point.noise_index, weight_fractions(weight), {}, bounds(study, point)};
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
        times.statistics_s += block.statistics_s;
    }
    for (const double time_s : set_times_s) times.statistics_s += time_s;
    return result;
}

std::vector<std::vector<double>> fuse_repetition(const PreparedStudy& study, const StudyPoint& point,
                                                 const SolvedReadings& solved, std::span<const double> weight,
                                                 int repetition) {
    const CurveLikelihood likelihood(study.scenarios[point.scenario_index].curve,
                                     study.plan.noise_levels[point.noise_index].level);
    BlockFusion fusion(study, point, solved, likelihood, weight);
    std::vector<std::vector<double>> cells(study.cells());
    const auto keep = [&](SetEstimates& estimates, bool curve) {
        for (std::size_t m = 0; m < study.methods.size(); ++m) {
            if (on_curve(*study.methods[m]) != curve) continue;
            const auto tension_N = estimates.of(m, repetition);
            cells[estimates.set * study.methods.size() + m].assign(tension_N.begin(), tension_N.end());
        }
    };
    fusion.paper_methods(repetition, repetition + 1, [&](SetEstimates& e) { keep(e, false); });
    if (study.uses(Knowledge::feasible_curve)) {
        fusion.curve_methods(repetition, repetition + 1, [&](SetEstimates& e) { keep(e, true); });
    }
    return cells;
}

}  // namespace capstan
