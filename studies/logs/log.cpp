#include "capstan/logs/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>

#include "capstan/cable/invalid_input.h"

namespace capstan::logs {

namespace {

constexpr std::size_t head_bytes = 4096;

std::string head_of(const std::filesystem::path& path) {
    if (std::filesystem::is_directory(path))
        throw InvalidInput({fmt::format("{}: is a folder; name the log inside it", path.string())});
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw InvalidInput({fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))});
    std::string head(head_bytes, '\0');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    if (head.empty()) throw InvalidInput({fmt::format("{}: the file is empty", path.string())});
    return head;
}

/// Files that are often at hand and cannot be read, by how they begin.
struct OtherFormat {
    std::string_view beginning;
    const char* what;
};
constexpr OtherFormat other_formats[] = {
    {"\x28\xb5\x2f\xfd", "is packed with zstd, as rosbag2 does it; unpack it with 'zstd -d'"},
    {"\xfd"
     "7zXZ",
     "is packed with xz; unpack it with 'xz -d'"},
    {"BZh", "is packed with bzip2; unpack it with 'bzip2 -d'"},
    {"\x04\x22\x4d\x18", "is packed with lz4; unpack it with 'lz4 -d'"},
    {"\x1f\x8b", "is packed with gzip, and what is in it is not text; unpack it with 'gzip -d'"},
    {"\xd0\xcf\x11\xe0", "is a workbook of an old Excel (.xls); save the sheet as CSV"},
    {"PAR1", "is a Parquet file; write it as CSV or HDF5, for example with pandas"},
    {"TDSm", "is a TDMS file of LabVIEW; export it as CSV"},
    {"MDF ", "is an MDF file; export it as CSV, HDF5 or MATLAB"},
};

std::string formats_in_words() {
    std::string words;
    for (const LogFormat& format : log_formats())
        words += fmt::format("{}{} ({})", words.empty() ? "" : ", ", format.name, format.files);
    return words;
}

}  // namespace

std::span<const LogFormat> log_formats() {
    static const std::array formats{matlab_format,  hdf5_format, ros_bag_format, mcap_format,
                                    rosbag2_format, xlsx_format, text_format};
    return formats;
}

Log read_log(const std::filesystem::path& path, const ReadOptions& options) {
    const std::string head = head_of(path);
    for (const LogFormat& format : log_formats()) {
        if (!format.is_it(head, path)) continue;
        Log log;
        log.file = path;
        log.format = format.name;
        log.store = std::make_shared<NumberStore>(options.memory_limit_bytes);
        format.read(path, options, log);
        return log;
    }
    for (const OtherFormat& other : other_formats)
        if (head.starts_with(other.beginning))
            throw InvalidInput({fmt::format("{}: {}", path.string(), other.what)});
    throw InvalidInput(
        {fmt::format("{}: is in none of the formats that can be read: {}. Save it as one of them",
                     path.string(), formats_in_words())});
}

int LogTable::column(std::string_view column_name) const {
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [&](const LogColumn& column) { return column.name == column_name; });
    return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

LogColumn& LogTable::add_column(const std::string& column_name, const std::string& unit,
                                const std::shared_ptr<NumberStore>& store) {
    LogColumn& column = columns.emplace_back(LogColumn{column_name, unit, NumberSeries(store)});
    for (std::size_t row = 0; row < rows; ++row)
        column.values.append(std::numeric_limits<double>::quiet_NaN());
    return column;
}

int Log::table(std::string_view table_name) const {
    const auto found = std::find_if(tables.begin(), tables.end(),
                                    [&](const LogTable& table) { return table.name == table_name; });
    return found == tables.end() ? -1 : static_cast<int>(found - tables.begin());
}

}  // namespace capstan::logs
