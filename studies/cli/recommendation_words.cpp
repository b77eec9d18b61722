#include "capstan/cli/recommendation_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/cli/text_table.h"
#include "capstan/placement/recommendation.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/storage/error.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t words_width = 100;

std::vector<std::string> labels_of(const storage::StudyDescription& study, int set_index) {
    std::vector<std::string> labels;
    for (const storage::LayoutRecord& layout : study.layouts) {
        if (layout.set_index == set_index) labels.push_back(layout.label);
    }
    return labels;
}

ordered_json choice_json(const storage::StudyDescription& study, int set_index, const std::string& method) {
    return {{"nodes", study.sensor_sets[set_index].nodes},
            {"layouts", labels_of(study, set_index)},
            {"method", method}};
}

ordered_json recommendation_json(const storage::StudyDescription& study,
                                 const storage::RecommendationRecord& r) {
    ordered_json json = {{"noise", study.noise_levels[r.noise_index].label}, {"scope", r.scope}};
    if (r.scope == "regime") json["regime"] = r.regime;
    json["sensor_count"] = r.sensor_count;
    json.update(choice_json(study, r.set_index, r.method));
    json["error_N"] = r.error_N;
    json["interval_95_N"] = {r.interval_low_N, r.interval_high_N};
    json["error_on_search_draws_N"] = searched_error_N(r);
    json["optimism_N"] = r.error_N - searched_error_N(r);
    json["sentence"] = r.sentence;
    json["best_at_each_count"] = ordered_json::array();
    for (const auto& count : r.counts) {
        ordered_json entry = {{"sensor_count", count.sensor_count}};
        entry.update(choice_json(study, count.set_index, count.method));
        entry["error_on_search_draws_N"] = count.error_N;
        entry["interval_95_N"] = {count.interval_low_N, count.interval_high_N};
        json["best_at_each_count"].push_back(std::move(entry));
    }
    json["indistinguishable"] = ordered_json::array();
    for (const auto& other : r.alternatives) {
        ordered_json entry = choice_json(study, other.set_index, other.method);
        entry["difference_N"] = other.difference_N;
        entry["interval_95_N"] = {other.interval_low_N, other.interval_high_N};
        json["indistinguishable"].push_back(std::move(entry));
    }
    return json;
}

std::string title_of(const storage::StudyDescription& study, const std::string& method) {
    for (const auto& known : study.fusion_methods) {
        if (known.method == method) return known.title;
    }
    return method;
}

// The first few of the indifferent set, so that a designer can pick by other reasons.
std::string alternatives_words(const storage::StudyDescription& study,
                               const storage::RecommendationRecord& r) {
    constexpr std::size_t shown = 4;
    std::string text;
    for (std::size_t k = 0; k < std::min(shown, r.alternatives.size()); ++k) {
        const auto& other = r.alternatives[k];
        text += fmt::format(
            "{}{} [{}] by {}", k == 0 ? "As good: " : "; ", labels_of(study, other.set_index).front(),
            fmt::join(study.sensor_sets[other.set_index].nodes, ", "), title_of(study, other.method));
    }
    if (r.alternatives.size() > shown)
        text += fmt::format("; {} more (--json lists all)", r.alternatives.size() - shown);
    return text.empty() ? "" : wrapped(text + ".", words_width, "    ", "    ") + "\n";
}

std::string comparison_words(const std::vector<storage::PaperComparisonRecord>& rows) {
    if (rows.empty()) return "";
    std::string text = "\nThe paper's numbers and ours [N]\n\n";
    std::size_t width = 0;
    for (const auto& row : rows) width = std::max(width, columns_of(row.quantity));
    text += fmt::format("  {:<{}}  {:>7}  {:>16}\n", "", width, "paper", "ours");
    for (const auto& row : rows) {
        const std::string paper =
            row.paper_N ? fmt::format("{}{:.3g}", row.relation == "<" ? "< " : "", *row.paper_N) : "-";
        text += fmt::format("  {}{}  {:>7}  {:>7.3f} +- {:.3f}\n", row.quantity,
                            std::string(width - columns_of(row.quantity), ' '), paper, row.ours_N,
                            1.96 * row.standard_error_N);
        text += wrapped(row.reason, words_width, "      ", "      ") + "\n";
    }
    return text;
}

}  // namespace

Conclusions read_conclusions(storage::Database& database, std::int64_t study_id) {
    Conclusions conclusions{study_id, storage::load_study(database, study_id), {}, {}};
    if (conclusions.study.study.status != "complete") {
        throw storage::Error(
            fmt::format("study {} ({}) is not complete, so it has no recommendation yet. "
                        "`capstan study resume {} --db {}` ends it.",
                        study_id, conclusions.study.study.name, study_id, database.path().string()));
    }
    conclusions.recommendations = storage::read_recommendations(database, study_id);
    conclusions.paper_comparison = storage::read_paper_comparison(database, study_id);
    return conclusions;
}

std::string in_words(const Conclusions& conclusions) {
    const auto& study = conclusions.study;
    std::string text =
        fmt::format("Study {} ({}): where to put tension sensors\n", conclusions.study_id, study.study.name);
    int noise = -1;
    for (const auto& recommendation : conclusions.recommendations) {
        if (recommendation.noise_index != noise) {
            noise = recommendation.noise_index;
            text += fmt::format("\nSensor noise: {}\n", study.noise_levels[noise].label);
        }
        text += "\n" + wrapped(recommendation.sentence, words_width, "  * ", "    ") + "\n";
        text += alternatives_words(study, recommendation);
    }
    return text + comparison_words(conclusions.paper_comparison);
}

ordered_json in_json(const Conclusions& conclusions) {
    const auto& study = conclusions.study.study;
    ordered_json json = {{"study_id", conclusions.study_id},
                         {"name", study.name},
                         {"status", study.status},
                         {"seed", study.seed},
                         {"repetitions", study.repetitions}};
    json["recommendations"] = ordered_json::array();
    for (const auto& each : conclusions.recommendations) {
        json["recommendations"].push_back(recommendation_json(conclusions.study, each));
    }
    json["paper_comparison"] = ordered_json::array();
    for (const auto& row : conclusions.paper_comparison) {
        json["paper_comparison"].push_back(
            {{"quantity", row.quantity},
             {"paper_N", row.paper_N ? ordered_json(*row.paper_N) : ordered_json()},
             {"relation", row.relation},
             {"ours_N", row.ours_N},
             {"standard_error_N", row.standard_error_N},
             {"reason", row.reason}});
    }
    return json;
}

}  // namespace capstan::cli
