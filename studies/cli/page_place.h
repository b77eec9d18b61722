#pragma once

#include "capstan/search/placement_answer.h"
#include "capstan/plan/study_plan.h"
#include "capstan/reports/experiment_page.h"

namespace capstan::cli {

/// The best layouts as a page: error against number of sensors beside the families, which nodes, the numbers.
reports::ExperimentPage place_page(const StudyPlan& plan, const PlacementAnswer& answer);

}  // namespace capstan::cli
