#include "capstan/storage/read_only_query.h"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "capstan/storage/error.h"
#include "capstan/storage/statement.h"

namespace capstan::storage {

namespace {

// What a guest's statement may do while it is prepared and run: read, for a while.
class QueryGuard {
  public:
    QueryGuard(sqlite3* connection, double time_limit_s);
    ~QueryGuard();
    QueryGuard(const QueryGuard&) = delete;
    QueryGuard& operator=(const QueryGuard&) = delete;

    bool time_is_up() const { return time_is_up_; }

  private:
    static int stop_when_late(void* guard);

    sqlite3* connection_;
    std::chrono::steady_clock::time_point deadline_;  // the only clock of this room; nothing of it is stored
    bool time_is_up_ = false;
};

constexpr int steps_between_looks = 1000;  // of SQLite's machine: far below a millisecond

// They reach outside the database, or load code, in some builds of SQLite.
constexpr std::array<std::string_view, 6> refused_functions{"load_extension", "readfile", "writefile",
                                                            "edit",           "eval",     "fts3_tokenizer"};

// They describe the schema; all of them only read.
constexpr std::array<std::string_view, 8> allowed_pragmas{"table_info",       "table_xinfo",  "table_list",
                                                          "index_list",       "index_info",   "index_xinfo",
                                                          "foreign_key_list", "database_list"};

template <std::size_t Count>
bool contains(const std::array<std::string_view, Count>& names, const char* name) {
    if (name == nullptr) return false;
    return std::any_of(names.begin(), names.end(),
                       [name](std::string_view other) { return sqlite3_stricmp(other.data(), name) == 0; });
}

// SQLite asks about every single thing a statement wants to do. Writing, ATTACH and all else is denied by not
// being on the list.
int judge(void*, int action, const char* first, const char* second, const char*, const char*) {
    switch (action) {
        case SQLITE_SELECT:
        case SQLITE_READ:
        case SQLITE_RECURSIVE:
            return SQLITE_OK;
        case SQLITE_FUNCTION:
            return contains(refused_functions, second) ? SQLITE_DENY : SQLITE_OK;
        case SQLITE_PRAGMA:
            return contains(allowed_pragmas, first) ? SQLITE_OK : SQLITE_DENY;
        case SQLITE_UPDATE:
            // json_each and pragma_table_info ask this when they declare their columns, and do not do it. A
            // guest's own UPDATE of the schema is refused by SQLite itself (defensive, read-only).
            return std::string_view(first) == "sqlite_master" ? SQLITE_OK : SQLITE_DENY;
        default:
            return SQLITE_DENY;
    }
}

QueryGuard::QueryGuard(sqlite3* connection, double time_limit_s)
    : connection_(connection),
      deadline_(std::chrono::steady_clock::now() +
                std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                    std::chrono::duration<double>(time_limit_s))) {
    sqlite3_db_config(connection_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_set_authorizer(connection_, judge, nullptr);
    sqlite3_progress_handler(connection_, steps_between_looks, stop_when_late, this);
}

QueryGuard::~QueryGuard() {
    sqlite3_progress_handler(connection_, 0, nullptr, nullptr);
    sqlite3_set_authorizer(connection_, nullptr, nullptr);
}

int QueryGuard::stop_when_late(void* guard) {
    auto* self = static_cast<QueryGuard*>(guard);
    self->time_is_up_ = std::chrono::steady_clock::now() > self->deadline_;
    return self->time_is_up_ ? 1 : 0;
}

// Nothing stored is a hundredth as long. The time limit is looked at between steps of SQLite's machine, and a
// single step on long texts, instr() for one, takes the product of their lengths.
constexpr int longest_value_bytes = 1'000'000;

// Of an answer whose rows are limited: few rows may hold much.
constexpr std::size_t max_bytes = 8 << 20;

// SQL, patterns and compiled programs beyond these are no question about a study: a statement of a few lines
// can otherwise be compiled for minutes, and a pattern be compared for hours.
constexpr int longest_sql_bytes = 100'000;
constexpr int longest_pattern_bytes = 500;
constexpr int longest_program = 1'000'000;  // instructions; the longest view has some thousands

void limit_statement(sqlite3* connection) {
    sqlite3_limit(connection, SQLITE_LIMIT_ATTACHED, 0);
    sqlite3_limit(connection, SQLITE_LIMIT_LENGTH, longest_value_bytes);
    sqlite3_limit(connection, SQLITE_LIMIT_SQL_LENGTH, longest_sql_bytes);
    sqlite3_limit(connection, SQLITE_LIMIT_LIKE_PATTERN_LENGTH, longest_pattern_bytes);
    sqlite3_limit(connection, SQLITE_LIMIT_VDBE_OP, longest_program);
}

struct Finalizer {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using GuestStatement = std::unique_ptr<sqlite3_stmt, Finalizer>;

[[noreturn]] void explain(sqlite3* connection, const QueryGuard& guard, double time_limit_s) {
    const std::string message = sqlite3_errmsg(connection);
    if (guard.time_is_up()) {
        std::string seconds = std::to_string(time_limit_s);
        seconds.erase(seconds.find_last_not_of('0') + 1);
        if (seconds.back() == '.') seconds.pop_back();
        throw QueryTooSlow("The query took longer than " + seconds +
                           " s and was stopped. Narrow it with WHERE, or check its joins.");
    }
    if (sqlite3_errcode(connection) == SQLITE_AUTH || message.find("not authorized") != std::string::npos ||
        message.find("prohibited") != std::string::npos ||
        message.find("may not be modified") != std::string::npos) {
        throw Error(
            "The query may only read: one SELECT (or WITH ... SELECT), nothing that writes, attaches or "
            "sets. (SQLite: " +
            message + ")");
    }
    if ((sqlite3_errcode(connection) & 0xff) == SQLITE_NOMEM)
        throw QueryTooLarge("The query needs more memory than a query may have. Narrow it with WHERE.");
    std::string hint;
    if (message.find("no such table") != std::string::npos ||
        message.find("no such column") != std::string::npos) {
        hint = ". `capstan query --schema` shows the tables and columns";
    }
    throw Error("The query does not work: " + message + hint + ".");
}

bool only_blanks_follow(sqlite3* connection, const char* tail, const char* end) {
    while (tail != end) {
        sqlite3_stmt* statement = nullptr;
        const char* next = nullptr;
        const int code =
            sqlite3_prepare_v2(connection, tail, static_cast<int>(end - tail), &statement, &next);
        const GuestStatement owner(statement);
        if (code != SQLITE_OK || statement != nullptr) return false;
        if (next == tail) break;
        tail = next;
    }
    return true;
}

void bind(sqlite3_stmt* statement, int position, const QueryValue& value) {
    if (const auto* integer = std::get_if<std::int64_t>(&value)) {
        sqlite3_bind_int64(statement, position, *integer);
    } else if (const auto* real = std::get_if<double>(&value)) {
        sqlite3_bind_double(statement, position, *real);
    } else if (const auto* text = std::get_if<std::string>(&value)) {
        sqlite3_bind_text64(statement, position, text->c_str(), text->size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    }
}

QueryValue value_at(sqlite3_stmt* statement, int column) {
    switch (sqlite3_column_type(statement, column)) {
        case SQLITE_NULL:
            return std::monostate{};
        case SQLITE_INTEGER:
            return std::int64_t{sqlite3_column_int64(statement, column)};
        case SQLITE_FLOAT:
            return sqlite3_column_double(statement, column);
        default: {  // text and blob: both are bytes
            const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, column));
            const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, column));
            return bytes ? std::string(bytes, size) : std::string();
        }
    }
}

