// The query box: SQL of any user, which can read everything and change nothing.
#include <fmt/format.h>

#include <filesystem>
#include <semaphore>

#include "capstan/answers/study_answers.h"
#include "capstan/reports/plain_tables.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/storage/error.h"
#include "capstan/storage/schema.h"

namespace capstan::service {

namespace {

constexpr std::ptrdiff_t at_once = 4;             // queries; more would only compete for the processor
constexpr std::chrono::seconds longest_wait{10};  // for a turn
constexpr std::size_t max_rows = 100'000;         // of an answer; `capstan query` has no limit

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
        return storage::run_read_only(database, sql, {},
                                      {.time_limit_s = context.options.query_limit_s, .row_limit = max_rows});
    } catch (const storage::QueryTooSlow& error) {
        throw BadRequest(error.what(), 408);
    } catch (const storage::Error& error) {
        throw BadRequest(error.what());
    }
}

// The time of the last write and the size of the database: every answer depends on them.
std::string database_state(const RouteContext& context) {
    std::string state;
    for (const char* part : {"", "-wal"}) {
        const std::filesystem::path file = context.options.commands.database + part;
        std::error_code absent;
        const auto size = std::filesystem::file_size(file, absent);
        const auto written = std::filesystem::last_write_time(file, absent).time_since_epoch().count();
        state += fmt::format("{} {} ", absent ? 0 : size, absent ? 0 : written);
    }
    return state;
}

// An answer as it is sent. Many clients ask the same while a study runs, so it is computed at most once a
// moment.
struct SentAnswer {
    bool truncated = false;
    std::string text;
};

SentAnswer sent(RouteContext& context, const std::string& sql, const std::string& format) {
    const auto kept = context.query_answers.get(
        format + " " + sql, database_state(context), ReportShelf::Freshness::just_made, [&] {
            const storage::QueryResult result = answer(context, sql);
            return (result.truncated ? "t" : "f") + (format == "csv"
                                                         ? reports::csv_text(result.columns, result.rows)
                                                         : answers::rows_json(result));
        });
    return {kept->front() == 't', kept->substr(1)};
}

}  // namespace

std::vector<Route> query_routes(RouteContext& context) {
    const auto query = [&](const httplib::Request& request, httplib::Response& response) {
        const auto body = body_of(request);
        const std::string format = body.contains("format") ? member<std::string>(body, "format") : "json";
        if (format != "json" && format != "csv") throw BadRequest("'format' must be json or csv");
        const SentAnswer answer = sent(context, member<std::string>(body, "sql"), format);
        if (answer.truncated) response.set_header("X-Truncated", "yes");
        if (format == "csv")
            response.set_header("Content-Disposition", "attachment; filename=\"capstan-query.csv\"");
        send_text(response, answer.text, format == "csv" ? "text/csv; charset=utf-8" : "application/json");
    };
    const auto schema = [](const httplib::Request&, httplib::Response& response) {
        send_text(response, storage::schema_text(), "text/plain; charset=utf-8");
    };
    return {
        {"post",
         "/api/query",
         "query",
         fmt::format("One SELECT, as `capstan query`, for a limited time. An answer has at most {} rows; a "
                     "longer one is cut and has the header X-Truncated",
                     max_rows),
         "Rows",
         {{"application/json", "[object]"}, {"text/csv", "string"}},
         query,
         200,
         {400, 408, 503},
         {{"sql", "string"}, {"format", "json|csv", "json if absent", false}}},
        {"get",
         "/api/schema",
         "schema",
         "Tables, columns, units and views, as `capstan query --schema`",
         "SQL with comments",
         {{"text/plain", "string"}},
         schema},
    };
}

}  // namespace capstan::service
