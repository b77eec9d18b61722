// Whether the advice of a study holds where the true cable is not its model.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/world_values.h"
#include "capstan/placement/recommendation.h"
#include "capstan/storage/statement.h"

namespace capstan::answers {

namespace {

using reports::Data;
using storage::RecommendationRecord;

const RecommendationRecord* same_question(const Conclusions& conclusions, const RecommendationRecord& asked) {
    for (const RecommendationRecord& each : conclusions.recommendations) {
        if (each.scope == asked.scope && each.regime == asked.regime && each.noise_index == asked.noise_index)
            return &each;
    }
    return nullptr;
}

// Mean over a regime's instants of the error of a choice. Both studies have one plan, so that the indices
// agree.
double error_N(storage::Database& database, std::int64_t study_id, const RecommendationRecord& choice) {
    storage::Statement statement(
        database,
        "SELECT avg(c.mean_abs_error_N) FROM cell c JOIN scenario s USING (scenario_id) "
        "JOIN sensor_set ss USING (sensor_set_id) JOIN noise_level n USING (noise_level_id) "
        "WHERE s.study_id = ?1 AND s.regime = ?2 AND n.noise_index = ?3 AND ss.set_index = ?4 AND c.method = ?5");
    statement.bind_all(study_id, std::string_view(choice.regime), choice.noise_index, choice.set_index,
                       std::string_view(choice.method));
    statement.step();
    return statement.get<double>(0);
}

bool is_as_good(const RecommendationRecord& best, const RecommendationRecord& given) {
    return (best.set_index == given.set_index && best.method == given.method) ||
           std::any_of(best.alternatives.begin(), best.alternatives.end(), [&](const auto& each) {
               return each.set_index == given.set_index && each.method == given.method;
           });
}

}  // namespace

reports::Answer truth_answer(storage::Database& database, std::int64_t model_id, std::int64_t truth_id) {
    const Conclusions model = read_conclusions(database, model_id);
    const Conclusions truth = read_conclusions(database, truth_id);
    Data rows = Data::list();
    int changes = 0;
    for (const RecommendationRecord& given : model.recommendations) {
        const RecommendationRecord* best = given.scope == "regime" ? same_question(truth, given) : nullptr;
        if (best == nullptr) continue;
        const bool stays = is_as_good(*best, given);
        changes += stays ? 0 : 1;
        rows.push_back({{"noise", noise_label(model.study, given.noise_index)},
                        {"regime", given.regime},
                        {"advice_stays", stays},
                        {"model",
                         {{"nodes", nodes_of(model.study, given.set_index)},
                          {"method", title_of_method(given.method)},
                          {"expected_error_N", searched_error_N(given)},
                          {"true_error_N", error_N(database, truth_id, given)}}},
                        {"truth",
                         {{"nodes", nodes_of(truth.study, best->set_index)},
                          {"method", title_of_method(best->method)},
                          {"true_error_N", searched_error_N(*best)},
                          {"error_on_independent_draws_N", best->error_N},
                          {"interval_95_N", Data::list({best->interval_low_N, best->interval_high_N})}}}});
    }
    reports::Answer answer{.id = "truth",
                           .kind = "Advice where the true cable is not the model",
                           .title = model.study.study.name};
    answer.headline =
        changes == 0
            ? "the advice stays; no choice with as many sensors is significantly better with the true cable."
            : fmt::format("the advice changes in {} of {} cases.", changes, rows.items().size());
    answer.values = rows;
    answer.sections = {
        {.id = "advice",
         .heading = "Advice of the model and of the true cable",
         .tables = {{"advice",
                     "",
                     {{"regime", "regime"},
                      {"noise", "noise"},
                      {"model.nodes", "advice"},
                      {"model.method", "method"},
                      {"model.expected_error_N", "expected", "N", ".3f"},
                      {"model.true_error_N", "true error", "N", ".3f"},
                      {"advice_stays", "stays"},
                      {"truth.nodes", "best"},
                      {"truth.method", "method"},
                      {"truth.error_on_independent_draws_N", "error", "N", ".3f"},
                      {"truth.interval_95_N", "95% interval", "N", ".3f"}},
                     rows}},
         .note =
             "Expected: the error that the model promises. True error: of the same sensors and method with the "
             "true cable. The advice stays where it is the best choice with the true cable, or has as many sensors and "
             "is not significantly worse (paired t test at the 5% level, Bonferroni-corrected over all choices with "
             "as many sensors). The last columns: the best choice with the true cable, its error on "
             "independent draws."}};
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
