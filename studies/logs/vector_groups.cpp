#include "capstan/logs/vector_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "capstan/logs/text_lines.h"

namespace capstan::logs {

namespace {

constexpr std::size_t widest_matrix = 64;

struct Shape {
    std::size_t length = 0;
    std::size_t width = 1;
    bool is_transposed = false;
};

Shape shape_of(const NamedMatrix& matrix) {
    if (matrix.rows == 1 || (matrix.columns > widest_matrix && matrix.rows <= widest_matrix))
        return {matrix.columns, matrix.rows, true};
    return {matrix.rows, matrix.columns, false};
}

std::string column_name(const NamedMatrix& matrix, const Shape& shape, std::size_t column) {
    if (shape.width == 1) return as_utf8(matrix.name);
    return as_utf8(matrix.name) +
           (shape.is_transposed ? fmt::format("({},:)", column + 1) : fmt::format("(:,{})", column + 1));
}

void write_matrix(const NamedMatrix& matrix, int table, TableWriter& writer) {
    const Shape shape = shape_of(matrix);
    std::vector<int> columns;
    for (std::size_t column = 0; column < shape.width; ++column)
        columns.push_back(writer.add_column(table, column_name(matrix, shape, column), as_utf8(matrix.unit)));
    if (std::all_of(columns.begin(), columns.end(), [](int column) { return column < 0; })) return;
    // Numbers come column after column, or one of each column in turn.
    const bool in_turn = matrix.is_by_rows != shape.is_transposed && shape.width > 1;
    std::size_t at = 0;
    const auto take = [&](std::span<const double> numbers) {
        for (std::size_t k = 0; k < numbers.size();) {
            const std::size_t column = in_turn ? at % shape.width : at / shape.length;
            const std::size_t count =
                in_turn ? 1 : std::min(numbers.size() - k, shape.length - at % shape.length);
            if (column < columns.size() && columns[column] >= 0)
                writer.fill_column(table, columns[column], numbers.subspan(k, count));
            k += count;
            at += count;
        }
    };
    matrix.read(take);
    const std::size_t all = shape.length * shape.width;
    if (at >= all) return;
    writer.remark(
        fmt::format("'{}' is damaged or cut: {} of its {} numbers are read", as_utf8(matrix.name), at, all));
    const std::vector<double> missing(NumberStore::block_numbers, std::numeric_limits<double>::quiet_NaN());
    while (at < all) take(std::span(missing).first(std::min(missing.size(), all - at)));
}

}  // namespace

void write_groups(const std::vector<NamedMatrix>& matrices, TableWriter& writer) {
    std::vector<std::string> homes;  // in the file's order
    std::map<std::string, std::map<std::size_t, std::vector<const NamedMatrix*>, std::greater<>>> by_home;
    for (const NamedMatrix& matrix : matrices) {
        if (matrix.rows == 0 || matrix.columns == 0) continue;
        auto& by_length = by_home[matrix.home];
        if (by_length.empty()) homes.push_back(matrix.home);
        by_length[shape_of(matrix).length].push_back(&matrix);
    }
    for (const std::string& home : homes) {
        bool is_longest = true;
        for (const auto& [length, group] : by_home[home]) {
            const std::string first = column_name(*group.front(), shape_of(*group.front()), 0);
            const std::string own_name = is_longest ? home : home.empty() ? first : home + "/" + first;
            is_longest = false;
            const int table = writer.add_table(as_utf8(own_name));
            for (const NamedMatrix* matrix : group) write_matrix(*matrix, table, writer);
            writer.set_rows(table, length);
        }
    }
}

}  // namespace capstan::logs
