#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "capstan/storage/database.h"

namespace capstan::cli {

/// One regime's advice from a study whose truth is the estimators' model, and from one whose truth differs.
struct AdviceUnderTruth {
    std::string noise;
    std::string regime;
    std::vector<int> model_nodes;  ///< from 1
    std::string model_method;      ///< title
    double expected_error_N = 0.0;
    double true_error_N = 0.0;  ///< of the model's advice where the truth differs, on the same draws
    std::vector<int> true_nodes;
    std::string true_method;
    double best_error_N = 0.0;   ///< on the same draws, which chose it
    double fresh_error_N = 0.0;  ///< on fresh ones, with its interval
    double fresh_low_N = 0.0;
    double fresh_high_N = 0.0;
    bool stays = true;  ///< the model's advice is the best of both, or cannot be told from the best
};

/// Both studies must be complete, and of the same plan but for the truth.
std::vector<AdviceUnderTruth> advice_under_truth(storage::Database& database, std::int64_t of_model,
                                                 std::int64_t of_truth);

std::string in_words(const std::vector<AdviceUnderTruth>& advice);
nlohmann::ordered_json in_json(const std::vector<AdviceUnderTruth>& advice);

}  // namespace capstan::cli
