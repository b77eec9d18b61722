#include <fmt/format.h>

#include <cstdio>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/reports/plain_tables.h"
#include "capstan/storage/error.h"
#include "capstan/storage/read_only_query.h"
#include "capstan/storage/schema.h"
#include "capstan/storage/schema_documentation.h"

namespace capstan::cli {

namespace {

storage::QueryResult answer(storage::Database& database, const std::string& sql) {
    try {
        return storage::run_read_only(database, sql);
    } catch (const storage::Error& error) {
        throw UsageError(std::string("capstan query: ") + error.what());
    }
}

std::string formatted(const storage::QueryResult& result, const std::string& format) {
    if (format == "csv") return reports::csv_text(result.columns, result.rows);
    return format == "json" ? answers::rows_json(result) : answers::rows_text(result);
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
    deliver(invocation, formatted(answer(database, invocation.argument("SQL")), format));
    return ExitCode::success;
}

}  // namespace

Command query_command() {
    return {.name = "query",
            .summary = "Run a read-only SQL query on the database.",
            .description =
                "Runs one SELECT on the results database and prints the rows. The views v_error_by_layout, "
                "v_best_method, v_single_sensor_matrix, v_recommendation, v_diagnosis and v_progress answer "
                "the usual questions; --schema explains every table, column and unit. A query cannot change "
                "anything and is stopped after ten seconds.",
            .arguments = {{"SQL", "One SELECT (or WITH ... SELECT), in quotes.", ArgumentNeed::optional}},
            .options = {{.name = "format",
                         .value = "table|csv|json|md",
                         .meaning =
                             "Format of the rows; csv and json have full precision. md is only for --schema.",
                         .default_value = "table",
                         .choices = {"table", "csv", "json", "md"}},
                        {.name = "schema",
                         .kind = OptionKind::flag,
                         .meaning = "Print all tables and views with their comments instead."},
                        database_option,
                        output_option,
                        {.name = "json", .kind = OptionKind::flag, .meaning = "The same as --format json."},
                        help_option},
            .examples = {"capstan query \"SELECT * FROM v_best_method WHERE sensor_count = 3\"",
                         "capstan query \"SELECT * FROM v_error_by_layout\" --format csv -o errors.csv"},
            .run = run_query};
}

}  // namespace capstan::cli
