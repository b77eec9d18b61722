#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/plan/study_plan.h"

namespace capstan {

/// What [placement] says of sets of sensors, given as rising indices of the offers. Nodes of the constraints
/// stand for their places.
class SetConstraints {
  public:
    /// `plan` and `offers` must outlive it.
    SetConstraints(const StudyPlan& plan, const std::vector<SensorOffer>& offers)
        : plan_(plan.placement), offers_(offers), cable_(plan.transmission.cable) {}

    bool allow(const std::vector<int>& sensors) const {
        return may_grow(sensors) && missing_m(sensors).empty();
    }
    /// Whether a set breaks nothing that more sensors could not put right.
    bool may_grow(const std::vector<int>& sensors) const;
    /// Sensors that are allowed at all.
    std::vector<int> usable() const;
    /// A set with a sensor at every required place and no other, the cheapest kind at each where that can be;
    /// empty where nothing is required, nothing where no such set is allowed.
    std::optional<std::vector<int>> fewest() const;

  private:
    bool are_too_close(double place_m, double next_m) const;
    bool is_forbidden(const SensorOffer& offer) const;
    std::vector<double> places_of(const std::vector<int>& nodes) const;
    std::vector<double> missing_m(const std::vector<int>& sensors) const;  // required places without a sensor
    bool complete(std::vector<int>& sensors) const;

    const PlacementPlan& plan_;
    const std::vector<SensorOffer>& offers_;
    Cable cable_;
};

}  // namespace capstan
