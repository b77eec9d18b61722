#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/nearest_name.h"
#include "capstan/cli/output.h"
#include "capstan/cli/text_table.h"
#include "capstan/cli/usage_error.h"
#include "capstan/reports/parquet_file.h"
#include "capstan/storage/read_only_query.h"
#include "capstan/storage/schema_documentation.h"

namespace capstan::cli {

namespace {

using storage::DocumentedTable;

constexpr storage::QueryLimits patient{.time_limit_s = 3600};

std::vector<DocumentedTable> chosen_tables(const Invocation& invocation) {
    const std::vector<DocumentedTable> all = storage::schema_documentation();
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

// As declared; a view's computed column says by its values.
reports::ParquetType type_of(const storage::DocumentedColumn& column, const storage::QueryResult& result,
                             std::size_t index) {
    if (column.type == "INTEGER") return reports::ParquetType::whole;
    if (column.type == "REAL") return reports::ParquetType::real;
    if (column.type == "TEXT") return reports::ParquetType::text;
    bool whole = !result.rows.empty();
    for (const auto& row : result.rows) {
        if (std::holds_alternative<std::string>(row[index])) return reports::ParquetType::text;
        if (!std::holds_alternative<std::int64_t>(row[index])) whole = false;
    }
    return whole ? reports::ParquetType::whole : reports::ParquetType::real;
}

std::string as_parquet(const DocumentedTable& table, const storage::QueryResult& result) {
    std::vector<reports::ParquetColumn> columns;
    for (std::size_t k = 0; k < table.columns.size(); ++k)
        columns.push_back({table.columns[k].name, type_of(table.columns[k], result, k)});
    return reports::parquet_file(columns, result.rows);
}

std::string formatted(const std::string& format, const DocumentedTable& table,
                      const storage::QueryResult& result) {
    if (format == "csv") return as_csv(result);
    return format == "json" ? as_json(result) : as_parquet(table, result);
}

ExitCode run(const Invocation& invocation) {
    const std::vector<DocumentedTable> tables = chosen_tables(invocation);
    const std::filesystem::path folder = invocation.argument("FOLDER");
    const std::string& format = invocation.text("format");
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem)
        throw std::runtime_error(fmt::format("cannot make {}: {}", folder.string(), problem.message()));
    for (const DocumentedTable& table : tables) {
        const auto result = storage::run_read_only(database, "SELECT * FROM " + table.name, {}, patient);
        const std::filesystem::path file = folder / (table.name + "." + format);
        write_file(file, formatted(format, table, result));
        fmt::print(stderr, "{}: {} rows\n", file.string(), result.rows.size());
    }
    return ExitCode::success;
}

}  // namespace

Command export_command() {
    return {"export",
            "Write every table and view as CSV, Parquet or JSON.",
            "Writes each table and view of the database into a file of its own, in full precision: CSV for a "
            "spreadsheet, Parquet for pandas, R or DuckDB, JSON for programs.",
            {{"FOLDER", "Where the files go; made if it is not there."}},
            {{"format",
              '\0',
              OptionKind::text,
              "csv|parquet|json",
              "How to write.",
              "csv",
              {"csv", "parquet", "json"}},
             {"tables", '\0', OptionKind::text, "LIST", "Only these, as cell,v_best_method."},
             database_option,
             help_option},
            {"capstan export tables", "capstan export tables --format parquet --tables v_error_by_layout"},
            run};
}

}  // namespace capstan::cli
