// What people do with stored studies: notes, the trash, the history, and what a study would cost.
#include <fmt/format.h>

#include "capstan/answers/study_answers.h"
#include "capstan/config/config_writer.h"
#include "capstan/reports/query_rows.h"
#include "capstan/service/cost_estimate.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/storage/error.h"
#include "capstan/storage/study_store.h"

namespace capstan::service {

namespace {

constexpr std::string_view history_query =
    "SELECT event, at_utc, command FROM history WHERE study_id = ?1 ORDER BY event_id";
constexpr std::size_t longest_note = 2000;

storage::Database writable(const RouteContext& context) {
    return storage::Database::open_existing(context.options.commands.database);
}

std::string short_text(const nlohmann::json& body, const char* name) {
    auto text = member<std::string>(body, name);
    if (text.size() > longest_note)
        throw BadRequest(fmt::format("'{}' may have {} bytes at most", name, longest_note));
    return text;
}

ordered_json moved(RouteContext& context, std::int64_t id, storage::Shelf to) {
    storage::Database database = writable(context);
    try {
        storage::find_study(database, std::to_string(id),
                            to == storage::Shelf::trash ? storage::Shelf::studies : storage::Shelf::trash);
    } catch (const storage::Error& error) {
        throw BadRequest(error.what(), 404);
    }
    to == storage::Shelf::trash ? storage::trash_study(database, id) : storage::restore_study(database, id);
    return {{"study_id", id}, {"deleted", to == storage::Shelf::trash}};
}

void annotate(RouteContext& context, std::int64_t id, const nlohmann::json& body) {
    std::optional<std::string> note, tags;
    if (body.contains("note")) note = short_text(body, "note");
    if (body.contains("tags")) tags = short_text(body, "tags");
    storage::Database database = writable(context);
    study_state(database, id);
    storage::annotate_study(database, id, note, tags);
}

}  // namespace

ordered_json cost_of_studies_in(const RouteContext& context, const nlohmann::json& body) {
    const std::vector<StudyPlan> plans = studies_in(context, body);
    const bool is_over_worlds = plans.front().uncertainty.is_stated;
    const auto toml = is_over_worlds ? config::config_text(plans.front(), config::Comments::none)
                      : body.contains("config")
                          ? config_named(context.options, member<std::string>(body, "config"))
                          : member<std::string>(body, "config_toml");
    ordered_json told = cost_of_studies(context.options.commands, toml, is_over_worlds);
    if (is_over_worlds && told.contains("seconds")) {  // the first one's, times their number
        told["studies"] = plans.size();
        told["seconds"] = told["seconds"].get<double>() * static_cast<double>(plans.size());
    }
    return told;
}

std::vector<Route> study_action_routes(RouteContext& context) {
    const auto list_deleted = [&](const http::Request&, http::Response& response) {
        storage::Database database = context.open();
        send_text(response, reports::rows_json(answers::studies_table(database, storage::Shelf::trash)),
                  "application/json");
    };
    const auto remove = [&](const http::Request& request, http::Response& response) {
        send_json(response, moved(context, number_in_path(request), storage::Shelf::trash));
    };
    const auto restore = [&](const http::Request& request, http::Response& response) {
        send_json(response, moved(context, number_in_path(request), storage::Shelf::studies));
    };
    const auto note = [&](const http::Request& request, http::Response& response) {
        annotate(context, number_in_path(request), body_of(request));
        send_json(response, {{"study_id", number_in_path(request)}});
    };
    const auto show_config = [&](const http::Request& request, http::Response& response) {
        storage::Database database = context.open();
        const std::int64_t id = number_in_path(request);
        study_state(database, id);
        send_text(response, storage::load_study(database, id).study.config_toml, "text/plain; charset=utf-8");
    };
    const auto history = [&](const http::Request& request, http::Response& response) {
        storage::Database database = context.open();
        const std::int64_t id = number_in_path(request);
        study_state(database, id);
        send_text(response, reports::rows_json(storage::run_read_only(database, history_query, {id})),
                  "application/json");
    };
    const auto tell_cost = [&](const http::Request& request, http::Response& response) {
        send_json(response, cost_of_studies_in(context, body_of(request)));
    };
    const ApiField by_name{"config", "string", "A name of /api/configs; or", false};
    const ApiField by_text{"config_toml", "string", "the text of a configuration", false};
    std::vector<Route> routes{
        {"get", "/api/studies/deleted", "listDeleted", "The trash; as `capstan study list --deleted --json`",
         "Studies", json_of("[Study]"), list_deleted},
        {"post", "/api/studies/{study_id}/delete", "deleteStudy",
         "Move a study to the trash, as `capstan study delete`", "Its number", json_of("object"), remove},
        {"post", "/api/studies/{study_id}/restore", "restoreStudy", "Bring a deleted study back",
         "Its number", json_of("object"), restore},
        {"post",
         "/api/studies/{study_id}/note",
         "annotateStudy",
         "Give a study a note and tags, as `capstan study note`",
         "Its number",
         json_of("object"),
         note,
         200,
         {400},
         {{"note", "string", "stays if absent", false},
          {"tags", "string", "words with blanks between them", false}}},
        {"get",
         "/api/studies/{study_id}/config",
         "studyConfig",
         "The configuration of a study with every key, from which it can be run again",
         "TOML",
         {{"text/plain", "string"}},
         show_config},
        {"get", "/api/studies/{study_id}/history", "studyHistory",
         "What was done to a study, when and by which command", "Events", json_of("[object]"), history},
    };
    routes = in_lane(Lane::reports, std::move(routes));
    routes.push_back({"post",
                      "/api/studies/cost",
                      "studyCost",
                      "What the studies of a configuration would cost on this machine",
                      "The cost",
                      json_of("object"),
                      tell_cost,
                      200,
                      {400, 404, 503},
                      {by_name, by_text},
                      "application/json",
                      Lane::imports});
    return routes;
}

}  // namespace capstan::service
