#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan::cli {

/// A study's conclusions, ready to be said in words or as JSON.
struct Conclusions {
    std::int64_t study_id = 0;
    storage::StudyDescription study;
    std::vector<storage::RecommendationRecord> recommendations;
    std::vector<storage::PaperComparisonRecord> paper_comparison;
};

/// Throws UsageError if the study is not complete.
Conclusions read_conclusions(storage::Database& database, std::int64_t study_id);

std::string in_words(const Conclusions& conclusions);
nlohmann::ordered_json in_json(const Conclusions& conclusions);

}  // namespace capstan::cli
