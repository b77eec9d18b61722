#include <fmt/format.h>

#include <algorithm>

#include "capstan/answers/placement_answers.h"
#include "capstan/placement/prepared_study.h"
#include "capstan/placement/recommendation.h"
#include "capstan/storage/error.h"
#include "capstan/storage/report_queries.h"
#include "capstan/storage/statement.h"
#include "capstan/storage/study_store.h"

namespace capstan::answers {

namespace {

using reports::Data;
using storage::RecommendationRecord;
using storage::StudyDescription;

std::vector<std::string> labels_of(const StudyDescription& study, int set_index) {
    std::vector<std::string> labels;
    for (const storage::LayoutRecord& layout : study.layouts) {
        if (layout.set_index == set_index) labels.push_back(layout.label);
    }
    return labels;
}

std::vector<double> places_of(const StudyDescription& study, const std::vector<int>& nodes) {
    std::vector<double> places_m;
    for (const int node : nodes) {
        const int segment = node - 2;  // the one that ends at the node
        if (segment < -1 || segment >= static_cast<int>(study.cable_segments.size()))
            throw storage::Error(
                fmt::format("The study has a sensor at node {}, which its cable does not have. The "
                            "file is damaged; `capstan doctor` examines it.",
                            node));
        const auto* before = segment < 0 ? nullptr : &study.cable_segments[static_cast<std::size_t>(segment)];
        places_m.push_back(before == nullptr ? 0.0 : before->start_m + before->length_m);
    }
    return places_m;
}

Data choice_data(const StudyDescription& study, int set_index, const std::string& method) {
    const std::vector<std::string> labels = labels_of(study, set_index);
    return {{"nodes", nodes_of(study, set_index)},
            {"places_m", places_of(study, nodes_of(study, set_index))},
            {"layouts", labels},
            {"layout", fmt::format("{}", fmt::join(labels, " or "))},
            {"method", method},
            {"method_title", title_of_method(method)}};
}

std::string scope_title(const RecommendationRecord& record) {
    if (record.scope == "minimax_regret") return "safe in every regime";
    if (record.scope == "duty_cycle") return "duty cycle";
    std::string regime = record.regime;
    std::replace(regime.begin(), regime.end(), '_', ' ');
    return "regime " + regime;
}

Data recommendation_data(const StudyDescription& study, const RecommendationRecord& r) {
    Data data = {
        {"noise", noise_label(study, r.noise_index)}, {"scope", r.scope}, {"scope_title", scope_title(r)}};
    if (r.scope == "regime") data["regime"] = r.regime;
    data["sensor_count"] = r.sensor_count;
    data.update(choice_data(study, r.set_index, r.method));
    data["error_N"] = r.error_N;
    data["interval_95_N"] = Data::list({r.interval_low_N, r.interval_high_N});
    data["error_on_search_draws_N"] = searched_error_N(r);
    data["optimism_N"] = r.error_N - searched_error_N(r);
    data["sentence"] = r.sentence;
    data["best_at_each_count"] = Data::list();
    for (const auto& count : r.counts) {
        Data entry = {{"sensor_count", count.sensor_count}};
        entry.update(choice_data(study, count.set_index, count.method));
        entry["error_on_search_draws_N"] = count.error_N;
        entry["interval_95_N"] = Data::list({count.interval_low_N, count.interval_high_N});
        data["best_at_each_count"].push_back(std::move(entry));
    }
    data["indistinguishable"] = Data::list();
    for (const auto& other : r.alternatives) {
        Data entry = choice_data(study, other.set_index, other.method);
        entry["difference_N"] = other.difference_N;
        entry["interval_95_N"] = Data::list({other.interval_low_N, other.interval_high_N});
        data["indistinguishable"].push_back(std::move(entry));
    }
    data["indistinguishable_count"] = r.alternatives.size();
    return data;
}

// The first few of the choices that are not significantly worse, so that a designer can pick by other
// reasons.
std::string alternatives_words(const StudyDescription& study, const RecommendationRecord& r) {
    constexpr std::size_t shown = 4;
    std::string text;
    for (std::size_t k = 0; k < std::min(shown, r.alternatives.size()); ++k) {
        const auto& other = r.alternatives[k];
        text += fmt::format("{}{} [{}] by {}", k == 0 ? " Not significantly worse: " : "; ",
                            fmt::format("{}", fmt::join(labels_of(study, other.set_index), " or ")),
                            fmt::join(nodes_of(study, other.set_index), ", "), title_of_method(other.method));
    }
    if (r.alternatives.size() > shown)
        text += fmt::format("; and {} more (--json lists all)", r.alternatives.size() - shown);
    return text.empty() ? "" : text + ".";
}

Data comparison_data(const std::vector<storage::PaperComparisonRecord>& rows) {
    Data list = Data::list();
    for (const auto& row : rows) {
        list.push_back({{"quantity", row.quantity},
                        {"paper_N", row.paper_N},
                        {"relation", row.relation},
                        {"ours_N", row.ours_N},
                        {"standard_error_N", row.standard_error_N},
                        {"reason", row.reason}});
    }
    return list;
}

reports::AnswerSection comparison_section(const Data& rows) {
    return {.id = "paper",
            .heading = "The paper's numbers and ours",
            .prose = storage::paper_matched_words,
            .tables = {{"paper_comparison",
                        "",
                        {{"quantity", "quantity"},
                         {"relation", ""},
                         {"paper_N", "paper", "N", ".3g"},
                         {"ours_N", "ours", "N", ".3f"},
                         {"standard_error_N", "standard error", "N", ".3f"},
                         {"reason", "reason"}},
                        rows}},
            .note = storage::paper_agreement_words()};
}

std::string headline_of(const Conclusions& conclusions, const std::map<std::string, double>& no_sensor_N) {
    if (conclusions.recommendations.empty()) return "no recommendation was made.";
    const RecommendationRecord& last = conclusions.recommendations.back();  // the duty cycle, the last noise
    const std::optional<double> none_N = no_sensor_error_N(no_sensor_N, last);
    if (none_N && !beats_no_sensor(last, *none_N))
        return fmt::format(
            "use no sensor. Expected tension error over the duty cycle without any: {:.3f} N; with {}, {}: {:.3f} N.",
            *none_N, counted(static_cast<std::size_t>(last.sensor_count), "sensor"),
            place_words(conclusions.study, nodes_of(conclusions.study, last.set_index)), last.error_N);
    return fmt::format(
        "use {}, {}, fused by {}. Expected tension error over the duty cycle with sensor noise {}: {:.3f} N.",
        counted(static_cast<std::size_t>(last.sensor_count), "sensor"),
        place_words(conclusions.study, nodes_of(conclusions.study, last.set_index)),
        title_of_method(last.method), noise_label(conclusions.study, last.noise_index), last.error_N);
}

// ---- what the numbers take for granted

std::string samples_words(const StudyPlan& plan) {
    std::vector<std::string> regimes;
    for (const RegimeInstants& each : plan.regimes)
        regimes.push_back(fmt::format("{} ({})", fmt::join(each.samples, ", "), name_of(each.regime)));
    return fmt::format("{}", fmt::join(regimes, "; "));
}

std::string assumption_words(const StudyPlan& plan) {
    return fmt::format(
        "The estimator knows friction, bends, stiffness and pretension exactly, and the exact state one sample before. Of "
        "the far end it assumes that it moves by at most {:g} mm in a sample{}. Errors are those of the samples {}, not of "
        "a complete motion. On a rig none of this holds; with [uncertainty] a study drops these assumptions.",
        1e3 * plan.largest_distal_increment_m,
        plan.motion.distal.kind == EndKind::position && plan.motion.distal.amplitude == 0.0
            ? ", and in truth it is blocked, so that its guess without any sensor is centred on the truth and this range "
              "decides what sensors are worth"
            : "",
        samples_words(plan));
}

}  // namespace

const std::vector<int>& nodes_of(const StudyDescription& study, int set_index) {
    if (set_index < 0 || static_cast<std::size_t>(set_index) >= study.sensor_sets.size())
        throw storage::Error(
            "A recommendation names a sensor set that the study does not have. The file is damaged; `capstan "
            "doctor` examines it.");
    return study.sensor_sets[static_cast<std::size_t>(set_index)].nodes;
}

const std::string& noise_label(const StudyDescription& study, int noise_index) {
    if (noise_index < 0 || static_cast<std::size_t>(noise_index) >= study.noise_levels.size())
        throw storage::Error(
            "A recommendation names a noise level that the study does not have. The file is damaged; `capstan "
            "doctor` examines it.");
    return study.noise_levels[static_cast<std::size_t>(noise_index)].label;
}

void require_complete(storage::Database& database, std::int64_t study_id,
                      const StudyDescription& description) {
    if (description.study.status == "complete") return;
    throw storage::Error(
        fmt::format("study {} ({}) is not complete, so it has no recommendation yet. "
                    "`capstan study resume {} --db {}` completes it.",
                    study_id, description.study.name, study_id, database.path().string()));
}

Conclusions read_conclusions(storage::Database& database, std::int64_t study_id) {
    Conclusions conclusions{study_id, storage::load_study(database, study_id), {}, {}};
    require_complete(database, study_id, conclusions.study);
    conclusions.recommendations = storage::read_recommendations(database, study_id);
    conclusions.paper_comparison = storage::read_paper_comparison(database, study_id);
    return conclusions;
}

reports::Answer recommendation_answer(const Conclusions& conclusions, const StudyPlan& plan) {
    const auto& study = conclusions.study.study;
    const std::map<std::string, double> errors_N = no_sensor_errors_N(plan);
    reports::Answer answer{.id = "recommendation",
                           .kind = "Sensor placement",
                           .title = fmt::format("Study {} ({})", conclusions.study_id, study.name),
                           .headline = headline_of(conclusions, errors_N)};
    answer.values = {{"study_id", conclusions.study_id},
                     {"name", study.name},
                     {"status", study.status},
                     {"seed", study.seed},
                     {"repetitions", study.repetitions},
                     {"recommendations", Data::list()},
                     {"paper_comparison", comparison_data(conclusions.paper_comparison)}};
    for (const auto& each : conclusions.recommendations) {
        Data data = recommendation_data(conclusions.study, each);
        const std::optional<double> none_N = no_sensor_error_N(errors_N, each);
        data["no_sensor_error_N"] = none_N ? Data(*none_N) : Data();
        data["beats_no_sensor"] = none_N ? Data(beats_no_sensor(each, *none_N)) : Data();
        answer.values["recommendations"].push_back(std::move(data));
    }
    answer.values["assumptions"] = assumption_words(plan);
    answer.sections = {{.id = "recommendations",
                        .heading = "Recommendations",
                        .tables = {{"recommendations",
                                    "",
                                    {{"noise", "noise"},
                                     {"scope_title", "for"},
                                     {"nodes", "nodes"},
                                     {"layout", "layout"},
                                     {"method_title", "method"},
                                     {"error_N", "error", "N", ".3f"},
                                     {"interval_95_N", "95% interval", "N", ".3f"},
                                     {"no_sensor_error_N", "no sensor", "N", ".3f"},
                                     {"optimism_N", "optimism", "N", "+.4f"},
                                     {"indistinguishable_count", "not worse"}},
                                    answer.values["recommendations"]}},
                        .note = assumption_words(plan)}};
    for (const auto& each : conclusions.recommendations)
        answer.sections.push_back(
            {.id = "sentence", .prose = each.sentence + alternatives_words(conclusions.study, each)});
    if (!conclusions.paper_comparison.empty())
        answer.sections.push_back(comparison_section(answer.values["paper_comparison"]));
    return answer;
}

}  // namespace capstan::answers
