#pragma once

#include <string>

#include "capstan/plan/study_plan.h"
#include "capstan/reports/answer.h"
#include "capstan/worlds/world_study.h"

namespace capstan::answers {

// The values of an answer of a study over worlds, shared by its tables and its JSON.

reports::Data interval_data(const Estimated& estimated);
/// A set of sensors and the errors to expect of it.
reports::Data expected_data(const StudyPlan& plan, const WorldAnswer& found, const Expected& expected);
reports::Data recommendation_data(const StudyPlan& plan, const WorldAnswer& found);
/// A row for no sensor, each baseline and the best set of each price.
reports::Data prices_data(const StudyPlan& plan, const WorldAnswer& found);
/// What a further sensor and every calibration would gain.
reports::Data gains_data(const StudyPlan& plan, const WorldAnswer& found);
reports::Data robustness_data(const WorldAnswer& found);
reports::Data grid_data(const GridError& grid);
std::string title_of_condition(Condition condition);
std::string objective_words(PlacementObjective objective);

}  // namespace capstan::answers
