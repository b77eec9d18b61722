#pragma once

#include <string>
#include <vector>

#include "capstan/plan/study_plan.h"

namespace capstan {

/// Every sensor that can be bought, one for each place: the rows of [[sensor]], or where there are none a
/// tension sensor at every node with the errors of the first [[noise]].
std::vector<SensorOffer> sensor_offers(const StudyPlan& plan);

/// The plan's rows of sensors, with neither zero nor gain error.
std::vector<SensorRow> calibrated_sensors(const StudyPlan& plan);

/// Whether sensors are offered on both cables of a pair, so that words must name the cable.
bool has_two_cables(const std::vector<SensorOffer>& offers);

/// "tension at 0.35 m", "encoder at the load".
std::string words_of(const SensorOffer& offer);

}  // namespace capstan
