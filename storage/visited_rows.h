#pragma once
// An answer of the query box row by row: for those that are larger than memory.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/storage/read_only_query.h"

namespace capstan::storage {

struct RowVisitor {
    std::function<void(const std::vector<std::string>& columns)> begin;
    std::function<bool(std::vector<QueryValue>& row)> visit;  // false: that is enough
};

// As run_read_only, without keeping the rows.
void visit_read_only(Database& database, std::string_view sql, const RowVisitor& visitor,
                     const std::vector<QueryValue>& parameters = {}, double time_limit_s = 10);

}  // namespace capstan::storage
