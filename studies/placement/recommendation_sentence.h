#pragma once

#include <string>

#include "capstan/storage/records.h"

namespace capstan {

/// The recommendation in words that a designer can act on.
std::string recommendation_sentence(const storage::StudyDescription& study,
                                    const storage::RecommendationRecord& recommendation,
                                    double worthwhile_gain_N);

}  // namespace capstan