std::size_t bytes_of(const std::vector<QueryValue>& row) {
    std::size_t bytes = sizeof(std::vector<QueryValue>) + row.size() * sizeof(QueryValue);
    for (const QueryValue& value : row) {
        if (const auto* text = std::get_if<std::string>(&value)) bytes += text->size();
    }
    return bytes;
}

// Prepares the one statement that the text holds.
GuestStatement prepare(sqlite3* connection, std::string_view sql, const QueryGuard& guard,
                       double time_limit_s) {
    const char* const end = sql.data() + sql.size();
    sqlite3_stmt* raw = nullptr;
    const char* tail = end;
    const int code = sqlite3_prepare_v2(connection, sql.data(), static_cast<int>(sql.size()), &raw, &tail);
    GuestStatement statement(raw);
    if (code != SQLITE_OK) explain(connection, guard, time_limit_s);
    if (!statement)
        throw Error("The query is empty. Write one SELECT; `capstan query --schema` shows the tables.");
    if (!only_blanks_follow(connection, tail, end)) {
        throw Error("The query holds more than one statement. Run them one after the other.");
    }
    if (sqlite3_stmt_readonly(statement.get()) == 0) throw Error("The query may only read.");
    return statement;
}

void bind_all(sqlite3_stmt* statement, const std::vector<QueryValue>& parameters) {
    const int wanted = sqlite3_bind_parameter_count(statement);
    if (static_cast<std::size_t>(wanted) != parameters.size()) {
        throw Error("The query has " + std::to_string(wanted) + " parameters, but " +
                    std::to_string(parameters.size()) + " values were given.");
    }
    for (int i = 0; i < wanted; ++i) bind(statement, i + 1, parameters[static_cast<std::size_t>(i)]);
}

constexpr std::string_view shown_studies =
    "study_id NOT IN (SELECT study_id FROM main.study_mark WHERE is_deleted = 1)";

