#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "capstan/search/placement_answer.h"
#include "capstan/plan/study_plan.h"

namespace capstan::cli {

/// The answer for people: one table for each question.
std::string in_words(const StudyPlan& plan, const PlacementAnswer& answer);
/// All of it, for programs.
nlohmann::ordered_json in_json(const StudyPlan& plan, const PlacementAnswer& answer);

/// "mass motion", "smallest worst regret across regimes".
std::string title_of(const ScopeAnswer& scope);
/// "mean error at all nodes".
std::string words_of(PlacementObjective objective);

}  // namespace capstan::cli
