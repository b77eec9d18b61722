#include "capstan/reports/table_export.h"

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <utility>

#include "capstan/platform/files.h"
#include "capstan/reports/parquet_file.h"
#include "capstan/reports/plain_tables.h"
#include "capstan/reports/query_rows.h"
#include "capstan/storage/read_only_query.h"

namespace capstan::reports {

namespace {

using storage::DocumentedTable;

constexpr storage::QueryLimits table_limits{.time_limit_s = 3600};  // of a table, however large

// The declared type; for a computed column of a view, the type of its values.
ParquetType type_of(storage::Database& database, const DocumentedTable& table,
                    const storage::DocumentedColumn& column) {
    if (column.type == "INTEGER") return ParquetType::integer;
    if (column.type == "REAL") return ParquetType::number;
    if (column.type == "TEXT") return ParquetType::string;
    const auto found = storage::run_read_only(
        database,
        fmt::format(
            "SELECT coalesce(max(typeof({0}) = 'text'), 0), coalesce(min(typeof({0}) = 'integer'), 0) FROM {1}",
            column.name, table.name),
        {}, table_limits);
    const auto holds = [&](std::size_t k) { return std::get<std::int64_t>(found.rows.at(0).at(k)) == 1; };
    if (holds(0)) return ParquetType::string;
    return holds(1) ? ParquetType::integer : ParquetType::number;
}

// Writes rows to a file in one format.
struct RowsToFile {
    storage::RowVisitor visitor;
    std::function<void()> end;
};

RowsToFile as_csv_file(AtomicFile& file) {
    return {{[&](const std::vector<std::string>& columns) { file.append(csv_head(columns)); },
             [&](std::vector<storage::QueryValue>& row) {
                 file.append(csv_line(row));
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
                 file.append(row_json(state->columns, row));
                 return true;
             }},
            [state, &file] { file.append(state->empty ? "[]\n" : "\n]\n"); }};
}

RowsToFile as_parquet_file(AtomicFile& file, storage::Database& database, const DocumentedTable& table) {
    std::vector<ParquetColumn> columns;
    for (const auto& column : table.columns)
        columns.push_back({column.name, type_of(database, table, column)});
    const auto writer =
        std::make_shared<ParquetWriter>(columns, [&file](std::string_view bytes) { file.append(bytes); });
    return {{[](const std::vector<std::string>&) {},
             [writer](std::vector<storage::QueryValue>& row) {
                 writer->add(row);
                 return true;
             }},
            [writer] { writer->finish(); }};
}

}  // namespace

std::size_t write_table(storage::Database& database, const DocumentedTable& table,
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
                             table_limits.time_limit_s);
    rows.end();
    file.finish();
    return count;
}

}  // namespace capstan::reports
