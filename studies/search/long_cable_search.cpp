#include <algorithm>
#include <limits>
#include <map>

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/fusion_stage.h"
#include "capstan/placement/single_sensor_stage.h"
#include "capstan/plan/placement_constraints.h"
#include "capstan/platform/clocks.h"
#include "capstan/platform/work_meter.h"
#include "capstan/search/information_search.h"
#include "capstan/search/sensor_placement.h"

namespace capstan {

namespace {

using Nodes = std::vector<int>;

// A search tries hundreds of layouts one after the other; its choice is judged with all repetitions.
constexpr int search_repetitions = 400;
constexpr int max_searched_sensors = 12;
constexpr int farthest_move = 3;

// The best method of a layout, over the duty cycle.
struct Rating {
    double error_N = std::numeric_limits<double>::infinity();
    std::string method;
    std::vector<double> block_error_N;

    Score score() const { return {error_N, block_error_N}; }
};

// A regime's duty fraction, shared equally by its instants.
double duty_fraction(const StudyPlan& plan, const PreparedScenario& scenario) {
    for (const RegimeInstants& regime : plan.regimes) {
        if (regime.regime == scenario.regime) {
            return regime.duty_fraction / static_cast<double>(regime.samples.size());
        }
    }
    return 0.0;
}

StudyPlan with_repetitions(StudyPlan plan, int repetitions) {
    plan.repetitions = repetitions;
    return plan;
}

// Rates layouts on the same draws, each once.
class LayoutRater {
  public:
    LayoutRater(StudyPlan plan, const PlacementOptions& options, std::uint32_t first_draw)
        : plan_(std::move(plan)), options_(options), study_(prepare(plan_)) {
        double processor_time_s = 0.0;
        std::vector<std::vector<double>> errors_N;  // scenarios x nodes
        for (int s = 0; s < scenarios(); ++s) {
            const StudyPoint own{s, options.noise_index};
            const SolvedReadings readings = solve_readings(study_, own, options.jobs, processor_time_s);
            errors_N.push_back(sensor_errors_N(summarise_sensors(study_, own, readings, options.jobs)));
            const StudyPoint point{s, options.noise_index, first_draw};
            solved_.push_back(
                first_draw == 0 ? readings : solve_readings(study_, point, options.jobs, processor_time_s));
        }
        for (int s = 0; s < scenarios(); ++s) weights_.push_back(sensor_weights(study_, errors_N, s));
    }

    const PreparedStudy& study() const { return study_; }
    int rated() const { return static_cast<int>(ratings_.size()); }

    const Rating& rate(const Nodes& layout) {
        rate_all({layout});
        return ratings_.at(layout);
    }

    void rate_all(const std::vector<Nodes>& layouts) {
        study_.sensor_sets.clear();
        for (const Nodes& layout : layouts) {
            if (ratings_.count(layout) == 0) study_.sensor_sets.push_back(layout);
        }
        if (study_.sensor_sets.empty()) return;
        std::map<std::pair<int, std::string>, Rating> sums;
        for (int s = 0; s < scenarios(); ++s) {
            FusionTimes times;
            const auto result = fuse_readings(study_, {s, options_.noise_index}, solved_[s], weights_[s],
                                              options_.jobs, times);
            for (const storage::CellRecord& cell : result.cells)
                add(cell, duty_fraction(plan_, study_.scenarios[s]), sums);
        }
        for (auto& [key, rating] : sums) {
            Rating& best = ratings_[study_.sensor_sets[key.first]];
            if (rating.error_N >= best.error_N) continue;
            best = std::move(rating);
            best.method = key.second;
        }
    }

  private:
    int scenarios() const { return static_cast<int>(study_.scenarios.size()); }

