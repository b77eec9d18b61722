#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/world_values.h"
#include "capstan/config/config_writer.h"
#include "capstan/placement/stored_study.h"
#include "capstan/storage/study_store.h"
#include "capstan/worlds/sensor_places.h"
#include "capstan/worlds/stored_worlds.h"

namespace capstan::answers {

namespace {

using reports::Data;
using reports::Table;

// Errors are compared with their discretisation errors; above this fraction the grid is too coarse.
constexpr double max_discretisation_fraction = 0.1;

struct StatedFractions {
    double of_error = 0.0;
    double of_quantile = 0.0;
    double largest() const { return std::max(of_error, of_quantile); }
};

StatedFractions discretisation_fractions(const Expected& expected) {
    return {std::abs(expected.discretisation_N) / std::max(expected.objective.value_N, 1e-12),
            std::abs(expected.error_95_discretisation_N) / std::max(expected.error_95_N, 1e-12)};
}

std::string grid_words(const StudyPlan& plan, const WorldAnswer& found) {
    const GridError& grid = found.grid;
    double largest = discretisation_fractions(found.no_sensor).largest();
    for (const Expected& baseline : found.baselines)
        largest = std::max(largest, discretisation_fractions(baseline).largest());
    for (const PriceBest& best : found.prices)
        largest = std::max(largest, discretisation_fractions(best.expected).largest());
    const Expected& advised = found.recommended ? found.best().expected : found.no_sensor;
    const StatedFractions of_advised = discretisation_fractions(advised);
    const CableSpecification& cable = plan.transmission.cable;
    std::string remedy;
    if (largest > max_discretisation_fraction)
        remedy =
            fmt::format(" That is more than a tenth: raise transmission.segments{}.",
                        cable.static_friction > cable.dynamic_friction
                            ? ", or state no more static than dynamic friction, because what is beyond it "
                              "delays each segment by itself and counts less with more segments"
                            : "");
    return fmt::format(
        "Discretisation: how much both values would fall with infinitely many segments (Richardson's extrapolation from {0} and "
        "{1} segments on {2} of the worlds; order {3:.2f}, measured over all sets of the table, with {4} segments too). For the {5} it is "
        "{6:+.4f} N or {7:.0f}% of the error and {8:+.4f} N or {9:.0f}% of the value for 95% of worlds, and at most {10:.0f}% in this "
        "table.{11}",
        grid.segments, 4 * grid.segments, grid.worlds, grid.order, 2 * grid.segments,
        found.recommended ? "recommended set" : "set without a sensor", advised.discretisation_N,
        100.0 * of_advised.of_error, advised.error_95_discretisation_N, 100.0 * of_advised.of_quantile,
        100.0 * largest, remedy);
}

std::string target_words(const StudyPlan& plan, const WorldAnswer& found) {
    const double target_N = plan.placement.target_error_N;
    if (target_N <= 0.0) return {};
    if (!found.cheapest_below_target)
        return fmt::format(" No set that was compared stays below the target of {:g} N.", target_N);
    const PriceBest& cheapest = found.prices[*found.cheapest_below_target];
    return fmt::format(" The cheapest set below the target of {:g} N is {}, price {:g}, with {:.3f} N.",
                       target_N, found.words(cheapest.expected.candidate), cheapest.price,
                       cheapest.expected.objective.value_N);
}

std::string flips_words(const WorldAnswer& found) {
    std::vector<std::string> flips;
    for (const Robustness& each : found.robustness)
        if (each.flips) flips.push_back(title_of_condition(each.condition));
    if (flips.empty()) return "The advice does not change with half or twice the stated uncertainty.";
    return fmt::format("The advice changes with: {}. So the stated uncertainty decides it.",
                       fmt::join(flips, "; "));
}

// What the band is worth where the estimator is told too little uncertainty.
std::string narrow_band_words(const WorldAnswer& found) {
    // A hundredth is what the worlds leave open.
    constexpr double honest_fraction = 0.94;
    for (const Robustness& each : found.robustness) {
        if (each.condition != Condition::wider_worlds) continue;
        return fmt::format(
            " If the cables are twice as uncertain as stated and the estimator is not told, its error is {:.3f} N and its 95% band "
            "holds {:.0f}% of the true tensions{}.",
            each.error.value_N, 100.0 * each.covered_fraction,
            each.covered_fraction < honest_fraction
                ? ": it is too narrow then, so state the uncertainty rather too large"
                : "");
    }
    return {};
}

// Where the band of a stated set promises more than it holds, in worlds as they are stated.
std::string missed_band_words(const StudyPlan& plan, const WorldAnswer& found) {
    constexpr double too_few = 0.93;
    int sets = 0;
    double least = 1.0;
    for (const PriceBest& best : found.prices) {
        if (best.expected.covered_at_most >= too_few) continue;
        ++sets;
        least = std::min(least, best.expected.covered_fraction);
    }
    if (sets == 0) return {};
    const CableSpecification& cable = plan.transmission.cable;
    return fmt::format(
        " Bands that are too narrow, because they hold less than 93%: {} of {}, the worst {:.0f}%.{}", sets,
        found.prices.size(), 100.0 * least,
        cable.static_friction > cable.dynamic_friction
            ? " With static friction above the dynamic one a segment sticks or slides, but the estimator takes what it "
              "believes as normal; more segments or better sensors help."
            : "");
}

std::string bound_note(const WorldAnswer& found) {
    if (!found.bound) return {};
    return fmt::format(
        " All sets are too many, so that sets were grown by the sensor that helps most. At most worse: no allowed set, at any "
        "price, has {} smaller by more than this. It is the distance to all {} usable sensors together, {:.3f} N: with worlds "
        "drawn from what the estimator is told, the exact posterior mean of more sensors never has a larger mean square error, "
        "and, where the posterior is symmetric, no larger mean absolute error; the ensemble filter obeyed this within 2% of the "
        "mean square error wherever it was tested.",
        found.bound->is_of_rms ? "a root mean square error" : "an error",
        found.set(found.bound->all.candidate).count(),
        found.bound->is_of_rms ? found.bound->all.rms_N : found.bound->all.objective.value_N);
}

std::vector<reports::Column> price_columns(const WorldAnswer& found) {
    std::vector<reports::Column> columns = {{"price", "price"},
                                            {"set", "sensors"},
                                            {"what", ""},
                                            {"expected_error_N", "error", "N", ".3f"},
                                            {"monte_carlo_interval_N", "Monte-Carlo interval", "N", ".3f"},
                                            {"error_95_N", "95% of worlds", "N", ".3f"},
                                            {"load_end_error_N", "load end", "N", ".3f"},
                                            {"worst_place_error_N", "worst place", "N", ".3f"},
                                            {"covered_fraction", "in band", "", ".1%"},
                                            {"discretisation_error_N", "discretisation", "N", "+.3f"},
                                            {"error_95_discretisation_error_N", "of 95%", "N", "+.3f"},
                                            {"same_reading", "same readings"},
                                            {"not_distinguished", "as good"}};
    if (found.bound) columns.push_back({"at_most_worse_N", "at most worse", "N", ".3f"});
    return columns;
}

Table front_table(const WorldAnswer& found) {
    Table table{"world_front",
                "Expected error against price, on independent worlds",
                {"price", "sensor_count", "set", "error_N", "interval_low_N", "interval_high_N", "error_95_N",
                 "recommended"},
                {}};
    const auto add = [&](const Expected& expected, bool is_recommended) {
        const Candidate& set = found.set(expected.candidate);
        table.rows.push_back({set.price, std::int64_t{set.count()}, found.words(expected.candidate),
                              expected.objective.value_N, expected.objective.low_N, expected.objective.high_N,
                              expected.error_95_N, std::int64_t{is_recommended ? 1 : 0}});
    };
    add(found.no_sensor, !found.recommended);
    for (std::size_t k = 0; k < found.prices.size(); ++k)
        add(found.prices[k].expected, found.recommended == k);
    return table;
}

Table place_table(const WorldAnswer& found) {
    Table table{"world_place",
                "Places of the best set of each price",
                {"price", "kind", "place_m", "error_N", "recommended"},
                {}};
    for (std::size_t k = 0; k < found.prices.size(); ++k) {
        const Expected& expected = found.prices[k].expected;
        for (const int sensor : found.set(expected.candidate).sensors) {
            const SensorOffer& offer = found.offers[static_cast<std::size_t>(sensor)];
            const std::string kind = std::string(name_of(offer.kind)) + (offer.cable == 1 ? ", cable B" : "");
            table.rows.push_back({found.prices[k].price, kind, offer.place_m, expected.objective.value_N,
                                  std::int64_t{found.recommended == k ? 1 : 0}});
        }
    }
    return table;
}

}  // namespace

namespace {

std::string far_end_words(const Uncertainty& unknown) {
    if (unknown.far_end != FarEndKind::recorded) return {};
    return fmt::format(
        " The far end moves as recorded{}, in each world another stretch; the estimator assumes a random motion that stays "
        "within {:.3g} mm 95% of the time and has 95% of its power below {:.3g} Hz.",
        unknown.far_end_log.empty() ? std::string() : " in " + unknown.far_end_log,
        1e3 * unknown.far_end_range_m, unknown.far_end_bandwidth_Hz);
}

// The answer in one line; sentence_of() has the rest.
std::string headline_of(const StudyPlan& plan, const WorldAnswer& found) {
    const Estimated& none = found.no_sensor.objective;
    if (!found.recommended)
        return fmt::format("no set of sensors is better than none; the error is then {:.3f} N.",
                           none.value_N);
    const Expected& expected = found.best().expected;
    return fmt::format("use {}: {} {:.3f} N{}; without any sensor {:.3f} N.", found.words(expected.candidate),
                       plan.placement.objective == PlacementObjective::quantile_95
                           ? "error in 95% of the worlds below"
                           : "expected error",
                       expected.objective.value_N,
                       plan.placement.objective == PlacementObjective::quantile_95
                           ? std::string()
                           : fmt::format(", in 95% of the worlds below {:.3f} N", expected.error_95_N),
                       none.value_N);
}

}  // namespace

reports::Answer world_answer(const StudyPlan& plan, const WorldAnswer& found, std::int64_t study_id) {
    reports::Answer answer;
    answer.id = "worlds";
    answer.kind = "Sensor placement";
    answer.title = study_id > 0 ? fmt::format("Study {} ({})", study_id, plan.name) : plan.name;
    answer.headline = headline_of(plan, found);
    answer.values = {{"study_id", study_id > 0 ? Data(study_id) : Data()},
                     {"name", plan.name},
                     {"seed", plan.seed},
                     {"worlds", found.worlds},
                     {"candidates", found.candidates.size()},
                     {"trials", found.trials},
                     {"recommendations", Data::list({recommendation_data(plan, found)})},
                     {"prices", prices_data(plan, found)},
                     {"robustness", robustness_data(found)},
                     {"grids", grid_data(found.grid)},
                     {"paper_estimators", Data::list()}};
    for (const PaperComparison& each : found.paper)
        answer.values["paper_estimators"].push_back({{"estimator", title_of_condition(each.condition)},
                                                     {"error_N", each.error.value_N},
                                                     {"interval_95_N", interval_data(each.error)}});

    reports::AnswerSection prices{
        .id = "prices",
        .heading = "Error against price",
        .prose = fmt::format("{} sets of sensors, compared on {} common worlds, judged by the {}.{}",
                             found.candidates.size() - (found.bound ? 2 : 1), found.worlds,
                             objective_words(plan.placement.objective), target_words(plan, found)),
        .tables = {{"prices", "", price_columns(found), answer.values["prices"]}},
        .note = fmt::format(
            "All numbers are from {} worlds that had no part in choosing the set of a price; the price was chosen on them. Error: {}. 95% of worlds: the error stays below this in "
            "95% of them. In band: true tensions within the estimator's 95% band; 95% if it is honest. Same readings: sets with the sensors "
            "elsewhere in the same straight pieces of conduit, where the tension is the same; they have the same errors, and the first of them is "
            "named. As good: further sets of the price that a paired t test does not tell from the best (5% over all sets and looks).{}{} {}",
            found.worlds, objective_words(plan.placement.objective), missed_band_words(plan, found),
            bound_note(found), grid_words(plan, found))};
    reports::AnswerSection gains{
        .id = "gains",
        .heading = "What else would help",
        .tables = {{"gains",
                    "",
                    {{"of", ""},
                     {"gain_N", "gain", "N", "+.3f"},
                     {"interval_95_N", "95% interval", "N", "+.3f"},
                     {"set", "sensors then"}},
                    gains_data(plan, found)}},
        .note =
            "Gain: by how much the error of the recommended sensors falls, paired on the same worlds. A calibration tells the "
            "estimator the exact value."};
    reports::AnswerSection robustness{.id = "robustness",
                                      .heading = "If the stated uncertainty is wrong",
                                      .prose = flips_words(found) + narrow_band_words(found),
                                      .tables = {{"robustness",
                                                  "",
                                                  {{"widths", ""},
                                                   {"error_N", "error", "N", ".3f"},
                                                   {"covered_fraction", "in band", "", ".1%"},
                                                   {"best", "best of that price"},
                                                   {"loss_N", "recommended is worse by", "N", ".3f"},
                                                   {"advice_flips", "advice changes"}},
                                                  answer.values["robustness"]}}};
    answer.sections = {{.id = "advice", .prose = sentence_of(plan, found) + far_end_words(plan.uncertainty)},
                       std::move(prices),
                       {.id = "places", .heading = "Where the sensors go"},
                       std::move(gains),
                       std::move(robustness)};
    if (!found.paper.empty())
        answer.sections.push_back(
            {.id = "paper_estimators",
             .heading = "The paper's estimators with the recommended sensors",
             .tables = {{"paper_estimators",
                         "",
                         {{"estimator", ""},
                          {"error_N", "error", "N", ".3f"},
                          {"interval_95_N", "95% interval", "N", ".3f"}},
                         answer.values["paper_estimators"]}},
             .note =
                 "Over time, each from its own last estimate, with the nominal cable. The W methods weigh a sensor by 1 / the "
                 "mean error of its own estimate in 10 other worlds."});
    answer.drawn = {front_table(found), place_table(found)};
    answer.config_text = config::config_text(plan, config::Comments::none);
    return answer;
}

reports::Answer stored_world_answer(storage::Database& database, std::int64_t study_id,
                                    const StudyPlan& plan) {
    require_complete(database, study_id, storage::load_study(database, study_id));
    return world_answer(plan, run_worlds(database, study_id, plan, {}), study_id);
}

reports::Answer conclusions_answer(storage::Database& database, std::int64_t study_id) {
    const StoredStudy stored = load_stored_study(database, study_id);
    if (stored.plan.uncertainty.is_stated) return stored_world_answer(database, study_id, stored.plan);
    return recommendation_answer(read_conclusions(database, study_id), stored.plan);
}

}  // namespace capstan::answers
