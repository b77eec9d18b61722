#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "capstan/plan/study_plan.h"
#include "capstan/storage/database.h"
#include "capstan/storage/read_only_query.h"

namespace capstan::service {

/// What the commands answer, so that the service says the same: each returns what the command writes. Whoever
/// knows the configuration text and the commands' words fills them in. Wrong input is a BadRequest.
struct Answers {
    std::function<std::string(storage::Database&, std::int64_t study_id)> study;  ///< study show --json
    std::function<std::string(storage::Database&, std::int64_t study_id)>
        recommendation;                                                 ///< recommend --json
    std::function<std::string(const storage::QueryResult&)> rows_json;  ///< query --format json
    std::function<std::string(const storage::QueryResult&)> rows_csv;   ///< query --format csv
    /// The studies that a configuration stands for, each with its own configuration in full.
    std::function<std::vector<StudyPlan>(const std::string& toml, const std::string& name)> read_config;
    std::function<StudyPlan(storage::Database&, std::int64_t study_id)> stored_plan;
};

}  // namespace capstan::service
