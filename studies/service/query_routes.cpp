// The query box: anyone's SQL, which may read everything and change nothing.
#include <semaphore>

#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/storage/error.h"
#include "capstan/storage/schema.h"

namespace capstan::service {

namespace {

constexpr std::ptrdiff_t at_once = 4;             // queries; more would only wait for the processor
constexpr std::chrono::seconds longest_wait{10};  // for a turn
constexpr std::size_t most_rows = 100'000;        // of an answer; `capstan query` has no limit

std::counting_semaphore<at_once> turns{at_once};

class Turn {
  public:
    Turn() {
        if (!turns.try_acquire_for(longest_wait))
            throw BadRequest("too many queries at once; try again in a moment", 503);
    }
    ~Turn() { turns.release(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
};

storage::QueryResult answer(const RouteContext& context, const std::string& sql) {
    const Turn turn;
    storage::Database database = context.open();
    try {
        return storage::run_read_only(
            database, sql, {}, {.time_limit_s = context.options.query_limit_s, .row_limit = most_rows});
    } catch (const storage::QueryTooSlow& error) {
        throw BadRequest(error.what(), 408);
    } catch (const storage::Error& error) {
        throw BadRequest(error.what());
    }
}

}  // namespace

void add_query_routes(httplib::Server& server, RouteContext& context) {
    server.Post("/api/query", [&](const httplib::Request& request, httplib::Response& response) {
        const auto body = body_of(request);
        const std::string format = body.contains("format") ? member<std::string>(body, "format") : "json";
        if (format != "json" && format != "csv") throw BadRequest("'format' must be json or csv");
        const storage::QueryResult result = answer(context, member<std::string>(body, "sql"));
        if (result.truncated) response.set_header("X-Truncated", "yes");
        if (format == "csv") {
            response.set_header("Content-Disposition", "attachment; filename=\"capstan-query.csv\"");
            return send_text(response, context.options.answers.rows_csv(result), "text/csv; charset=utf-8");
        }
        send_text(response, context.options.answers.rows_json(result), "application/json");
    });
    server.Get("/api/schema", [](const httplib::Request&, httplib::Response& response) {
        send_text(response, storage::schema_text(), "text/plain; charset=utf-8");
    });
}

}  // namespace capstan::service
