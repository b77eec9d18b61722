// Sensors placed by hand.
#include "capstan/cable/invalid_input.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/service/study_state.h"

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
               std::make_shared<LayoutScorer>(context.options.answers.stored_plan(database, study_id));
}

LayoutQuestion question_of(const nlohmann::json& body) {
    const int noise = member<int>(body, "noise");  // from 1
    if (noise < 1) throw BadRequest("'noise' counts the study's noise levels from 1");
    return {member<std::vector<int>>(body, "nodes"), member<std::string>(body, "method"),
            member<std::string>(body, "regime"), noise - 1};
}

ordered_json json_of(const LayoutScore& score) {
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

void add_layout_routes(httplib::Server& server, RouteContext& context) {
    server.Post(
        R"(/api/studies/(\d+)/layout)", [&](const httplib::Request& request, httplib::Response& response) {
            const LayoutQuestion question = question_of(body_of(request));
            try {
                send_json(response, json_of(scorer_of(context, number_in_path(request))->score(question)));
            } catch (const InvalidInput& error) {
                throw BadRequest(error.what());
            }
        });
}

}  // namespace capstan::service
