#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "capstan/plan/study_plan.h"
#include "capstan/reports/experiment_page.h"
#include "capstan/sensitivity/advice_sensitivity.h"

namespace capstan::cli {

std::string in_words(const StudyPlan& plan, const sensitivity::SensitivityAnswer& answer);
nlohmann::ordered_json in_json(const StudyPlan& plan, const sensitivity::SensitivityAnswer& answer);

/// The regret along each parameter as a figure, and the numbers.
reports::ExperimentPage sensitivity_page(const StudyPlan& plan, const sensitivity::SensitivityAnswer& answer);

}  // namespace capstan::cli
