#include "capstan/recording/centre_line_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/recording/csv_numbers.h"

namespace capstan {

std::vector<std::array<double, 3>> read_points(const std::filesystem::path& path) {
    ProblemList problems;
    const CsvNumbers table = read_csv_numbers(path, problems);
    std::vector<std::array<double, 3>> points(table.rows());
    std::size_t axis = 0;
    for (const std::string name : {"x_m", "y_m", "z_m"}) {
        const auto column = std::find(table.columns.begin(), table.columns.end(), name);
        if (column == table.columns.end()) {
            problems.add(fmt::format("{}:1", path.string()),
                         fmt::format("there is no column '{}'; a centre line has x_m, y_m and z_m", name));
        } else {
            const auto& values = table.values[static_cast<std::size_t>(column - table.columns.begin())];
            for (std::size_t row = 0; row < values.size(); ++row) points[row][axis] = values[row];
        }
        ++axis;
    }
    // Lines are known only where none was left out.
    if (problems.empty())
        for (std::size_t row = 1; row < points.size(); ++row)
            if (points[row] == points[row - 1])
                problems.add(fmt::format("{}:{}", path.string(), CsvNumbers::line_of(row)),
                             "is the same point as on the line before; remove one of them");
    problems.throw_if_any();
    return points;
}

}  // namespace capstan
