#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/log.h"

namespace capstan::logs {

/// A file of these bytes in the test's folder.
inline std::filesystem::path log_file(const std::string& name, const std::string& bytes) {
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / ("capstan_log_" + name);
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
    return path;
}

inline Log log_of(const std::string& bytes, const ReadOptions& options = {}) {
    return read_log(log_file(testing::UnitTest::GetInstance()->current_test_info()->name(), bytes), options);
}

inline std::vector<std::string> column_names(const LogTable& table) {
    std::vector<std::string> names;
    for (const LogColumn& column : table.columns) names.push_back(column.name);
    return names;
}

inline std::vector<double> numbers_in(const LogTable& table, const std::string& column) {
    const int index = table.column(column);
    EXPECT_GE(index, 0) << column;
    return index < 0 ? std::vector<double>()
                     : numbers_of(table.columns[static_cast<std::size_t>(index)].values);
}

/// What read_log says of these bytes; empty if it takes them.
inline std::string refusal_of(const std::string& bytes, const ReadOptions& options = {}) {
    try {
        log_of(bytes, options);
    } catch (const InvalidInput& refusal) {
        return refusal.what();
    }
    return "";
}

inline std::string remarks_of(const Log& log) {
    std::string all;
    for (const std::string& remark : log.remarks) all += remark + "\n";
    return all;
}

}  // namespace capstan::logs
