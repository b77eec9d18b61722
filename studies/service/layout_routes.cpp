// The expected error of layouts that a user draws.
#include "capstan/cable/invalid_input.h"
#include "capstan/placement/stored_study.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"

namespace capstan::service {

namespace {

constexpr std::size_t max_scorers = 4;  // each keeps the readings of a study

std::shared_ptr<LayoutScorer> scorer_of(RouteContext& context, std::int64_t study_id) {
    const std::lock_guard lock(context.scorers_mutex);
    const auto found = context.scorers.find(study_id);
    if (found != context.scorers.end()) return found->second;
    storage::Database database = context.open();
    study_state(database, study_id);
    if (context.scorers.size() >= max_scorers) context.scorers.clear();
    return context.scorers[study_id] =
               std::make_shared<LayoutScorer>(load_stored_study(database, study_id).plan);
}

LayoutQuestion question_of(const nlohmann::json& body) {
    const int noise = member<int>(body, "noise");  // from 1
    if (noise < 1) throw BadRequest("'noise' counts the study's noise levels from 1");
    return {member<std::vector<int>>(body, "nodes"), member<std::string>(body, "method"),
            member<std::string>(body, "regime"), noise - 1};
}

ordered_json score_json(const LayoutScore& score) {
    ordered_json json = {{"mean_abs_error_N", score.mean_abs_error_N},
                         {"interval_low_N", score.interval_low_N},
                         {"interval_high_N", score.interval_high_N},
                         {"repetitions", score.repetitions},
                         {"instants", score.instants},
                         {"nodes", ordered_json::array()}};
    for (const NodeError& node : score.nodes)
        json["nodes"].push_back(
            {{"node", node.node}, {"mean_abs_error_N", node.mean_abs_error_N}, {"bias_N", node.bias_N}});
    return json;
}

}  // namespace

std::vector<Route> layout_routes(RouteContext& context) {
    const auto score = [&](const httplib::Request& request, httplib::Response& response) {
        const LayoutQuestion question = question_of(body_of(request));
        try {
            send_json(response, score_json(scorer_of(context, number_in_path(request))->score(question)));
        } catch (const InvalidInput& error) {
            throw BadRequest(error.what());
        }
    };
    return {{"post",
             "/api/studies/{study_id}/layout",
             "scoreLayout",
             "The expected error with sensors at these nodes, from the study's instants and draws",
             "The error, and the error at each node",
             json_of("LayoutScore"),
             score,
             200,
             {400},
             {{"nodes", "[integer]", "From 1 at the motor"},
              {"method", "string", "As in fusion_method.method"},
              {"regime", "string"},
              {"noise", "integer", "Which of the study's noise levels, from 1"}}}};
}

}  // namespace capstan::service
