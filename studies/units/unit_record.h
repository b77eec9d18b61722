#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "capstan/units/shared_folder.h"

namespace capstan::units {

// The names of the files in the folder of leases; units have the numbers 1, 2, ...
inline std::string unit_file(int unit, const std::string& ending) {
    return "shard-" + std::to_string(unit) + ending;
}
inline std::string lease_of(int unit) {
    return unit_file(unit, ".lease");
}
inline std::string second_lease_of(int unit) {
    return unit_file(unit, ".second");
}
inline std::string standby_of(int unit) {
    return unit_file(unit, ".standby");
}
inline std::string done_file_of(int unit) {
    return unit_file(unit, ".done");
}
inline const std::string merge_lease = "merge.lease";

/// What a worker leaves when it has done a unit: shard-3.done.
struct UnitRecord {
    std::string worker;           ///< host and process
    double seconds = 0.0;         ///< wall time
    std::string file;             ///< with its results
    std::string sha256{};         ///< of that file; empty: the file holds its own hashes and the next too
    std::string computed_with{};  ///< SIMD width, compiler and version of the program
};

/// Nothing: the unit is not done, or its record is damaged, which is the same.
std::optional<UnitRecord> read_unit_record(SharedFolder& folder, int unit);
void write_unit_record(SharedFolder& folder, int unit, const UnitRecord& record);

/// What is in the folder, by unit, with one look.
struct LeaseFolder {
    std::set<int> done;
    std::set<int> leased;  ///< by a worker that lives or died
};
LeaseFolder look_at_leases(SharedFolder& folder);

/// Wall times of the first 99 units that are done.
std::vector<double> some_seconds(SharedFolder& folder, const LeaseFolder& leases);

/// Whether a worker has had the unit for longer than `after_s` and than `factor` times the median of
/// some_seconds(); never while no unit is done.
bool is_late(SharedFolder& folder, int unit, double after_s, double factor);

/// SHA-256 (FIPS 180-4) as 64 hexadecimal digits.
std::string sha256_of(const std::string& bytes);

}  // namespace capstan::units
