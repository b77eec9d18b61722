#include "capstan/bench_model/calibration_numbers.h"

#include "capstan/cable/cable_cut.h"

namespace capstan::bench_model {

namespace {

FittedNumber scaled(const std::string& name, const std::string& unit, double nominal,
                    const FittedNumber& ratio) {
    FittedNumber number{name, unit, nominal * ratio.value};
    if (ratio.interval)
        number.interval = FittedInterval{nominal * ratio.interval->low, nominal * ratio.interval->high};
    return number;
}

}  // namespace

std::vector<FittedNumber> calibration_numbers(const BenchModel& model) {
    const NominalBench& bench = model.description.bench;
    if (model.recorded_mode == BenchMode::capstan_band) return {};
    if (model.recorded_mode != BenchMode::lumped_drive)
        return {scaled("dynamic_friction", "", bench.dynamic_friction, model.friction_ratio),
                scaled("static_friction", "", bench.static_friction, model.friction_ratio),
                scaled("axial_stiffness", "N", bench.axial_stiffness_N, model.stiffness_ratio),
                scaled("pretension", "", 1.0, model.pretension_ratio)};
    // The equivalent bench back to the drive as its shafts show it.
    const double length_m = capstan::length_m(bench.curvature);
    const double radius_m = bench.motor_radius_m;
    return {scaled("friction_exponent", "", bench.dynamic_friction * wrap_rad(bench.curvature),
                   model.friction_ratio),
            scaled("stiffness", "N m/rad", bench.axial_stiffness_N * radius_m * radius_m / length_m,
                   model.stiffness_ratio),
            scaled("pretension", "N m", model.description.pretension_N * radius_m, model.pretension_ratio),
            {"speed_ratio", "", bench.load_radius_m / radius_m}};
}

}  // namespace capstan::bench_model
