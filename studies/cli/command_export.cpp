#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/platform/nearest_name.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/reports/table_export.h"

namespace capstan::cli {

namespace {

using storage::DocumentedTable;

std::vector<DocumentedTable> chosen_tables(const Invocation& invocation) {
    std::vector<DocumentedTable> all = storage::schema_documentation();
    if (!invocation.has("tables")) return all;
    std::vector<std::string> names;
    for (const DocumentedTable& table : all) names.push_back(table.name);
    std::vector<DocumentedTable> chosen;
    for (const std::string& word : split_at_commas(invocation.text("tables"))) {
        const auto found = std::find(names.begin(), names.end(), word);
        if (found == names.end())
            throw UsageError(fmt::format("capstan export: there is no table or view '{}'{}", word,
                                         suggestion(word, names)));
        chosen.push_back(all[static_cast<std::size_t>(found - names.begin())]);
    }
    return chosen;
}

ExitCode run_export(const Invocation& invocation) {
    const std::vector<DocumentedTable> tables = chosen_tables(invocation);
    const std::filesystem::path folder = invocation.argument("FOLDER");
    const std::string& format = invocation.text("format");
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem)
        throw std::runtime_error(fmt::format("cannot make {}: {}", folder.string(), problem.message()));
    for (const DocumentedTable& table : tables) {
        const std::filesystem::path file = folder / (table.name + "." + format);
        const std::size_t rows = reports::write_table(database, table, file, format);
        say(fmt::format("{}: {} rows", file.string(), rows));
    }
    return ExitCode::success;
}

}  // namespace

Command export_command() {
    return {.name = "export",
            .summary = "Write every table and view as CSV, Parquet or JSON.",
            .description =
                "Writes each table and view of the database to a file of its own, in full precision: CSV for "
                "spreadsheets, Parquet for pandas, R or DuckDB, JSON for programs.",
            .arguments = {{"FOLDER", "Folder for the files; it is created if it does not exist."}},
            .options = {{.name = "format",
                         .meaning = "Format of the files.",
                         .default_value = "csv",
                         .choices = {"csv", "parquet", "json"}},
                        {.name = "tables",
                         .value = "LIST",
                         .meaning = "Export only these tables and views, for example cell,v_best_method."},
                        database_option,
                        help_option},
            .examples = {"capstan export tables",
                         "capstan export tables --format parquet --tables v_error_by_layout"},
            .run = run_export,
            .time = "About a second for a million rows."};
}

}  // namespace capstan::cli