// How the row of a table that has such a column finds its study.
constexpr std::pair<std::string_view, std::string_view> parents[] = {
    {"scenario_id", "scenario"}, {"recommendation_id", "recommendation"}, {"cell_id", "cell"}};

bool has_column(Database& database, const std::string& table, std::string_view column) {
    Statement select(database, "SELECT count(*) FROM pragma_table_info(?1) WHERE name = ?2");
    select.bind_all(std::string_view(table), column);
    return select.step() && select.get<int>(0) > 0;
}

// Nothing: the table holds no study's rows.
std::optional<std::string> shown_rows(Database& database, const std::string& table) {
    if (has_column(database, table, "study_id")) return std::string(shown_studies);
    for (const auto& [column, parent] : parents) {
        if (!has_column(database, table, column) || table == parent) continue;
        const auto of_parent = shown_rows(database, std::string(parent));
        return std::string(column) + " IN (SELECT " + std::string(column) + " FROM main." +
               std::string(parent) + " WHERE " + of_parent.value() + ")";
    }
    return std::nullopt;
}

struct Named {
    std::string type;
    std::string name;
    std::string sql;
};

std::vector<Named> tables_and_views(Database& database) {
    std::vector<Named> found;
    Statement select(
        database,
        "SELECT type, name, sql FROM main.sqlite_schema WHERE type IN ('table', 'view') AND name NOT "
        "LIKE 'sqlite\\_%' ESCAPE '\\' ORDER BY rowid");
    while (select.step())
        found.push_back({select.get<std::string>(0), select.get<std::string>(1), select.get<std::string>(2)});
    return found;
}

// From then on every table and view of this connection is without the rows of studies in the trash, for
// whoever names it without a schema; only the connection changes. Views of the connection's own schema come
// before the file's tables and views. A view of the file sees the file's tables only, so each is made again
// beside them.
void hide_trash(Database& database) {
    Statement any(database, "SELECT count(*) FROM study_mark WHERE is_deleted = 1");
    if (!any.step() || any.get<int>(0) == 0) return;
    constexpr std::string_view of_file = "CREATE VIEW ";
    const std::string made_beside = "CREATE TEMP VIEW IF NOT EXISTS ";
    for (const Named& each : tables_and_views(database)) {
        if (each.type == "view") {
            database.execute(made_beside + each.sql.substr(of_file.size()), "hide the trash");
        } else if (const auto shown = shown_rows(database, each.name)) {
            database.execute(
                made_beside + each.name + " AS SELECT * FROM main." + each.name + " WHERE " + *shown,
                "hide the trash");
        }
    }
}

}  // namespace

void limit_query_memory(std::int64_t bytes) {
    sqlite3_hard_heap_limit64(bytes);
}

void visit_read_only(Database& database, std::string_view sql, const RowVisitor& visitor,
                     const std::vector<QueryValue>& parameters, double time_limit_s) {
    sqlite3* const connection = database.connection();
    if (!database.is_read_only()) {
        throw Error("The query box needs a database that was opened for reading only: " +
                    database.path().string());
    }
    hide_trash(database);
    limit_statement(connection);
    const QueryGuard guard(connection, time_limit_s);
    const GuestStatement statement = prepare(connection, sql, guard, time_limit_s);
    bind_all(statement.get(), parameters);

    std::vector<std::string> names;
    const int columns = sqlite3_column_count(statement.get());
    for (int i = 0; i < columns; ++i) names.emplace_back(sqlite3_column_name(statement.get(), i));
    visitor.begin(names);
    std::vector<QueryValue> row;
    int code = SQLITE_DONE;
    while ((code = sqlite3_step(statement.get())) == SQLITE_ROW) {
        row.clear();
        row.reserve(static_cast<std::size_t>(columns));
        for (int i = 0; i < columns; ++i) row.push_back(value_at(statement.get(), i));
        if (!visitor.visit(row)) return;
    }
    if (code != SQLITE_DONE) explain(connection, guard, time_limit_s);
}

QueryResult run_read_only(Database& database, std::string_view sql, const std::vector<QueryValue>& parameters,
                          const QueryLimits& limits) {
    QueryResult result;
    std::size_t bytes = 0;
    const auto keep = [&](std::vector<QueryValue>& row) {
        result.truncated =
            limits.row_limit && (result.rows.size() == *limits.row_limit || bytes >= max_bytes);
        if (result.truncated) return false;
        bytes += bytes_of(row);
        result.rows.push_back(std::move(row));
        return true;
    };
    visit_read_only(database, sql,
                    {[&](const std::vector<std::string>& columns) { result.columns = columns; }, keep},
                    parameters, limits.time_limit_s);
    return result;
}

}  // namespace capstan::storage
