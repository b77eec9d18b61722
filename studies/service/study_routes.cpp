// Stored studies: the list, the progress of each, and its conclusions.
#include "capstan/answers/placement_answers.h"
#include "capstan/answers/study_answers.h"
#include "capstan/reports/query_rows.h"
#include "capstan/reports/study_report.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/storage/error.h"
#include "capstan/storage/report_queries.h"

namespace capstan::service {

namespace {

using Handler = http::Handler;
using StudyHandler = std::function<void(storage::Database&, std::int64_t study_id, http::Response&)>;

// For the paths /api/studies/{study_id}/...; an unknown study is a 404.
Handler of_study(const RouteContext& context, const StudyHandler& answer) {
    return [&context, answer](const http::Request& request, http::Response& response) {
        storage::Database database = context.open();
        const std::int64_t id = number_in_path(request);
        study_state(database, id);
        answer(database, id, response);
    };
}

std::string recommendation_json(storage::Database& database, std::int64_t study_id) {
    try {
        return reports::answer_json(answers::conclusions_answer(database, study_id));
    } catch (const storage::Error& error) {  // not complete yet
        throw BadRequest(error.what(), 409);
    }
}

}  // namespace

std::vector<Route> study_routes(RouteContext& context) {
    const auto list = [&](const http::Request&, http::Response& response) {
        storage::Database database = context.open();
        send_text(response, reports::rows_json(answers::studies_table(database)), "application/json");
    };
    const auto rows_of = [&](std::string_view query) {
        return of_study(
            context, [query](storage::Database& database, std::int64_t id, http::Response& response) {
                send_text(response, reports::rows_json(storage::run_read_only(database, query, {id})),
                          "application/json");
            });
    };
    const auto show = [&](storage::Database& database, std::int64_t id, http::Response& response) {
        send_text(response, reports::answer_json(answers::study_answer(database, id)), "application/json");
    };
    const auto recommend = [&](storage::Database& database, std::int64_t id, http::Response& response) {
        send_text(response, recommendation_json(database, id), "application/json");
    };
    const auto report = [&](storage::Database& database, std::int64_t id, http::Response& response) {
        const auto text = context.about_study("report", database, id,
                                              [&] { return reports::study_report_json(database, id); });
        send_kept(response, text, "application/json");
    };
    std::vector<Route> routes{
        {"get", "/api/studies", "listStudies", "The studies, oldest first; as `capstan study list --json`",
         "Studies", json_of("[Study]"), list},
        {"get", "/api/studies/{study_id}", "showStudy", "As `capstan study show --json`", "The study",
         json_of("object"), of_study(context, show)},
        {"get", "/api/studies/{study_id}/units", "listUnits", "The work units, done or not", "Units",
         json_of("[object]"), rows_of(storage::units_query)},
        {"get", "/api/studies/{study_id}/cable", "showCable", "The cable, segment by segment from the motor",
         "Segments", json_of("[object]"), rows_of(storage::cable_query)},
        {"get",
         "/api/studies/{study_id}/recommendation",
         "recommend",
         "As `capstan recommend --json`",
         "The recommendation",
         json_of("object"),
         of_study(context, recommend),
         200,
         {409}},
        {"get", "/api/studies/{study_id}/report", "report",
         "Every table of the report, as `capstan report --format json`", "Tables", json_of("object"),
         of_study(context, report)},
    };
    return in_lane(Lane::reports, std::move(routes));
}

}  // namespace capstan::service
