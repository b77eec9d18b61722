// Studies as they are stored: what there is, how far each has come, what follows from it.
#include "capstan/reports/study_report.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/service/study_state.h"
#include "capstan/storage/live_queries.h"

namespace capstan::service {

namespace {

using Handler = httplib::Server::Handler;
using StudyHandler = std::function<void(storage::Database&, std::int64_t study_id, httplib::Response&)>;

// For the paths /api/studies/{study_id}/...; an unknown study is a 404.
Handler of_study(const RouteContext& context, const StudyHandler& answer) {
    return [&context, answer](const httplib::Request& request, httplib::Response& response) {
        storage::Database database = context.open();
        const std::int64_t id = number_in_path(request);
        study_state(database, id);
        answer(database, id, response);
    };
}

}  // namespace

void add_study_routes(httplib::Server& server, RouteContext& context) {
    const Answers& answers = context.options.answers;
    server.Get("/api/studies", [&](const httplib::Request&, httplib::Response& response) {
        storage::Database database = context.open();
        send_text(response, answers.rows_json(storage::run_read_only(database, storage::studies_query)),
                  "application/json");
    });
    server.Get(R"(/api/studies/(\d+))", of_study(context, [&](storage::Database& database, std::int64_t id,
                                                              httplib::Response& response) {
                   send_text(response, answers.study(database, id), "application/json");
               }));
    const auto rows_of = [&](std::string_view query) {
        return of_study(context, [&answers, query](storage::Database& database, std::int64_t id,
                                                   httplib::Response& response) {
            send_text(response, answers.rows_json(storage::run_read_only(database, query, {id})),
                      "application/json");
        });
    };
    server.Get(R"(/api/studies/(\d+)/units)", rows_of(storage::units_query));
    server.Get(R"(/api/studies/(\d+)/cable)", rows_of(storage::cable_query));
    server.Get(
        R"(/api/studies/(\d+)/recommendation)",
        of_study(context, [&](storage::Database& database, std::int64_t id, httplib::Response& response) {
            send_text(response, answers.recommendation(database, id), "application/json");
        }));
    server.Get(
        R"(/api/studies/(\d+)/report)",
        of_study(context, [&](storage::Database& database, std::int64_t id, httplib::Response& response) {
            const auto report = context.about_study("report", database, id,
                                                    [&] { return reports::study_report_json(database, id); });
            send_text(response, *report, "application/json");
        }));
}

}  // namespace capstan::service
