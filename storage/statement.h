#pragma once
// A prepared statement: values go in by position from 1, come out by column from 0, as SQLite counts them.

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "capstan/storage/database.h"

namespace capstan::storage {

class Statement {
  public:
    Statement(Database& database, std::string_view sql);

    void bind(int position, std::nullptr_t);
    void bind(int position, int value);
    void bind(int position, std::int64_t value);
    void bind(int position, std::uint64_t value);  // stored as the signed number with the same bits
    void bind(int position, double value);         // not a number is stored as NULL, which NOT NULL refuses
    void bind(int position, std::string_view value);
    void bind(int position, const std::optional<double>& value);

    // Binds the values to positions 1, 2, ...
    template <class... Values>
    void bind_all(const Values&... values) {
        int position = 0;
        (bind(++position, values), ...);
    }

    bool step(std::string_view doing = "read");  // true: there is a row
    void run(std::string_view doing);  // for statements without rows; ready to be bound again afterwards
    void reset() { sqlite3_reset(statement_.get()); }

    template <class Value>
    Value get(int column) const;

    sqlite3_stmt* handle() const { return statement_.get(); }

  private:
    struct Finalizer {
        void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    };

    void require(int code, std::string_view doing) const;

    std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
};

template <>
int Statement::get<int>(int column) const;
template <>
std::int64_t Statement::get<std::int64_t>(int column) const;
template <>
std::uint64_t Statement::get<std::uint64_t>(int column) const;
template <>
double Statement::get<double>(int column) const;
template <>
std::string Statement::get<std::string>(int column) const;
template <>
std::optional<double> Statement::get<std::optional<double>>(int column) const;

}  // namespace capstan::storage
