#include "capstan/cli/truth_comparison.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/cli/recommendation_words.h"
#include "capstan/placement/recommendation.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/storage/statement.h"

namespace capstan::cli {

namespace {

using storage::RecommendationRecord;

std::string title_of(const Conclusions& conclusions, const std::string& method) {
    for (const auto& known : conclusions.study.fusion_methods) {
        if (known.method == method) return known.title;
    }
    return method;
}

const std::vector<int>& nodes_of(const Conclusions& conclusions, int set_index) {
    return conclusions.study.sensor_sets[static_cast<std::size_t>(set_index)].nodes;
}

const RecommendationRecord* same_question(const Conclusions& conclusions, const RecommendationRecord& asked) {
    for (const RecommendationRecord& each : conclusions.recommendations) {
        if (each.scope == asked.scope && each.regime == asked.regime && each.noise_index == asked.noise_index)
            return &each;
    }
    return nullptr;
}

// Mean over a regime's instants of a choice's error. The studies' plans are one, so indices are the same.
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

bool is_as_good(const RecommendationRecord& best, const RecommendationRecord& choice) {
    if (best.set_index == choice.set_index && best.method == choice.method) return true;
    return std::any_of(best.alternatives.begin(), best.alternatives.end(), [&](const auto& other) {
        return other.set_index == choice.set_index && other.method == choice.method;
    });
}

}  // namespace

std::vector<AdviceUnderTruth> advice_under_truth(storage::Database& database, std::int64_t of_model,
                                                 std::int64_t of_truth) {
    const Conclusions model = read_conclusions(database, of_model);
    const Conclusions truth = read_conclusions(database, of_truth);
    std::vector<AdviceUnderTruth> advice;
    for (const RecommendationRecord& given : model.recommendations) {
        if (given.scope != "regime") continue;
        const RecommendationRecord* best = same_question(truth, given);
        if (best == nullptr) continue;
        advice.push_back({model.study.noise_levels[static_cast<std::size_t>(given.noise_index)].label,
                          given.regime, nodes_of(model, given.set_index), title_of(model, given.method),
                          searched_error_N(given), error_N(database, of_truth, given),
                          nodes_of(truth, best->set_index), title_of(truth, best->method),
                          searched_error_N(*best), best->error_N, best->interval_low_N, best->interval_high_N,
                          is_as_good(*best, given)});
    }
    return advice;
}

std::string in_words(const std::vector<AdviceUnderTruth>& advice) {
    std::string text = "Does the advice change where the true cable is not the model?\n";
    for (const AdviceUnderTruth& each : advice) {
        std::string line = fmt::format(
            "{}, sensor noise {}: the model advises sensors at nodes {} fused by {} and expects {:.3f} N; with the true "
            "cable they err by {:.3f} N.",
            each.regime, each.noise, fmt::join(each.model_nodes, ", "), each.model_method,
            each.expected_error_N, each.true_error_N);
        line +=
            each.stays
                ? " The advice stays: no other choice is better beyond doubt."
                : fmt::format(
                      " The advice changes: nodes {} fused by {} err by {:.3f} N, on fresh draws by {:.3f} N ({:.3f} to "
                      "{:.3f}).",
                      fmt::join(each.true_nodes, ", "), each.true_method, each.best_error_N,
                      each.fresh_error_N, each.fresh_low_N, each.fresh_high_N);
        text += "\n" + wrapped(line, 100, "  * ", "    ") + "\n";
    }
    return text;
}

nlohmann::ordered_json in_json(const std::vector<AdviceUnderTruth>& advice) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const AdviceUnderTruth& each : advice)
        json.push_back({{"noise", each.noise},
                        {"regime", each.regime},
                        {"advice_stays", each.stays},
                        {"model",
                         {{"nodes", each.model_nodes},
                          {"method", each.model_method},
                          {"expected_error_N", each.expected_error_N},
                          {"true_error_N", each.true_error_N}}},
                        {"truth",
                         {{"nodes", each.true_nodes},
                          {"method", each.true_method},
                          {"true_error_N", each.best_error_N},
                          {"error_on_fresh_draws_N", each.fresh_error_N},
                          {"interval_95_N", {each.fresh_low_N, each.fresh_high_N}}}}});
    return json;
}

}  // namespace capstan::cli
