#include "capstan/storage/statement.h"

#include <bit>

#include "capstan/storage/error.h"

namespace capstan::storage {

Statement::Statement(Database& database, std::string_view sql) {
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v2(database.connection(), sql.data(), static_cast<int>(sql.size()),
                                        &statement, nullptr);
    statement_.reset(statement);
    if (code != SQLITE_OK) throw_sqlite_error(database.connection(), "prepare a statement");
}

void Statement::require(int code, std::string_view doing) const {
    if (code != SQLITE_OK) throw_sqlite_error(sqlite3_db_handle(statement_.get()), doing);
}

void Statement::bind(int position, std::nullptr_t) {
    require(sqlite3_bind_null(statement_.get(), position), "bind nothing");
}

void Statement::bind(int position, int value) {
    require(sqlite3_bind_int(statement_.get(), position, value), "bind a number");
}

void Statement::bind(int position, std::int64_t value) {
    require(sqlite3_bind_int64(statement_.get(), position, value), "bind a number");
}

void Statement::bind(int position, std::uint64_t value) {
    bind(position, std::bit_cast<std::int64_t>(value));
}

void Statement::bind(int position, double value) {
    require(sqlite3_bind_double(statement_.get(), position, value), "bind a number");
}

void Statement::bind(int position, std::string_view value) {
    // data() of an empty view may be null, which SQLite would store as NULL.
    const char* text = value.empty() ? "" : value.data();
    require(
        sqlite3_bind_text64(statement_.get(), position, text, value.size(), SQLITE_TRANSIENT, SQLITE_UTF8),
        "bind a text");
}

void Statement::bind(int position, const std::optional<double>& value) {
    if (value) {
        bind(position, *value);
    } else {
        bind(position, nullptr);
    }
}

bool Statement::step(std::string_view doing) {
    const int code = sqlite3_step(statement_.get());
    if (code == SQLITE_ROW) return true;
    if (code == SQLITE_DONE) return false;
    throw_sqlite_error(sqlite3_db_handle(statement_.get()), doing);
}

void Statement::run(std::string_view doing) {
    while (step(doing)) {
    }
    reset();
}

template <>
int Statement::get<int>(int column) const {
    return sqlite3_column_int(statement_.get(), column);
}

template <>
std::int64_t Statement::get<std::int64_t>(int column) const {
    return sqlite3_column_int64(statement_.get(), column);
}

template <>
std::uint64_t Statement::get<std::uint64_t>(int column) const {
    return std::bit_cast<std::uint64_t>(get<std::int64_t>(column));
}

template <>
double Statement::get<double>(int column) const {
    return sqlite3_column_double(statement_.get(), column);
}

template <>
std::string Statement::get<std::string>(int column) const {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
    return text ? std::string(text, size) : std::string();
}

template <>
std::optional<double> Statement::get<std::optional<double>>(int column) const {
    if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return std::nullopt;
    return get<double>(column);
}

}  // namespace capstan::storage
