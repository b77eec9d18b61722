#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/reports/plain_tables.h"
#include "capstan/reports/query_rows.h"
#include "capstan/storage/error.h"
#include "capstan/storage/read_only_query.h"
#include "capstan/storage/schema.h"
#include "capstan/storage/schema_documentation.h"

namespace capstan::cli {

namespace {

constexpr std::int64_t query_memory_bytes = std::int64_t{512} << 20;
constexpr std::chrono::milliseconds query_grace{500};

// SQLite looks at the time between the steps of its machine. One step on long strings, and the compilation of
// a statement, can take minutes: then this ends the program, which only reads.
class QueryWatch {
  public:
    explicit QueryWatch(double time_limit_s)
        : thread_([time_limit_s](const std::stop_token& stop) {
              std::mutex mutex;
              std::unique_lock lock(mutex);
              const auto limit = std::chrono::duration<double>(time_limit_s) + query_grace;
              if (std::condition_variable_any().wait_for(lock, stop, limit,
                                                         [&] { return stop.stop_requested(); }))
                  return;
              if (stop.stop_requested()) return;
              say(fmt::format("capstan query: The query took longer than {:g} s and was stopped.",
                              time_limit_s));
              std::_Exit(static_cast<int>(ExitCode::failure));
          }) {}

  private:
    std::jthread thread_;
};

storage::QueryResult answer(storage::Database& database, const Invocation& invocation) {
    storage::QueryLimits limits{.time_limit_s = invocation.number("time-limit")};
    if (invocation.has("max-rows"))
        limits.row_limit = static_cast<std::size_t>(invocation.integer("max-rows"));
    storage::limit_query_memory(query_memory_bytes);
    const QueryWatch watch(limits.time_limit_s);
    try {
        return storage::run_read_only(database, invocation.argument("SQL"), {}, limits);
    } catch (const storage::QueryTooSlow& error) {
        throw std::runtime_error(std::string("query: ") + error.what());
    } catch (const storage::QueryTooLarge& error) {
        throw std::runtime_error(std::string("query: ") + error.what());
    } catch (const storage::Error& error) {
        throw UsageError(std::string("capstan query: ") + error.what());
    }
}

std::string formatted(const storage::QueryResult& result, const std::string& format) {
    if (format == "csv") return reports::csv_text(result.columns, result.rows);
    return format == "json" ? reports::rows_json(result) : reports::rows_text(result);
}

ExitCode run_query(const Invocation& invocation) {
    if (invocation.has("schema")) {
        const bool markdown = invocation.text("format") == "md";
        deliver(invocation, markdown ? storage::schema_markdown() : storage::schema_text());
        return ExitCode::success;
    }
    if (!invocation.has_argument("SQL")) {
        throw UsageError(
            "capstan query: SQL is missing, for example \"SELECT * FROM v_progress\"; `capstan query "
            "--schema` shows the tables");
    }
    const std::string format = invocation.has("json") ? "json" : invocation.text("format");
    if (format == "md")
        throw UsageError(
            "capstan query: --format md is for --schema; rows are printed as table, csv or json");
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const storage::QueryResult result = answer(database, invocation);
    deliver(invocation, formatted(result, format));
    if (result.truncated) say(fmt::format("The answer was cut off after {} rows.", result.rows.size()));
    return ExitCode::success;
}

}  // namespace

Command query_command() {
    return {
        .name = "query",
        .summary = "Run a read-only SQL query on the database.",
        .description =
            "Runs one SELECT on the results database and prints the rows. The views v_error_by_layout, "
            "v_best_method, v_single_sensor_matrix, v_recommendation, v_diagnosis and v_progress answer "
            "the usual questions; --schema explains every table, column and unit. A query cannot change "
            "anything, is stopped after --time-limit, and gets at most 512 MB of memory. It sees nothing of studies in the trash.",
        .arguments = {{"SQL", "One SELECT (or WITH ... SELECT), in quotes.", ArgumentNeed::optional}},
        .options = {{.name = "format",
                     .meaning =
                         "Format of the rows; csv and json have full precision. md is only for --schema.",
                     .default_value = "table",
                     .choices = {"table", "csv", "json", "md"}},
                    {.name = "schema", .meaning = "Print all tables and views with their comments instead."},
                    {.name = "time-limit",
                     .kind = OptionKind::number,
                     .value = "SECONDS",
                     .meaning = "Stop the query after this time.",
                     .default_value = "10",
                     .limits = {0.01, 86400}},
                    {.name = "max-rows",
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning = "Cut the answer off after N rows, or after 8 MB, and say so.",
                     .limits = {1, 1e9}},
                    database_option,
                    output_option,
                    {.name = "json", .meaning = "The same as --format json."},
                    help_option},
        .examples = {"capstan query \"SELECT * FROM v_best_method WHERE sensor_count = 3\"",
                     "capstan query \"SELECT * FROM v_error_by_layout\" --format csv -o errors.csv"},
        .run = run_query,
        .time = "As long as the query, at most --time-limit."};
}

}  // namespace capstan::cli
