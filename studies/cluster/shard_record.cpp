#include "capstan/cluster/shard_record.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "capstan/cluster/lease.h"
#include "capstan/platform/files.h"

namespace capstan::cluster {

namespace fs = std::filesystem;

namespace {

// Enough for a median, however many shards there are.
std::vector<double> some_seconds(const StudyDirectory& directory, const LeaseFolder& leases) {
    constexpr std::size_t enough = 99;
    std::vector<double> seconds;
    for (const int shard : leases.done) {
        if (const auto record = read_shard_record(directory, shard)) seconds.push_back(record->seconds);
        if (seconds.size() == enough) break;
    }
    return seconds;
}

}  // namespace

LeaseFolder look_at_leases(const StudyDirectory& directory) {
    constexpr std::string_view begin = "shard-";
    LeaseFolder folder;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(directory.leases_folder(), none)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(begin)) continue;
        int shard = 0;
        const auto read = std::from_chars(name.data() + begin.size(), name.data() + name.size(), shard);
        const std::string_view ending(read.ptr);
        if (ending == ".done") folder.done.insert(shard);
        if (ending == ".lease") folder.leased.insert(shard);
    }
    return folder;
}

std::optional<ShardRecord> read_shard_record(const StudyDirectory& directory, int shard) {
    const fs::path file = directory.done_file(shard);
    std::error_code none;
    if (!fs::exists(file, none)) return std::nullopt;
    const auto json = nlohmann::json::parse(read_file(file), nullptr, false);
    if (!json.is_object()) return std::nullopt;
    return ShardRecord{json.value("worker", ""), json.value("seconds", 0.0), json.value("file", "")};
}

void write_shard_record(const StudyDirectory& directory, int shard, const ShardRecord& record) {
    const nlohmann::ordered_json json = {
        {"worker", record.worker}, {"seconds", record.seconds}, {"file", record.file}};
    write_file(directory.done_file(shard), json.dump() + "\n");
}

fs::path file_of_shard(const StudyDirectory& directory, int shard) {
    const auto record = read_shard_record(directory, shard);
    if (record && !record->file.empty()) return directory.path / fs::path(record->file).filename();
    return directory.shard_file(shard);
}

bool is_late(const StudyDirectory& directory, int shard, double after_s, double factor) {
    const auto lease = read_lease(directory.lease_file(shard));
    if (!lease) return false;
    const double had_s = disk_time_s(directory.leases_folder()) - lease->begun_s;
    if (had_s < after_s) return false;
    std::vector<double> seconds = some_seconds(directory, look_at_leases(directory));
    if (seconds.empty()) return false;
    std::nth_element(seconds.begin(), seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2),
                     seconds.end());
    return had_s > factor * seconds[seconds.size() / 2];
}

Outlook outlook_of(const StudyDirectory& directory) {
    const LeaseFolder leases = look_at_leases(directory);
    const double now_s = disk_time_s(directory.leases_folder());
    Outlook outlook;
    outlook.done = static_cast<int>(leases.done.size());
    for (const int shard : leases.leased)
        if (is_held(directory.lease_file(shard), now_s)) ++outlook.running;
    const std::vector<double> seconds = some_seconds(directory, leases);
    if (seconds.empty()) return outlook;
    double sum_s = 0.0;
    for (const double s : seconds) sum_s += s;
    outlook.mean_shard_s = sum_s / static_cast<double>(seconds.size());
    const double left_s = outlook.mean_shard_s * (directory.shards - outlook.done);
    outlook.left_core_h = left_s * directory.processors_per_shard / 3600.0;
    outlook.left_s = left_s / std::max(outlook.running, 1);
    return outlook;
}

std::string last_line_of(const fs::path& log) {
    constexpr std::streamoff enough = 4096;  // [bytes] for the last lines
    std::ifstream file(log, std::ios::binary | std::ios::ate);
    if (!file) return {};
    file.seekg(std::max<std::streamoff>(0, static_cast<std::streamoff>(file.tellg()) - enough));
    std::string line, last;
    while (std::getline(file, line))
        if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
    return last;
}

}  // namespace capstan::cluster
