#include "capstan/storage/integrity/world_hash.h"

#include <charconv>

#include "capstan/storage/integrity/hashed_rows.h"

namespace capstan::storage {
namespace {

unsigned byte_at(const std::string& hexadecimal, std::size_t byte) {
    unsigned value = 0;
    const char* const begin = hexadecimal.data() + 2 * byte;
    std::from_chars(begin, begin + 2, value, 16);
    return value;
}

// The first byte is the lowest.
void add_to(Sha256& sum, const Sha256& digest) {
    unsigned carry = 0;
    for (std::size_t k = 0; k < sum.size(); ++k) {
        carry += static_cast<unsigned>(sum[k]) + digest[k];
        sum[k] = static_cast<unsigned char>(carry & 0xff);
        carry >>= 8;
    }
}

}  // namespace

std::string world_part(const std::string& condition) {
    return "worlds " + condition;
}

std::string sum_of(const std::string& hexadecimal_sum, const Sha256& digest) {
    Sha256 sum{};
    for (std::size_t k = 0; k < sum.size() && 2 * k + 1 < hexadecimal_sum.size(); ++k)
        sum[k] = static_cast<unsigned char>(byte_at(hexadecimal_sum, k));
    add_to(sum, digest);
    return hexadecimal(sum);
}

std::map<std::pair<std::string, int>, std::string> world_sums(Database& database, std::int64_t study_id) {
    const HashedColumns columns = hashed_columns("world_error", {});
    Statement select(
        database, "SELECT " + columns.selected() + ", condition, world FROM world_error WHERE study_id = ?1");
    select.bind(1, study_id);
    const int extra = static_cast<int>(columns.names.size());
    std::map<std::pair<std::string, int>, Sha256> sums;
    RowDigest digest;
    while (select.step("hash the errors in worlds")) {
        digest.add_row(select, columns.names);
        const auto block = static_cast<int>(select.get<std::int64_t>(extra + 1) / worlds_per_block);
        add_to(sums[{world_part(select.get<std::string>(extra)), block}], digest.finish());
    }
    std::map<std::pair<std::string, int>, std::string> texts;
    for (const auto& [part, sum] : sums) texts[part] = hexadecimal(sum);
    return texts;
}

}  // namespace capstan::storage
