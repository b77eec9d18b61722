// The query box: SQL of any user, which can read everything and change nothing.
#include <fmt/format.h>

#include <filesystem>

#include "capstan/platform/child_process.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/storage/schema.h"

namespace capstan::service {

namespace {

constexpr std::size_t max_rows = 100'000;               // of an answer; `capstan query` has no limit
constexpr std::size_t max_answer_bytes = 12 << 20;      // as text
constexpr std::size_t longest_sql = 100'000;            // one word of a command line has at most 128 KiB
constexpr std::size_t query_memory_bytes = 768U << 20;  // the address space of `capstan query`
constexpr std::chrono::milliseconds start_up{2000};     // of a process, on a busy machine
constexpr int failed_by_signal = 128;
constexpr int failed_while_running = 1;  // exit code of `capstan query` at one of its limits

struct SentAnswer {
    bool truncated = false;
    std::string text;
};

std::string message_of(const CommandOutput& ended) {
    std::string text = ended.messages;
    for (const std::string_view unwanted : {"capstan query: ", "capstan: query: ", "capstan: "}) {
        if (text.starts_with(unwanted)) text.erase(0, unwanted.size());
    }
    while (text.ends_with('\n')) text.pop_back();
    return text.empty() ? "the query was ended: it took too much time, memory or processor" : text;
}

// In a process of its own, which the system ends at its limits: no query can hold or end the service.
SentAnswer answer(const RouteContext& context, const std::string& sql, const std::string& format) {
    const ServiceOptions& options = context.options;
    if (sql.size() > longest_sql || sql.find('\0') != std::string::npos)
        throw BadRequest(fmt::format("'sql' must be a text of at most {} bytes without zeros", longest_sql));
    const auto limit = std::chrono::milliseconds(static_cast<int>(1000 * options.query_limit_s));
    const ChildLimits process{.nice_increment = 5,
                              .memory_bytes = query_memory_bytes,
                              .processor_s = static_cast<int>(options.query_limit_s) + 2};
    CommandOutput ended = run_command({options.commands.program, "query", "--db", options.commands.database,
                                       "--format", format, "--max-rows", std::to_string(max_rows),
                                       "--time-limit", fmt::format("{:g}", options.query_limit_s), "--", sql},
                                      process, {limit + start_up, max_answer_bytes, options.commands.ending});
    if (ended.exit_code == 0) return {!ended.messages.empty(), std::move(ended.output)};
    if (ended.is_long)
        throw BadRequest("the answer is longer than 12 MB; ask for fewer rows or columns", 413);
    if (ended.exit_code >= failed_by_signal || ended.exit_code == failed_while_running)
        throw BadRequest(message_of(ended), 408);
    throw BadRequest(message_of(ended));
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

// Many clients ask the same while a study runs, so an answer is computed at most once a moment. A kept text
// begins with a letter that says whether it was cut off.
SentAnswer sent(RouteContext& context, const std::string& sql, const std::string& format) {
    const auto kept = context.query_answers.get(format + " " + sql, database_state(context),
                                                ReportShelf::Freshness::just_made, [&] {
                                                    const SentAnswer made = answer(context, sql, format);
                                                    return (made.truncated ? "t" : "f") + made.text;
                                                });
    const std::string_view text = kept->plain();
    return {text.front() == 't', std::string(text.substr(1))};
}

}  // namespace

std::vector<Route> query_routes(RouteContext& context) {
    const auto query = [&](const http::Request& request, http::Response& response) {
        const auto body = body_of(request);
        const std::string format = body.contains("format") ? member<std::string>(body, "format") : "json";
        if (format != "json" && format != "csv") throw BadRequest("'format' must be json or csv");
        SentAnswer answer = sent(context, member<std::string>(body, "sql"), format);
        if (answer.truncated) response.add_header("X-Truncated", "yes");
        if (format == "csv")
            response.add_header("Content-Disposition", "attachment; filename=\"capstan-query.csv\"");
        send_text(response, std::move(answer.text),
                  format == "csv" ? "text/csv; charset=utf-8" : "application/json");
    };
    const auto schema = [](const http::Request&, http::Response& response) {
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
         {400, 408, 413, 503},
         {{"sql", "string"}, {"format", "json|csv", "json if absent", false}},
         "application/json",
         Lane::queries},
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
