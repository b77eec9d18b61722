#pragma once
// The query box: anyone's SQL, which may read everything and change nothing.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/storage/error.h"
#include "capstan/storage/schema.h"

namespace capstan::storage {

using QueryValue = std::variant<std::monostate, std::int64_t, double, std::string>;  // nothing: NULL

struct QueryLimits {
    double time_limit_s = 10;  // longer than any view takes on a study; a cross join by mistake ends
    std::optional<std::size_t> row_limit{};  // rows beyond, or beyond 8 MB, are cut off: see truncated
};

// A query that was stopped at its time limit.
class QueryTooSlow : public Error {
  public:
    using Error::Error;
};

// A query that was stopped at its memory limit.
class QueryTooLarge : public Error {
  public:
    using Error::Error;
};

struct QueryResult {
    std::vector<std::string> columns;
    std::vector<std::vector<QueryValue>> rows;  // rows x columns
    bool truncated = false;
};

// Runs exactly one SELECT on a database that was opened with open_read_only. ?1, ?2, ... take the parameters.
// It sees nothing of studies in the trash. A blob comes out as a text of its bytes; no table of ours has one.
QueryResult run_read_only(Database& database, std::string_view sql,
                          const std::vector<QueryValue>& parameters = {}, const QueryLimits& limits = {});

// For a program that runs a guest's query and nothing else: what SQLite allocates is limited. A query that
// needs more ends with an Error.
void limit_query_memory(std::int64_t bytes);

// For an answer that is larger than memory: its rows one by one.
struct RowVisitor {
    std::function<void(const std::vector<std::string>& columns)> begin;
    std::function<bool(std::vector<QueryValue>& row)> visit;  // false: that is enough
};

// As run_read_only, without keeping the rows.
void visit_read_only(Database& database, std::string_view sql, const RowVisitor& visitor,
                     const std::vector<QueryValue>& parameters = {}, double time_limit_s = 10);

}  // namespace capstan::storage
