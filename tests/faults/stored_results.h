#pragma once

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "capstan/storage/integrity/content_hash.h"
#include "capstan/storage/integrity/verification.h"
#include "capstan/storage/study_store.h"

namespace capstan::faults {

/// Throws std::runtime_error unless the database holds complete studies with these hashes, no more and no
/// fewer, and every stored number has its hash.
inline void require_results(const std::filesystem::path& file, const std::vector<std::string>& hashes) {
    storage::Database database = storage::Database::open_read_only(file);
    const auto studies = storage::list_studies(database);
    if (studies.size() != hashes.size())
        throw std::runtime_error("there are " + std::to_string(studies.size()) + " studies in the place of " +
                                 std::to_string(hashes.size()));
    for (std::size_t k = 0; k < studies.size(); ++k) {
        if (studies[k].status != "complete") throw std::runtime_error("a study is not complete");
        if (storage::study_hash(database, studies[k].study_id) != hashes[k])
            throw std::runtime_error("a study has other results");
    }
    for (const std::string& problem : storage::check_hashes(database).problems)
        throw std::runtime_error(problem);
}

}  // namespace capstan::faults
