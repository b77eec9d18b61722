#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capstan/recording/problem_list.h"

namespace capstan {

/// A CSV file of numbers under one head line.
struct CsvNumbers {
    std::vector<std::string> columns;
    std::vector<std::vector<double>> values;  // columns x rows

    std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
    /// Line of the file that a row came from, for messages.
    static std::size_t line_of(std::size_t row) { return row + 2; }
};

/// Reads such a file; what is wrong with a line goes into `problems` with the line's number, and the line is
/// left out. Throws InvalidInput if the file cannot be read at all.
CsvNumbers read_csv_numbers(const std::filesystem::path& path, ProblemList& problems);

/// The complete text of a file. Throws InvalidInput if it cannot be read.
std::string file_text(const std::filesystem::path& path);

}  // namespace capstan
