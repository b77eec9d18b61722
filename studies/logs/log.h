#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "capstan/logs/number_series.h"
#include "capstan/logs/text_format.h"

namespace capstan::logs {

/// One column of a table, as the file has it: nothing is converted.
struct LogColumn {
    std::string name;  ///< "Input torque", "position.knee"
    std::string unit;  ///< as the file states it; empty where it does not
    NumberSeries values;
};

/// Columns of the same length: a text file, a sheet, a matrix, the messages of a topic. A cell without a
/// number is NaN. The messages of a topic have their times as columns: `log_time` (s, when the message was
/// recorded) and, where the message has a header, `header.stamp` (s, when it was measured).
struct LogTable {
    std::string name;  ///< the topic, variable or sheet; empty where a file has one table
    std::vector<LogColumn> columns;
    std::size_t rows = 0;

    /// Index in `columns`, or -1.
    int column(std::string_view column_name) const;
    /// A further column, NaN in the rows that are there already.
    LogColumn& add_column(const std::string& column_name, const std::string& unit,
                          const std::shared_ptr<NumberStore>& store);
};

/// What a file holds.
struct Log {
    std::filesystem::path file;
    std::string format;  ///< "delimited text", "MATLAB 7.3", "ROS 1 bag", ...
    TextFormat text;     ///< of delimited text
    std::vector<LogTable> tables;
    /// What was not read, in sentences: a file that is cut short, messages of an unknown type.
    std::vector<std::string> remarks;
    /// What was taken for granted, in sentences: where the seconds of a column of dates begin.
    std::vector<std::string> assumptions;
    std::shared_ptr<NumberStore> store = std::make_shared<NumberStore>();

    /// Index in `tables`, or -1.
    int table(std::string_view table_name) const;
};

struct ReadOptions {
    /// Which columns are kept; empty: all.
    std::function<bool(const std::string& table, const std::string& column)> wanted{};
    /// How delimited text is written; what is not stated is found from the file.
    TextFormat text{};
    /// Called now and then with the fraction of the file that was read.
    std::function<void(double fraction)> on_progress{};
    std::size_t memory_limit_bytes = 64u << 20;  ///< of the numbers; more are kept in a temporary file
};

/// Bounds for files from anywhere; beyond them a file is refused, and the message says which bound.
struct LogLimits {
    static constexpr std::size_t columns = 4096;             ///< of all tables together
    static constexpr std::size_t name_bytes = 1024;          ///< of a column, topic, type
    static constexpr std::size_t line_bytes = 1u << 20;      ///< of a text file
    static constexpr std::size_t message_bytes = 16u << 20;  ///< of a message of a bag
    static constexpr std::size_t chunk_bytes = 64u << 20;    ///< of a compressed chunk, unpacked
    static constexpr std::size_t numbers = 4'000'000'000;    ///< of a file, unpacked
};

/// Reads a log, whatever its format is: the content decides, not the name. Throws InvalidInput that says what
/// is wrong, where, and what to try.
Log read_log(const std::filesystem::path& path, const ReadOptions& options = {});

/// One format: how a file is known and how it is read.
struct LogFormat {
    const char* name;   ///< "MCAP"
    const char* files;  ///< ".mcap"
    /// `head`: the first 4 KiB of the file, or all of a shorter one.
    bool (*is_it)(std::string_view head, const std::filesystem::path& path);
    void (*read)(const std::filesystem::path& path, const ReadOptions& options, Log& log);
};

extern const LogFormat matlab_format;
extern const LogFormat hdf5_format;
extern const LogFormat ros_bag_format;
extern const LogFormat rosbag2_format;
extern const LogFormat mcap_format;
extern const LogFormat xlsx_format;
extern const LogFormat text_format;

/// All formats, in the order in which they are tried; delimited text is the last.
std::span<const LogFormat> log_formats();

}  // namespace capstan::logs