    static void add(const storage::CellRecord& cell, double fraction,
                    std::map<std::pair<int, std::string>, Rating>& sums) {
        if (find_fusion_method(cell.method)->knowledge == Knowledge::direction_known) return;
        Rating& rating = sums[{cell.set_index, cell.method}];
        if (rating.block_error_N.empty()) {
            rating.error_N = 0.0;
            rating.block_error_N.assign(cell.block_mean_abs_error_N.size(), 0.0);
        }
        rating.error_N += fraction * cell.mean_abs_error_N;
        for (std::size_t b = 0; b < rating.block_error_N.size(); ++b) {
            rating.block_error_N[b] += fraction * cell.block_mean_abs_error_N[b];
        }
    }

    StudyPlan plan_;
    const PlacementOptions& options_;
    PreparedStudy study_;
    std::vector<SolvedReadings> solved_;        // scenarios
    std::vector<std::vector<double>> weights_;  // scenarios x nodes
    std::map<Nodes, Rating> ratings_;
};

class GreedySearch {
  public:
    GreedySearch(LayoutRater& rater, const PlacementPlan& plan)
        : rater_(rater), constraints_(plan, rater.study().nodes()), usable_(constraints_.usable_nodes()) {}

    /// With the one additional sensor that lowers the error most; nothing if none is allowed.
    std::optional<Nodes> grown(const Nodes& layout) {
        std::vector<Nodes> next;
        for (const int node : usable_) {
            if (std::binary_search(layout.begin(), layout.end(), node)) continue;
            Nodes larger = layout;
            larger.insert(std::upper_bound(larger.begin(), larger.end(), node), node);
            if (constraints_.allow_on_the_way(larger)) next.push_back(std::move(larger));
        }
        return best_of(next);
    }

    /// Single sensors moved by a few nodes, as long as that helps.
    Nodes improved(Nodes layout) {
        for (;;) {
            std::vector<Nodes> moved;
            for (std::size_t k = 0; k < layout.size(); ++k) {
                for (int by = -farthest_move; by <= farthest_move; ++by) {
                    Nodes other = layout;
                    other[k] += by;
                    std::sort(other.begin(), other.end());
                    const bool twice = std::adjacent_find(other.begin(), other.end()) != other.end();
                    const bool outside = other.front() < 0 || other.back() >= rater_.study().nodes();
                    if (by != 0 && !twice && !outside && constraints_.allow(other))
                        moved.push_back(std::move(other));
                }
            }
            const std::optional<Nodes> best = best_of(moved);
            if (!best || rater_.rate(*best).error_N >= rater_.rate(layout).error_N) return layout;
            layout = *best;
        }
    }

    const PlacementConstraints& constraints() const { return constraints_; }
    const Nodes& usable() const { return usable_; }

  private:
    std::optional<Nodes> best_of(const std::vector<Nodes>& layouts) {
        if (layouts.empty()) return std::nullopt;
        rater_.rate_all(layouts);
        return *std::min_element(layouts.begin(), layouts.end(), [&](const Nodes& a, const Nodes& b) {
            return rater_.rate(a).error_N < rater_.rate(b).error_N;
        });
    }

    LayoutRater& rater_;
    PlacementConstraints constraints_;
    Nodes usable_;
};

// The information of layouts over the duty cycle.
AverageInformation information_of(const PreparedStudy& study, int noise_index) {
    AverageInformation information;
    for (const PreparedScenario& scenario : study.scenarios) {
        information.scenarios.emplace_back(scenario, study.plan.noise_levels[noise_index].level);
        information.fraction.push_back(duty_fraction(study.plan, scenario));
    }
    return information;
}

JudgedLayout judged(const std::string& how, const Nodes& nodes, LayoutRater& searched,
                    const PlacementConstraints& constraints) {
    JudgedLayout layout;
    layout.how = how;
    layout.nodes = nodes;
    layout.searched_N = searched.rate(nodes).error_N;
    layout.cost = constraints.cost(nodes);
    layout.breaks = constraints.broken_by(nodes);
    layout.after_loss_N = -std::numeric_limits<double>::infinity();
    for (std::size_t lost = 0; lost < nodes.size(); ++lost) {
        Nodes left = nodes;
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(lost));
        layout.after_loss_N =
            std::max(layout.after_loss_N,
                     left.empty() ? std::numeric_limits<double>::infinity() : searched.rate(left).error_N);
    }
    return layout;
}

void judge_again(JudgedLayout& layout, const Nodes& optimum, LayoutRater& independent) {
    const Rating own = independent.rate(layout.nodes);
    layout.method = own.method;
    layout.independent = interval_of(own.score());
    layout.difference = interval_of(difference_of(own.score(), independent.rate(optimum).score()));
}

}  // namespace

