#include "capstan/placement/study_cost.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "capstan/placement/cell_statistics.h"
#include "capstan/placement/fusion_stage.h"
#include "capstan/placement/prepared_study.h"
#include "capstan/placement/single_sensor_stage.h"
#include "capstan/placement/study_shard.h"
#include "capstan/platform/clocks.h"
#include "capstan/platform/work_meter.h"

namespace capstan {

namespace {

// Time of one part in the plan's repetitions; costs grow in proportion to them.
struct Timing {
    double single_sensor_s = 0.0;
    double fusion_s = 0.0;
    int parts = 0;

    double part_s() const { return (single_sensor_s + fusion_s) / parts; }
};

class Pilot {
  public:
    Pilot(std::span<const StudyPlan> plans, const PilotOptions& options) : plans_(plans), options_(options) {}

    StudyCost run() {
        count();
        time_parts();
        predict();
        return cost_;
    }

  private:
    static int nodes_of(const StudyPlan& plan) { return plan.transmission.cable.segments + 1; }

    // The true motions and tables of all studies are what every shard computes for itself.
    void count() {
        cost_.studies = static_cast<int>(plans_.size());
        expect_work(2.0 * static_cast<double>(plans_.size()));  // until it is known how long the rest takes
        cost_.repetitions = plans_.front().repetitions;
        for (const StudyPlan& plan : plans_) {
            const double start_s = thread_processor_time_s();
            const PreparedStudy study = prepare(plan);
            cost_.shard_preparation_s += thread_processor_time_s() - start_s;
            const int parts = parts_of({&plan, 1});
            cost_.parts += parts;
            cost_.cells += static_cast<long long>(parts) * study.cells();
            cost_.readings += static_cast<long long>(parts) * plan.repetitions * nodes_of(plan);
            note_work();
        }
    }

    // Visits the studies in strides, so that the first ones already cover the complete range: each study
    // once, then again with another part while there is time.
    void time_parts() {
        const double start_s = thread_processor_time_s();
        const int max_parts = parts_of(plans_.first(1));
        for (int round = 0; round < max_parts; ++round) {
            for (const std::size_t k : spread_order()) {
                const bool enough = thread_processor_time_s() - start_s >= options_.seconds;
                if (enough && timings_.count(nodes_of(plans_[k])) != 0) continue;
                if (round < parts_of(plans_.subspan(k, 1))) time_part(plans_[k], round);
                tell_done(thread_processor_time_s() - start_s);
            }
        }
    }

    void tell_done(double timed_s) const {
        const double counted_s = cost_.shard_preparation_s;
        const double all_s = counted_s + std::max(options_.seconds, timed_s);
        if (MeterScope::meter() != nullptr && all_s > 0.0)
            MeterScope::meter()->replan((counted_s + timed_s) / all_s);
    }

    // Steps of the golden section visit all and never cluster.
    std::vector<std::size_t> spread_order() const {
        std::vector<std::size_t> order(plans_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        const auto place = [](std::size_t k) {
            const double turns = 0.6180339887498949 * static_cast<double>(k);
            return turns - std::floor(turns);
        };
        std::sort(order.begin(), order.end(),
                  [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
        return order;
    }

    void time_part(const StudyPlan& plan, int part) {
        StudyPlan few = plan;
        few.repetitions = std::min(plan.repetitions, options_.repetitions);
        const PreparedStudy study = prepare(few);
        const int scenarios = static_cast<int>(study.scenarios.size());
        const int s = part % scenarios;
        const int noise = part / scenarios;
        const double scale = static_cast<double>(plan.repetitions) / few.repetitions;

        Timing& timing = timings_[nodes_of(plan)];
        double ignored_s = 0.0;
        double start_s = thread_processor_time_s();
        const SolvedReadings solved = solve_readings(study, {s, noise}, 1, ignored_s);
        const auto errors_N = sensor_errors_N(summarise_sensors(study, {s, noise}, solved, 1));
        timing.single_sensor_s += scale * (thread_processor_time_s() - start_s);

        // The weights of other instants take the same time to use.
        const std::vector<std::vector<double>> all_errors_N(scenarios, errors_N);
        FusionTimes times;
        start_s = thread_processor_time_s();
        const auto result =
            fuse_readings(study, {s, noise}, solved, sensor_weights(study, all_errors_N, s), 1, times);
        timing.fusion_s += scale * (thread_processor_time_s() - start_s);
        for (const storage::CellRecord& cell : result.cells) {
            half_widths_N_.push_back(normal_95 * cell.standard_error_N / std::sqrt(scale));
        }
        ++timing.parts;
        ++cost_.pilot_parts;
        cost_.pilot_repetitions = few.repetitions;
    }

    void predict() {
        cost_.processor_s = cost_.shard_preparation_s;
        double single_sensor_s = 0.0;
        for (const StudyPlan& plan : plans_) {
            const Timing& timing = timings_.at(nodes_of(plan));
            const int parts = parts_of({&plan, 1});
            cost_.processor_s += parts * timing.part_s();
            single_sensor_s += parts * timing.single_sensor_s / timing.parts;
        }
        cost_.weight_part_s = single_sensor_s / cost_.parts;
        cost_.largest_half_width_N = *std::max_element(half_widths_N_.begin(), half_widths_N_.end());
        cost_.median_half_width_N = quantile(half_widths_N_, 0.5);
    }

    std::span<const StudyPlan> plans_;
    const PilotOptions& options_;
    StudyCost cost_;
    std::map<int, Timing> timings_;  // by nodes
    std::vector<double> half_widths_N_;
};

}  // namespace

int parts_solved_again(std::span<const StudyPlan> plans, int shards) {
    const Deal deal = deal_out(plans, shards);
    int again = 0;
    for (std::size_t k = 0; k < plans.size(); ++k) {
        const StudyPlan& plan = plans[k];
        std::vector<Regime> regime;  // scenarios
        for (const RegimeInstants& each : plan.regimes) {
            regime.insert(regime.end(), each.samples.size(), each.regime);
        }
        const int scenarios = static_cast<int>(regime.size());
        for (int noise = 0; noise < static_cast<int>(plan.noise_levels.size()); ++noise) {
            std::set<std::pair<int, int>> needed;  // shard, source
            for (int fused = 0; fused < scenarios; ++fused) {
                const int shard = deal.owner(k, noise, fused);
                for (int source = 0; source < scenarios; ++source) {
                    const bool gives = plan.weight_source == WeightSource::mass_motion
                                           ? regime[source] == Regime::mass
                                           : regime[source] == regime[fused];
                    if (gives && deal.owner(k, noise, source) != shard) needed.insert({shard, source});
                }
            }
            again += static_cast<int>(needed.size());
        }
    }
    return again;
}

double StudyCost::processor_s_with(std::span<const StudyPlan> plans, int shards) const {
    return processor_s + (shards - 1) * shard_preparation_s +
           parts_solved_again(plans, shards) * weight_part_s;
}

StudyCost predict_cost(std::span<const StudyPlan> plans, const PilotOptions& options) {
    return Pilot(plans, options).run();
}

}  // namespace capstan
