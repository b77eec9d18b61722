#include "capstan/units/unit_record.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "capstan/units/lease.h"

namespace capstan::units {

namespace {

// A record with a flipped bit would name another file or program; so it has its own hash.
std::string with_check(nlohmann::ordered_json json) {
    json["check"] = sha256_of(json.dump());
    return json.dump() + "\n";
}

}  // namespace

std::optional<UnitRecord> read_unit_record(SharedFolder& folder, int unit) {
    const auto text = folder.read(done_file_of(unit));
    if (!text) return std::nullopt;
    auto json = nlohmann::ordered_json::parse(*text, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    json.erase("check");
    try {
        if (with_check(json) != *text) return std::nullopt;
        return UnitRecord{json.at("worker"), json.at("seconds"), json.at("file"), json.value("sha256", ""),
                          json.value("computed_with", "")};
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
}

void write_unit_record(SharedFolder& folder, int unit, const UnitRecord& record) {
    nlohmann::ordered_json json = {
        {"worker", record.worker}, {"seconds", record.seconds}, {"file", record.file}};
    if (!record.sha256.empty()) json["sha256"] = record.sha256;
    if (!record.computed_with.empty()) json["computed_with"] = record.computed_with;
    folder.replace(done_file_of(unit), with_check(std::move(json)));
}

LeaseFolder look_at_leases(SharedFolder& folder) {
    constexpr std::string_view begin = "shard-";
    LeaseFolder found;
    for (const std::string& name : folder.names()) {
        if (!name.starts_with(begin)) continue;
        int unit = 0;
        const auto read = std::from_chars(name.data() + begin.size(), name.data() + name.size(), unit);
        const std::string_view ending(read.ptr);
        if (ending == ".done") found.done.insert(unit);
        if (ending == ".lease") found.leased.insert(unit);
    }
    return found;
}

std::vector<double> some_seconds(SharedFolder& folder, const LeaseFolder& leases) {
    constexpr std::size_t enough = 99;  // for a median, however many units there are
    std::vector<double> seconds;
    for (const int unit : leases.done) {
        if (const auto record = read_unit_record(folder, unit)) seconds.push_back(record->seconds);
        if (seconds.size() == enough) break;
    }
    return seconds;
}

bool is_late(SharedFolder& folder, int unit, double after_s, double factor) {
    const auto lease = read_lease(folder, lease_of(unit));
    if (!lease) return false;
    const double had_s = folder.now_s() - lease->begun_s;
    if (had_s < after_s) return false;
    std::vector<double> seconds = some_seconds(folder, look_at_leases(folder));
    if (seconds.empty()) return false;
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    return had_s > factor * *middle;
}

std::string sha256_of(const std::string& bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
        throw std::runtime_error("libcrypto does not provide SHA-256. Is it installed completely?");
    constexpr const char* digits = "0123456789abcdef";
    std::string text;
    for (unsigned k = 0; k < size; ++k) text += {digits[digest[k] >> 4], digits[digest[k] & 15]};
    return text;
}

}  // namespace capstan::units
