#include "capstan/worlds/sensor_places.h"

#include <fmt/format.h>

namespace capstan {

namespace {

double length_of_m(const CableSpecification& cable) {
    double length_m = 0.0;
    for (const CurvaturePiece& piece : cable.curvature) length_m += piece.length_m;
    return length_m;
}

std::vector<double> nodes_m(const CableSpecification& cable) {
    std::vector<double> places_m;
    const double length_m = length_of_m(cable);
    for (int node = 0; node <= cable.segments; ++node) places_m.push_back(length_m * node / cable.segments);
    return places_m;
}

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
                if (places_m.empty()) places_m = nodes_m(cable);
                break;
            case SensorKind::motor_torque:
                places_m = {0.0};
                break;
            case SensorKind::load_torque:
            case SensorKind::load_displacement:
                places_m = {length_of_m(cable)};
                break;
        }
        for (const double place_m : places_m) offers.push_back({row.kind, place_m, row.errors, row.price});
    }
    return offers;
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
