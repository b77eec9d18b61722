#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capstan/logs/table_writer.h"

namespace capstan::logs {

/// A matrix of a file that has variables rather than tables.
struct NamedMatrix {
    std::string home;  ///< the struct or folder it is in; empty at the top
    std::string name;
    std::string unit;
    std::size_t rows = 0;
    std::size_t columns = 1;
    bool is_by_rows = false;  ///< the order in which `read` hands the numbers over: row after row, or columns
    /// Hands the numbers over in pieces of any length; those that did not come are missing, and a remark
    /// says so.
    std::function<void(const std::function<void(std::span<const double>)>& take)> read{};
};

/// Makes tables of matrices: those of one home with the same length become one table. The longest table of a
/// home has its name, another one "home/first column". A matrix has the columns "name(:,1)", "name(:,2)"; one
/// that is much wider than long is read as its transpose, "name(1,:)".
void write_groups(const std::vector<NamedMatrix>& matrices, TableWriter& writer);

}  // namespace capstan::logs
