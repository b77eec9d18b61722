#include "capstan/answers/world_values.h"

#include <fmt/format.h>

#include "capstan/worlds/sensor_places.h"
#include "capstan/worlds/stored_worlds.h"

namespace capstan::answers {

using reports::Data;

namespace {

Data gain_data(const std::string& of, const Estimated& gain) {
    return {{"of", of}, {"gain_N", gain.value_N}, {"interval_95_N", interval_data(gain)}};
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

}  // namespace

Data interval_data(const Estimated& estimated) {
    return Data::list({estimated.low_N, estimated.high_N});
}

Data expected_data(const StudyPlan& plan, const WorldAnswer& found, const Expected& expected) {
    return {{"set", found.words(expected.candidate)},
            {"sensors", sensors_data(plan, found, expected.candidate)},
            {"sensor_count", found.set(expected.candidate).count()},
            {"price", found.set(expected.candidate).price},
            {"expected_error_N", expected.objective.value_N},
            {"monte_carlo_interval_N", interval_data(expected.objective)},
            {"error_95_N", expected.error_95_N},
            {"rms_error_N", expected.rms_N},
            {"whole_cable_error_N", expected.whole_cable_N},
            {"load_end_error_N", expected.load_end_N},
            {"worst_place_error_N", expected.worst_place_N},
            {"covered_fraction", expected.covered_fraction},
            {"discretisation_error_N", expected.discretisation_N},
            {"error_95_discretisation_error_N", expected.error_95_discretisation_N},
            {"load_end_discretisation_error_N", expected.load_end_discretisation_N}};
}

std::string title_of_condition(Condition condition) {
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

Data gains_data(const StudyPlan& plan, const WorldAnswer& found) {
    Data gains = Data::list();
    if (found.further) {
        Data further = gain_data("a further sensor", found.further_gain);
        further["set"] = found.words(*found.further);
        further["sensors"] = sensors_data(plan, found, *found.further);
        gains.push_back(std::move(further));
    }
    for (const KnowledgeGain& each : found.knowledge)
        gains.push_back(gain_data(title_of_condition(each.condition), each.gain));
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
    Data anywhere = Data::list();
    for (const int sensor : found.set(expected.candidate).sensors) {
        const StraightPiece& piece = found.pieces[static_cast<std::size_t>(sensor)];
        anywhere.push_back(Data::list({piece.from_m, piece.to_m}));
    }
    data["same_reading_m"] = std::move(anywhere);
    Data ties = Data::list();
    if (found.recommended)
        for (const int tie : found.best().ties) ties.push_back(found.words(tie));
    data["not_distinguished"] = std::move(ties);
    if (found.bound) {
        data["at_most_worse_N"] = found.bound->gap.value_N;
        data["at_most_worse_interval_N"] = interval_data(found.bound->gap);
        data["at_most_worse_of"] = found.bound->is_of_rms ? "root mean square error" : "objective";
    }
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
        row["same_reading"] = best.alike.size();
        row["not_distinguished"] = best.ties.size();
        row["selected_error_N"] = best.selected_N;
        if (found.bound) row["at_most_worse_N"] = found.bound->of_prices[k].value_N;
        rows.push_back(std::move(row));
    }
    if (found.bound) {
        Data row = row_of(found.bound->all, "not for sale");
        row["set"] =
            fmt::format("all {} usable sensors together", found.set(found.bound->all.candidate).count());
        rows.push_back(std::move(row));
    }
    return rows;
}

Data robustness_data(const WorldAnswer& found) {
    Data rows = Data::list();
    for (const Robustness& each : found.robustness) {
        rows.push_back({{"widths", title_of_condition(each.condition)},
                        {"error_N", each.error.value_N},
                        {"interval_95_N", interval_data(each.error)},
                        {"covered_fraction", each.covered_fraction},
                        {"best", found.words(each.best)},
                        {"loss_N", each.loss.value_N},
                        {"loss_interval_N", interval_data(each.loss)},
                        {"advice_flips", each.flips}});
    }
    return rows;
}

Data grid_data(const GridError& grid) {
    return Data::list({{{"segments", grid.segments}, {"error_N", grid.coarse_N}},
                       {{"segments", 2 * grid.segments}, {"error_N", grid.finer_N}},
                       {{"segments", 4 * grid.segments}, {"error_N", grid.finest_N}}});
}

}  // namespace capstan::answers
