#pragma once
// The hashes of the errors in worlds, which are stored in an order that depends on shards and on kills.

#include <map>
#include <string>
#include <utility>

#include "capstan/storage/integrity/row_digest.h"

namespace capstan::storage {

/// The part of the errors under a condition, as content_hash names it.
std::string world_part(const std::string& condition);
inline constexpr int worlds_per_block = 64;

/// Digests as numbers of 256 bits, added modulo 2^256: the sum over rows does not depend on their order.
std::string sum_of(const std::string& hexadecimal_sum, const Sha256& digest);

/// Part and block -> the sum over the stored rows, as it is now.
std::map<std::pair<std::string, int>, std::string> world_sums(Database& database, std::int64_t study_id);

}  // namespace capstan::storage
