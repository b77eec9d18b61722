#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/world_values.h"

namespace capstan::answers {

using reports::Data;

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
    const auto is_as_good = [](const WorldAnswer& found, const std::vector<int>& sensors) {
        const auto is_it = [&](int set) { return found.set(set).sensors == sensors; };
        const PriceBest& best = found.best();
        return std::any_of(best.ties.begin(), best.ties.end(), is_it) ||
               std::any_of(best.alike.begin(), best.alike.end(), is_it);
    };
    const bool is_tie = changes && nominal.recommended && about_truth.recommended &&
                        is_as_good(about_truth, advised(nominal));
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

}  // namespace capstan::answers