PlacementAnswer search_long_cable(const StudyPlan& plan, const PlacementOptions& options) {
    if (plan.placement.objective != PlacementObjective::all_nodes ||
        plan.placement.largest_error_after_loss_N != PlacementPlan{}.largest_error_after_loss_N) {
        throw InvalidInput(
            {"placement.objective: this cable has too many layouts to score all, and the greedy search "
             "knows only \"all_nodes\" without largest_error_after_loss_N; set max_sensors or forbid "
             "nodes until all layouts fit"});
    }
    const double start_s = wall_time_s();
    LayoutRater searched(with_repetitions(plan, std::min(plan.repetitions, search_repetitions)), options, 0);
    LayoutRater independent(plan, options, independent_draws);
    GreedySearch search(searched, plan.placement);
    const int max_sensors = std::min(search.constraints().max_sensors(), max_searched_sensors);
    const AverageInformation information = information_of(searched.study(), options.noise_index);
    Nodes layout = plan.placement.required_nodes;
    std::sort(layout.begin(), layout.end());

    PlacementAnswer answer;
    answer.search = SearchKind::greedy;
    ScopeAnswer scope{"duty_cycle", "", {}, 0};
    const Rating everywhere = independent.rate(search.usable());
    expect_work(max_sensors);
    while (static_cast<int>(layout.size()) <= max_sensors) {
        if (!layout.empty() && search.constraints().allow(layout)) {
            CountAnswer count;
            count.sensors = static_cast<int>(layout.size());
            const MostInformative informative =
                max_information_layout(information, search.constraints(), count.sensors);
            // From two starts, so that a wrong first sensor need not stay.
            Nodes best = search.improved(layout);
            const Nodes other = search.improved(informative.nodes);
            if (searched.rate(other).error_N < searched.rate(best).error_N) best = other;
            count.optimum = judged("optimum", best, searched, search.constraints());
            count.beside.push_back(judged("greedy_forward", layout, searched, search.constraints()));
            count.beside.push_back(judged("d_optimal", informative.nodes, searched, search.constraints()));
            count.d_optimal_gap_nats = informative.at_most_nats - informative.nats;
            for (const LayoutFamily& family : layout_families()) {
                const Nodes nodes = family.layouts(count.sensors, searched.study().nodes()).front().nodes;
                count.beside.push_back(
                    judged(std::string(family.name), nodes, searched, search.constraints()));
            }
            judge_again(count.optimum, best, independent);
            for (JudgedLayout& beside : count.beside) judge_again(beside, best, independent);
            count.optimism_N = count.optimum.independent.value_N - count.optimum.searched_N;
            count.at_most_better_N = std::max(0.0, count.optimum.independent.value_N - everywhere.error_N);
            note_work();
            if (options.on_progress) {
                options.on_progress(std::to_string(count.sensors) + " of " + std::to_string(max_sensors) +
                                    " sensors placed");
            }
            scope.counts.push_back(std::move(count));
        }
        const std::optional<Nodes> larger = search.grown(layout);
        if (!larger) break;
        layout = *larger;
    }
    scope.recommend_count(plan.worthwhile_gain_N);
    answer.scopes.push_back(std::move(scope));
    answer.noise = plan.noise_levels[options.noise_index].label;
    answer.layouts = searched.rated();
    answer.candidates = searched.rated() * static_cast<int>(searched.study().methods.size());
    answer.repetitions = plan.repetitions;
    answer.times.score_s = answer.times.wall_s = wall_time_s() - start_s;
    return answer;
}

}  // namespace capstan
