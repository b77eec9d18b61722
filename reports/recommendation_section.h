#pragma once
// One card per recommendation, with the cable, the numbers and the choices that are not significantly worse.

#include <string>

#include "capstan/reports/table.h"

namespace capstan::reports {

std::string recommendation_section(const StudyTables& tables);  // '' without recommendations

// The study in one sentence: the widest-reaching recommendation at the first noise level.
std::string verdict(const StudyTables& tables);

std::string recommendation_title(const Row& recommendation);  // 'Across regimes: smallest worst regret'
std::string objective_title(const Row& recommendation);       // what its error_N means

}  // namespace capstan::reports
