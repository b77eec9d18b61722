#include "capstan/worlds/set_constraints.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "capstan/cable/cable_cut.h"
#include "capstan/worlds/candidate.h"

namespace capstan {

namespace {

bool is_near(double place_m, const std::vector<double>& places_m) {
    return std::any_of(places_m.begin(), places_m.end(),
                       [&](double other_m) { return std::abs(other_m - place_m) <= same_place_m; });
}

}  // namespace

bool SetConstraints::may_grow(const std::vector<int>& sensors) const {
    if (static_cast<int>(sensors.size()) > plan_.max_sensors) return false;
    if (price_of(sensors, offers_) > plan_.budget * (1.0 + 1e-12)) return false;
    int in_distal_half = 0;
    std::array<std::vector<double>, 2> places_m;  // of each cable
    for (const int sensor : sensors) {
        const SensorOffer& offer = offers_[static_cast<std::size_t>(sensor)];
        if (is_forbidden(offer)) return false;
        if (offer.place_m > 0.5 * cable_.length_m() + same_place_m) ++in_distal_half;
        if (offer.kind == SensorKind::tension)
            places_m[static_cast<std::size_t>(offer.cable)].push_back(offer.place_m);
    }
    if (in_distal_half > plan_.max_in_distal_half) return false;
    for (std::vector<double>& of_cable : places_m) {
        std::sort(of_cable.begin(), of_cable.end());
        for (std::size_t k = 1; k < of_cable.size(); ++k)
            if (are_too_close(of_cable[k - 1], of_cable[k])) return false;
    }
    return true;
}

std::vector<int> SetConstraints::usable() const {
    std::vector<int> sensors;
    for (int sensor = 0; sensor < static_cast<int>(offers_.size()); ++sensor)
        if (may_grow({sensor})) sensors.push_back(sensor);
    return sensors;
}

std::optional<std::vector<int>> SetConstraints::fewest() const {
    std::vector<int> sensors;
    if (!complete(sensors)) return std::nullopt;
    return sensors;
}

// Depth first, so that a kind that breaks a constraint later is taken back.
bool SetConstraints::complete(std::vector<int>& sensors) const {
    const std::vector<double> missing = missing_m(sensors);
    if (missing.empty()) return true;
    std::vector<int> there;
    for (int sensor = 0; sensor < static_cast<int>(offers_.size()); ++sensor) {
        const SensorOffer& offer = offers_[static_cast<std::size_t>(sensor)];
        if (measures_tension(offer.kind) && std::abs(offer.place_m - missing.front()) <= same_place_m)
            there.push_back(sensor);
    }
    std::stable_sort(there.begin(), there.end(), [&](int a, int b) {
        return offers_[static_cast<std::size_t>(a)].price < offers_[static_cast<std::size_t>(b)].price;
    });
    for (const int sensor : there) {
        std::vector<int> grown = sensors;
        grown.insert(std::upper_bound(grown.begin(), grown.end(), sensor), sensor);
        if (!may_grow(grown) || !complete(grown)) continue;
        sensors = std::move(grown);
        return true;
    }
    return false;
}

bool SetConstraints::are_too_close(double place_m, double next_m) const {
    const bool by_nodes = plan_.minimum_spacing > 1 &&
                          cable_.nearest_node(next_m) - cable_.nearest_node(place_m) < plan_.minimum_spacing;
    return by_nodes || next_m - place_m < plan_.minimum_spacing_m - same_place_m;
}

std::vector<double> SetConstraints::places_of(const std::vector<int>& nodes) const {
    std::vector<double> places_m;
    for (const int node : nodes) places_m.push_back(cable_.node_position_m(node));
    return places_m;
}

bool SetConstraints::is_forbidden(const SensorOffer& offer) const {
    if (offer.kind != SensorKind::tension) return false;
    if (is_near(offer.place_m, places_of(plan_.forbidden_nodes))) return true;
    const std::vector<double>& ranges = plan_.forbidden_m;
    for (std::size_t k = 0; k + 1 < ranges.size(); k += 2)
        if (offer.place_m >= ranges[k] - same_place_m && offer.place_m <= ranges[k + 1] + same_place_m)
            return true;
    return false;
}

std::vector<double> SetConstraints::missing_m(const std::vector<int>& sensors) const {
    std::vector<double> there_m;
    for (const int sensor : sensors) {
        const SensorOffer& offer = offers_[static_cast<std::size_t>(sensor)];
        if (measures_tension(offer.kind)) there_m.push_back(offer.place_m);
    }
    std::vector<double> missing = places_of(plan_.required_nodes);
    missing.insert(missing.end(), plan_.required_m.begin(), plan_.required_m.end());
    std::erase_if(missing, [&](double place_m) { return is_near(place_m, there_m); });
    return missing;
}

}  // namespace capstan
