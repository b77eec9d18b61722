// What holds for each reader, on small files of every format: the seeds of the fuzz targets.
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "sample_log.h"

namespace capstan::logs {
namespace {

std::vector<std::filesystem::path> sample_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(CAPSTAN_LOG_SEEDS))
        if (entry.is_regular_file() && entry.path().parent_path().filename().string().starts_with("log_"))
            files.push_back(entry.path());
    return files;
}

bool are_same(const NumberSeries& one, const NumberSeries& other) {
    const std::vector<double> first = numbers_of(one), second = numbers_of(other);
    return std::equal(
        first.begin(), first.end(), second.begin(), second.end(),
        [](double left, double right) { return left == right || (std::isnan(left) && std::isnan(right)); });
}

TEST(EveryFormat, IsThere) {
    std::map<std::string, int> formats;
    for (const auto& file : sample_files()) ++formats[read_log(file).format];
    for (const char* format : {"delimited text", "MATLAB 4", "MATLAB 5", "MATLAB 7.3", "HDF5", "ROS 1 bag",
                               "rosbag2", "MCAP", "Excel workbook"})
        EXPECT_GE(formats[format], 1) << format;
}

TEST(EveryFormat, AWantedColumnAloneHasTheSameNumbers) {
    for (const auto& file : sample_files()) {
        const Log all = read_log(file);
        for (const LogTable& table : all.tables) {
            for (const LogColumn& column : table.columns) {
                ReadOptions options;
                options.wanted = [&](const std::string& of, const std::string& name) {
                    return of == table.name && name == column.name;
                };
                const Log one = read_log(file, options);
                std::size_t kept = 0;
                for (const LogTable& other : one.tables) kept += other.columns.size();
                ASSERT_EQ(kept, 1u) << file << " " << table.name << " " << column.name;
                const int index = one.table(table.name);
                ASSERT_GE(index, 0);
                EXPECT_EQ(one.tables[static_cast<std::size_t>(index)].rows, table.rows)
                    << file << " " << column.name;
                EXPECT_TRUE(
                    are_same(one.tables[static_cast<std::size_t>(index)].columns[0].values, column.values))
                    << file << " " << table.name << " " << column.name;
            }
        }
    }
}

TEST(EveryFormat, NumbersOnTheDiskAreThoseInMemory) {
    for (const auto& file : sample_files()) {
        ReadOptions options;
        options.memory_limit_bytes = 0;
        const Log on_disk = read_log(file, options), in_memory = read_log(file);
        ASSERT_EQ(on_disk.tables.size(), in_memory.tables.size());
        EXPECT_EQ(on_disk.remarks, in_memory.remarks);
        for (std::size_t table = 0; table < on_disk.tables.size(); ++table)
            for (std::size_t column = 0; column < on_disk.tables[table].columns.size(); ++column)
                EXPECT_TRUE(are_same(on_disk.tables[table].columns[column].values,
                                     in_memory.tables[table].columns[column].values));
    }
}

}  // namespace
}  // namespace capstan::logs
