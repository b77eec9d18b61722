#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <sstream>
#include <utility>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/platform/files.h"
#include "capstan/platform/nearest_name.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/reports/parquet_file.h"
#include "capstan/reports/plain_tables.h"
#include "capstan/storage/read_only_query.h"
#include "capstan/storage/schema_documentation.h"

namespace capstan::cli {

namespace {

using storage::DocumentedTable;

constexpr storage::QueryLimits patient{.time_limit_s = 3600};

std::vector<DocumentedTable> chosen_tables(const Invocation& invocation) {
    std::vector<DocumentedTable> all = storage::schema_documentation();
    if (!invocation.has("tables")) return all;
    std::vector<std::string> names;
    for (const DocumentedTable& table : all) names.push_back(table.name);
    std::vector<DocumentedTable> chosen;
    std::istringstream words(invocation.text("tables"));
    for (std::string word; std::getline(words, word, ',');) {
        const auto found = std::find(names.begin(), names.end(), word);
        if (found == names.end())
            throw UsageError(fmt::format("capstan export: there is no table or view '{}'{}", word,
                                         suggestion(word, names)));
        chosen.push_back(all[static_cast<std::size_t>(found - names.begin())]);
    }
    return chosen;
}

// The declared type; for a computed column of a view, the type of its values.
reports::ParquetType type_of(storage::Database& database, const DocumentedTable& table,
                             const storage::DocumentedColumn& column) {
    if (column.type == "INTEGER") return reports::ParquetType::integer;
    if (column.type == "REAL") return reports::ParquetType::number;
    if (column.type == "TEXT") return reports::ParquetType::string;
    const auto found = storage::run_read_only(
        database,
        fmt::format(
            "SELECT coalesce(max(typeof({0}) = 'text'), 0), coalesce(min(typeof({0}) = 'integer'), 0) FROM {1}",
            column.name, table.name),
        {}, patient);
    const auto holds = [&](std::size_t k) { return std::get<std::int64_t>(found.rows.at(0).at(k)) == 1; };
    if (holds(0)) return reports::ParquetType::string;
    return holds(1) ? reports::ParquetType::integer : reports::ParquetType::number;
}

// Writes rows to a file in one format.
struct RowsToFile {
    storage::RowVisitor visitor;
    std::function<void()> end;
};

RowsToFile as_csv_file(AtomicFile& file) {
    return {{[&](const std::vector<std::string>& columns) { file.append(reports::csv_head(columns)); },
             [&](std::vector<storage::QueryValue>& row) {
                 file.append(reports::csv_line(row));
                 return true;
             }},
            [] {}};
}

RowsToFile as_json_file(AtomicFile& file) {
    struct State {
        std::vector<std::string> columns;
        bool empty = true;
    };
    const auto state = std::make_shared<State>();
    return {{[state](const std::vector<std::string>& names) { state->columns = names; },
             [state, &file](std::vector<storage::QueryValue>& row) {
                 file.append(std::exchange(state->empty, false) ? "[\n" : ",\n");
                 file.append(answers::row_json(state->columns, row));
                 return true;
             }},
            [state, &file] { file.append(state->empty ? "[]\n" : "\n]\n"); }};
}

RowsToFile as_parquet_file(AtomicFile& file, storage::Database& database, const DocumentedTable& table) {
    std::vector<reports::ParquetColumn> columns;
    for (const auto& column : table.columns)
        columns.push_back({column.name, type_of(database, table, column)});
    const auto writer = std::make_shared<reports::ParquetWriter>(
        columns, [&file](std::string_view bytes) { file.append(bytes); });
    return {{[](const std::vector<std::string>&) {},
             [writer](std::vector<storage::QueryValue>& row) {
                 writer->add(row);
                 return true;
             }},
            [writer] { writer->finish(); }};
}

// Row by row: a table may be larger than memory. Returns how many there were.
std::size_t export_table(storage::Database& database, const DocumentedTable& table,
                         const std::filesystem::path& path, const std::string& format) {
    AtomicFile file(path);
    const RowsToFile rows = format == "csv"    ? as_csv_file(file)
                            : format == "json" ? as_json_file(file)
                                               : as_parquet_file(file, database, table);
    std::size_t count = 0;
    const auto counted = [&](std::vector<storage::QueryValue>& row) {
        ++count;
        return rows.visitor.visit(row);
    };
    storage::visit_read_only(database, "SELECT * FROM " + table.name, {rows.visitor.begin, counted}, {},
                             patient.time_limit_s);
    rows.end();
    file.finish();
    return count;
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
        const std::size_t rows = export_table(database, table, file, format);
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
                         .value = "csv|parquet|json",
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
            .run = run_export};
}

}  // namespace capstan::cli
