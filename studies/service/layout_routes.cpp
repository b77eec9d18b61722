// The expected error of sensors that a user places.
#include <fmt/format.h>

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/stored_study.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/worlds/sensor_places.h"

namespace capstan::service {

namespace {

constexpr std::size_t max_scorers = 4;  // each keeps the readings of a study

std::shared_ptr<LayoutScorer> scorer_of(RouteContext& context, std::int64_t study_id) {
    const std::lock_guard lock(context.scorers_mutex);
    const auto found = context.scorers.find(study_id);
    if (found != context.scorers.end()) return found->second;
    storage::Database database = context.open();
    study_state(database, study_id);
    const StudyPlan plan = load_stored_study(database, study_id).plan;
    if (plan.uncertainty.is_stated)
        throw BadRequest(fmt::format("study {0} is over worlds; post to /api/studies/{0}/sensors", study_id));
    if (context.scorers.size() >= max_scorers) context.scorers.clear();
    return context.scorers[study_id] = std::make_shared<LayoutScorer>(plan);
}

std::shared_ptr<HandPlacer> placer_of(RouteContext& context, std::int64_t study_id) {
    const std::lock_guard lock(context.scorers_mutex);
    const auto found = context.placers.find(study_id);
    if (found != context.placers.end()) return found->second;
    storage::Database database = context.open();
    if (!study_state(database, study_id).is_complete)
        throw BadRequest("sensors can be placed by hand when the study is complete", 409);
    const StudyPlan plan = load_stored_study(database, study_id).plan;
    if (!plan.uncertainty.is_stated)
        throw BadRequest(fmt::format("study {0} is at instants; post to /api/studies/{0}/layout", study_id));
    if (context.placers.size() >= max_scorers) context.placers.clear();
    return context.placers[study_id] = std::make_shared<HandPlacer>(database, study_id, plan);
}

ordered_json offers_json(const WorldAnswer& answer) {
    ordered_json json = {{"sensors", ordered_json::array()}, {"recommended", ordered_json::array()}};
    for (const SensorOffer& offer : answer.offers) {
        ordered_json each = {{"sensor", json["sensors"].size() + 1},
                             {"kind", name_of(offer.kind)},
                             {"place_m", offer.place_m},
                             {"words", words_of(offer)},
                             {"price", offer.price}};
        if (has_two_cables(answer.offers) && offer.kind == SensorKind::tension)
            each["cable"] = offer.cable == 0 ? "A" : "B";
        json["sensors"].push_back(std::move(each));
    }
    if (answer.recommended)
        for (const int sensor : answer.set(answer.best().expected.candidate).sensors)
            json["recommended"].push_back(sensor + 1);
    return json;
}

ordered_json placed_json(const HandPlaced& placed, const WorldAnswer& answer) {
    const auto interval = [](const Estimated& each) { return ordered_json{each.low_N, each.high_N}; };
    return {{"set", words_of(placed.set, answer.offers)},
            {"price", placed.set.price},
            {"allowed", placed.is_allowed},
            {"worlds", answer.worlds},
            {"expected_error_N", placed.expected.objective.value_N},
            {"monte_carlo_interval_N", interval(placed.expected.objective)},
            {"error_95_N", placed.expected.error_95_N},
            {"gain_over_no_sensor_N", placed.gain_over_none.value_N},
            {"gain_interval_N", interval(placed.gain_over_none)},
            {"recommended", answer.words(answer.recommended ? answer.best().expected.candidate : 0)},
            {"worse_than_recommended_N", placed.worse_than_recommended.value_N},
            {"worse_interval_N", interval(placed.worse_than_recommended)},
            {"distinguishable", placed.is_distinguished()}};
}

PlacedLayout layout_of(const nlohmann::json& body) {
    return {member<std::vector<int>>(body, "nodes"), member<std::string>(body, "method")};
}

LayoutQuestion question_of(const nlohmann::json& body) {
    const int noise = member<int>(body, "noise");  // from 1
    if (noise < 1) throw BadRequest("'noise' counts the study's noise levels from 1");
    LayoutQuestion question{layout_of(body), member<std::string>(body, "regime"), noise - 1, {}};
    if (body.contains("reference")) question.reference = layout_of(body["reference"]);
    return question;
}

ordered_json score_json(const LayoutScore& score) {
    ordered_json json = {{"mean_abs_error_N", score.mean.value_N},
                         {"interval_low_N", score.mean.low_N},
                         {"interval_high_N", score.mean.high_N},
                         {"repetitions", score.repetitions},
                         {"instants", score.instants},
                         {"nodes", ordered_json::array()}};
    for (const NodeError& node : score.nodes)
        json["nodes"].push_back({{"node", node.node},
                                 {"mean_abs_error_N", node.mean_abs_error_N},
                                 {"bias_N", node.bias_N},
                                 {"low_N", node.low_N},
                                 {"high_N", node.high_N}});
    return json;
}

ordered_json comparison_json(const LayoutComparison& compared) {
    ordered_json json = score_json(compared.placed);
    if (!compared.reference) return json;
    json["reference"] = score_json(*compared.reference);
    json["worse_than_reference_N"] = compared.difference.value_N;
    json["worse_interval_N"] = {compared.difference.low_N, compared.difference.high_N};
    return json;
}

}  // namespace

std::vector<Route> layout_routes(RouteContext& context) {
    const auto score = [&](const http::Request& request, http::Response& response) {
        const LayoutQuestion question = question_of(body_of(request));
        try {
            send_json(response,
                      comparison_json(scorer_of(context, number_in_path(request))->score(question)));
        } catch (const InvalidInput& error) {
            throw BadRequest(error.what());
        }
    };
    const auto offers = [&](const http::Request& request, http::Response& response) {
        send_json(response, offers_json(placer_of(context, number_in_path(request))->answer()));
    };
    const auto place = [&](const http::Request& request, http::Response& response) {
        std::vector<int> sensors = member<std::vector<int>>(body_of(request), "sensors");
        for (int& sensor : sensors) --sensor;
        const std::shared_ptr<HandPlacer> placer = placer_of(context, number_in_path(request));
        try {
            send_json(response, placed_json(placer->judge(std::move(sensors)), placer->answer()));
        } catch (const InvalidInput& error) {
            throw BadRequest(error.what());
        }
    };
    std::vector<Route> routes{
        {"get",
         "/api/studies/{study_id}/sensors",
         "listSensors",
         "What can be bought in a study over worlds, and which sensors it recommends",
         "Sensors by number, from 1",
         json_of("object"),
         offers,
         200,
         {400, 409}},
        {"post",
         "/api/studies/{study_id}/sensors",
         "placeSensors",
         "The expected error with these sensors, in the worlds of the study",
         "The error, and how it compares with no sensor and with the recommended set",
         json_of("PlacedSensors"),
         place,
         200,
         {400, 409},
         {{"sensors", "[integer]", "Numbers of listSensors"}}},
        {"post",
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
          {"regime", "string", "Its name, or duty_cycle"},
          {"noise", "integer", "Which of the study's noise levels, from 1"},
          {"reference", "object", "Nodes and method of a layout to compare with", false}}}};
    return in_lane(Lane::scores, std::move(routes));
}

}  // namespace capstan::service
