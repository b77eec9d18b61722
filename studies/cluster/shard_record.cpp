#include "capstan/cluster/shard_record.h"

#include <algorithm>
#include <fstream>
#include <vector>

#include "capstan/units/lease.h"

namespace capstan::cluster {

namespace fs = std::filesystem;

fs::path file_of_shard(const StudyDirectory& directory, int shard) {
    units::DiskFolder leases = directory.leases();
    const auto record = units::read_unit_record(leases, shard);
    if (record && !record->file.empty()) return directory.path / fs::path(record->file).filename();
    return directory.shard_file(shard);
}

Outlook outlook_of(const StudyDirectory& directory) {
    units::DiskFolder folder = directory.leases();
    const units::LeaseFolder leases = units::look_at_leases(folder);
    const double now_s = folder.now_s();
    Outlook outlook;
    outlook.done = static_cast<int>(leases.done.size());
    for (const int shard : leases.leased)
        if (units::is_held(folder, units::lease_of(shard), now_s)) ++outlook.running;
    const std::vector<double> seconds = units::some_seconds(folder, leases);
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
