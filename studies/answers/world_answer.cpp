#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "capstan/answers/placement_answers.h"
#include "capstan/config/config_writer.h"
#include "capstan/placement/stored_study.h"
#include "capstan/storage/study_store.h"
#include "capstan/worlds/sensor_places.h"
#include "capstan/worlds/stored_worlds.h"

namespace capstan::answers {

namespace {

using reports::Column;
using reports::Data;
using reports::Table;

Data interval_of(const Estimated& estimated) {
    return Data::list({estimated.low_N, estimated.high_N});
}

Data gain_data(const std::string& of, const Estimated& gain) {
    return {{"of", of}, {"gain_N", gain.value_N}, {"interval_95_N", interval_of(gain)}};
}

Data sensors_data(const StudyPlan& plan, const WorldAnswer& found, int candidate) {
    const Cable cable(plan.transmission.cable);
    Data sensors = Data::list();
    for (const int sensor : found.set(candidate).sensors) {
        const SensorOffer& offer = found.offers[static_cast<std::size_t>(sensor)];
        const int node = cable.nearest_node(offer.place_m) + 1;
        Data data{{"kind", name_of(offer.kind)}, {"place_m", offer.place_m}, {"node", node}};
        if (offer.kind == SensorKind::tension && has_two_cables(found.offers))
            data["cable"] = offer.cable == 0 ? "A" : "B";
        sensors.push_back(std::move(data));
    }
    return sensors;
}

Data expected_data(const StudyPlan& plan, const WorldAnswer& found, const Expected& expected) {
    return {{"set", found.words(expected.candidate)},
            {"sensors", sensors_data(plan, found, expected.candidate)},
            {"sensor_count", found.set(expected.candidate).count()},
            {"price", found.set(expected.candidate).price},
            {"expected_error_N", expected.objective.value_N},
            {"monte_carlo_interval_N", interval_of(expected.objective)},
            {"error_95_N", expected.error_95_N},
            {"rms_error_N", expected.rms_N},
            {"whole_cable_error_N", expected.whole_cable_N},
            {"load_end_error_N", expected.load_end_N},
            {"worst_place_error_N", expected.worst_place_N},
            {"covered_fraction", expected.covered_fraction}};
}

std::string title_of(Condition condition) {
    switch (condition) {
        case Condition::friction_known:
            return "calibrating friction";
        case Condition::wrap_known:
            return "measuring the bends";
        case Condition::stiffness_known:
            return "calibrating stiffness";
        case Condition::pretension_known:
            return "measuring pretension";
        case Condition::sensors_known:
            return "calibrating the sensors' zero and gain";
        case Condition::half_width:
            return "half as uncertain";
        case Condition::double_width:
            return "twice as uncertain";
        case Condition::wider_worlds:
            return "worlds twice as uncertain as the estimator is told";
        case Condition::paper_mean:
            return "the paper's Mean";
        case Condition::paper_mean_r:
            return "the paper's Mean-R";
        case Condition::paper_w_mean:
            return "the paper's W Mean";
        case Condition::paper_w_mean_r:
            return "the paper's W Mean-R";
        case Condition::as_stated:
        case Condition::finer_grid:
        case Condition::finest_grid:
            break;
    }
    return std::string(name_of(condition));
}

std::string objective_words(PlacementObjective objective) {
    switch (objective) {
        case PlacementObjective::all_nodes:
            return "mean over worlds of the tension error, averaged over the cable and the motion";
        case PlacementObjective::load_end:
            return "mean over worlds of the tension error at the load end, averaged over the motion";
        case PlacementObjective::worst_node:
            return "mean over worlds of the tension error at the cable's worst place, averaged over the motion";
        case PlacementObjective::quantile_95:
            return "value that 95% of the worlds stay below, of the tension error averaged over the cable and the motion";
    }
    return {};
}

// What a further sensor and every calibration would gain.
Data gains_data(const StudyPlan& plan, const WorldAnswer& found) {
    Data gains = Data::list();
    if (found.further) {
        Data further = gain_data("a further sensor", found.further_gain);
        further["set"] = found.words(*found.further);
        further["sensors"] = sensors_data(plan, found, *found.further);
        gains.push_back(std::move(further));
    }
    for (const KnowledgeGain& each : found.knowledge)
        gains.push_back(gain_data(title_of(each.condition), each.gain));
    return gains;
}

Data recommendation_data(const StudyPlan& plan, const WorldAnswer& found) {
    const Expected& expected = found.recommended ? found.best().expected : found.no_sensor;
    Data data = {{"objective", name_of(plan.placement.objective)}};
    data.update(expected_data(plan, found, expected));
    data["estimator"] = "ensemble_filter";
    data["no_sensor_error_N"] = found.no_sensor.objective.value_N;
    data["beats_no_sensor"] = found.recommended.has_value();
    data["gain_over_no_sensor"] = gain_data("the recommended sensors", found.gain_over_none);
    data["gains"] = gains_data(plan, found);
    data["discretisation_error_N"] = found.grid.error_N;
    Data ties = Data::list();
    if (found.recommended)
        for (const int tie : found.best().ties) ties.push_back(found.words(tie));
    data["not_told_apart"] = std::move(ties);
    data["sentence"] = sentence_of(plan, found);
    return data;
}

Data prices_data(const StudyPlan& plan, const WorldAnswer& found) {
    Data rows = Data::list();
    const auto row_of = [&](const Expected& expected, const std::string& what) {
        Data row = expected_data(plan, found, expected);
        row["what"] = what;
        return row;
    };
    rows.push_back(row_of(found.no_sensor, "motor position only"));
    for (const Expected& baseline : found.baselines) rows.push_back(row_of(baseline, "baseline"));
    for (std::size_t k = 0; k < found.prices.size(); ++k) {
        const PriceBest& best = found.prices[k];
        Data row = row_of(best.expected, found.recommended == k ? "recommended"
                                         : best.on_front        ? "best of its price"
                                                                : "no gain over cheaper");
        row["compared"] = best.candidates;
        row["not_told_apart"] = best.ties.size();
        row["selected_error_N"] = best.selected_N;
        rows.push_back(std::move(row));
    }
    return rows;
}

Data robustness_data(const WorldAnswer& found) {
    Data rows = Data::list();
    for (const Robustness& each : found.robustness) {
        rows.push_back({{"widths", title_of(each.condition)},
                        {"error_N", each.error.value_N},
                        {"interval_95_N", interval_of(each.error)},
                        {"covered_fraction", each.covered_fraction},
                        {"best", found.words(each.best)},
                        {"loss_N", each.loss.value_N},
                        {"loss_interval_N", interval_of(each.loss)},
                        {"advice_flips", each.flips}});
    }
    return rows;
}

Data grid_data(const GridError& grid) {
    return Data::list({{{"segments", grid.segments}, {"error_N", grid.coarse_N}},
                       {{"segments", 2 * grid.segments}, {"error_N", grid.finer_N}},
                       {{"segments", 4 * grid.segments}, {"error_N", grid.finest_N}}});
}

std::string grid_words(const WorldAnswer& found) {
    const GridError& grid = found.grid;
    const double share = std::abs(grid.error_N) / std::max(grid.coarse_N, 1e-12);
    return fmt::format(
        "Discretisation error of the expected error with {} segments: {:+.4f} N, {:.0f}% of it (Richardson's "
        "extrapolation, order {:.2f}, on a tenth of the worlds).{}",
        grid.segments, grid.error_N, 100.0 * share, grid.order,
        share > 0.1 ? " That is more than a tenth: raise transmission.segments." : "");
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
        if (each.flips) flips.push_back(title_of(each.condition));
    if (flips.empty()) return "The advice does not change with half or twice the stated uncertainty.";
    return fmt::format("The advice changes with: {}. So the stated uncertainty decides it.",
                       fmt::join(flips, "; "));
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
        answer.values["paper_estimators"].push_back({{"estimator", title_of(each.condition)},
                                                     {"error_N", each.error.value_N},
                                                     {"interval_95_N", interval_of(each.error)}});

    reports::AnswerSection prices{
        .id = "prices",
        .heading = "Error against price",
        .prose = fmt::format("{} sets of sensors, compared on {} common worlds, judged by the {}.{}",
                             found.candidates.size() - 1, found.worlds,
                             objective_words(plan.placement.objective), target_words(plan, found)),
        .tables = {{"prices",
                    "",
                    {{"price", "price"},
                     {"set", "sensors"},
                     {"what", ""},
                     {"expected_error_N", "error", "N", ".3f"},
                     {"monte_carlo_interval_N", "Monte-Carlo interval", "N", ".3f"},
                     {"error_95_N", "95% of worlds", "N", ".3f"},
                     {"load_end_error_N", "load end", "N", ".3f"},
                     {"worst_place_error_N", "worst place", "N", ".3f"},
                     {"covered_fraction", "in band", "", ".1%"},
                     {"not_told_apart", "as good"}},
                    answer.values["prices"]}},
        .note = fmt::format(
            "All numbers are from {} worlds that had no part in choosing the set of a price; the price was chosen on them. Error: {}. 95% of worlds: the error stays below this in "
            "95% of them. In band: true tensions within the estimator's 95% band; 95% if it is honest. As good: other sets of "
            "the price that a paired t test does not tell from the best (5% over all sets and looks). {}",
            found.worlds, objective_words(plan.placement.objective), grid_words(found))};
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
                                      .prose = flips_words(found),
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

reports::Answer world_truth_answer(const StudyPlan& told, const WorldAnswer& nominal,
                                   const WorldAnswer& about_truth) {
    const auto row_of = [&](const std::string& worlds, const WorldAnswer& found) {
        Data row = recommendation_data(told, found);
        row["worlds"] = worlds;
        return row;
    };
    const auto advised = [](const WorldAnswer& found) {
        return found.recommended ? found.set(found.best().expected.candidate).sensors : std::vector<int>{};
    };
    const std::vector<std::string> effects = effects_there(told.truth.effects);
    const bool changes = advised(nominal) != advised(about_truth);
    const bool is_tie = changes && nominal.recommended && about_truth.recommended &&
                        std::find(about_truth.best().ties.begin(), about_truth.best().ties.end(),
                                  nominal.best().expected.candidate) != about_truth.best().ties.end();
    reports::Answer answer;
    answer.id = "world_truth";
    answer.kind = "Sensor placement with and without what was found";
    answer.title = told.name;
    answer.headline = !changes ? "the advice does not change."
                      : is_tie ? "the advice changes only among sets that the worlds cannot distinguish."
                               : "the advice changes.";
    answer.values = {{"name", told.name},
                     {"effects", effects},
                     {"friction_ratio", told.truth.friction_ratio},
                     {"stiffness_ratio", told.truth.stiffness_ratio},
                     {"pretension_ratio", told.truth.pretension_ratio},
                     {"probability", told.uncertainty.truth_probability},
                     {"advice_changes", changes && !is_tie},
                     {"recommendations", Data::list({row_of("as configured", nominal),
                                                     row_of("with what was found", about_truth)})}};
    answer.sections = {
        {.id = "advice",
         .heading = "Advice with and without",
         .prose = fmt::format(
             "Found: {}friction {:.2f}, stiffness {:.2f}, pretension {:.2f} times the nominal value; in {:.0f}% of "
             "the worlds. The estimator knows of none of it.",
             effects.empty() ? std::string() : fmt::format("{}; ", fmt::join(effects, ", ")),
             told.truth.friction_ratio, told.truth.stiffness_ratio, told.truth.pretension_ratio,
             100.0 * told.uncertainty.truth_probability),
         .tables = {{"advice",
                     "",
                     {{"worlds", "worlds"},
                      {"set", "sensors"},
                      {"expected_error_N", "error", "N", ".3f"},
                      {"monte_carlo_interval_N", "Monte-Carlo interval", "N", ".3f"},
                      {"error_95_N", "95% of worlds", "N", ".3f"},
                      {"no_sensor_error_N", "no sensor", "N", ".3f"},
                      {"covered_fraction", "in band", "", ".1%"}},
                     answer.values["recommendations"]}}}};
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
