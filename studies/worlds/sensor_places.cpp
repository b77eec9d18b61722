#include "capstan/worlds/sensor_places.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/cable/cable_cut.h"

namespace capstan {

namespace {

std::vector<SensorRow> rows_of(const StudyPlan& plan) {
    if (!plan.sensors.empty() || plan.noise_levels.empty()) return plan.sensors;
    const NoiseLevel& noise = plan.noise_levels.front().level;
    return {
        {SensorKind::tension, {}, {noise.multiplicative_ratio, noise.additive_N, noise.bias_N, 0.0}, 1.0}};
}

}  // namespace

std::vector<SensorRow> calibrated_sensors(const StudyPlan& plan) {
    std::vector<SensorRow> rows = rows_of(plan);
    for (SensorRow& row : rows) {
        row.errors.zero = 0.0;
        row.errors.gain_ratio = 0.0;
    }
    return rows;
}

std::vector<SensorOffer> sensor_offers(const StudyPlan& plan) {
    const CableSpecification& cable = plan.transmission.cable;
    std::vector<SensorOffer> offers;
    const std::vector<SensorRow> rows = rows_of(plan);
    for (const SensorRow& row : rows) {
        std::vector<double> places_m = row.places_m;
        switch (row.kind) {
            case SensorKind::tension:
                if (places_m.empty()) places_m = node_positions_m(cable);
                break;
            case SensorKind::motor_torque:
                places_m = {0.0};
                break;
            case SensorKind::load_torque:
            case SensorKind::load_displacement:
                places_m = {length_m(cable.curvature)};
                break;
        }
        const bool on_pair =
            plan.transmission.arrangement == CableArrangement::pull_pull && row.kind == SensorKind::tension;
        for (int which = 0; which < (on_pair ? 2 : 1); ++which) {
            if (on_pair && row.cable == (which == 0 ? OfferedOn::cable_b : OfferedOn::cable_a)) continue;
            for (const double place_m : places_m)
                offers.push_back({row.kind, place_m, row.errors, row.price, which});
        }
    }
    return offers;
}

bool has_two_cables(const std::vector<SensorOffer>& offers) {
    return std::any_of(offers.begin(), offers.end(),
                       [](const SensorOffer& offer) { return offer.cable == 1; });
}

std::string words_of(const SensorOffer& offer) {
    switch (offer.kind) {
        case SensorKind::tension:
            return fmt::format("tension at {:.3g} m", offer.place_m);
        case SensorKind::motor_torque:
            return "the motor's torque";
        case SensorKind::load_torque:
            return "the load's torque";
        case SensorKind::load_displacement:
            return "an encoder at the load";
    }
    return {};
}

}  // namespace capstan
