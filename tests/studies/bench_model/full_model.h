#pragma once

#include <cmath>

#include "capstan/bench_model/bench_model.h"
#include "capstan/bench_model/effect_numbers.h"
#include "session_with_effects.h"

namespace capstan::bench_model {

/// A number with all of its 53 bits in use.
inline double odd_number(double about) {
    return about * (1.0 + 1.0 / std::sqrt(7.0));
}

/// What a diagnosis of exact_session() could have found, with something of everything.
inline model_comparison::DiagnosedSplit full_split() {
    model_comparison::DiagnosedSplit split;
    split.recorded = gap::exact_session({}, gap::coarse_twin);
    for (const RecordedRun& run : split.recorded.runs) split.split.fit.push_back(run.number);
    split.bench = split.diagnosed = split.recorded;
    gap::Diagnosis& found = split.diagnosis;
    found.corrected.friction_ratio = odd_number(0.9);
    found.corrected.stiffness_ratio = odd_number(0.8);
    found.corrected.pretension_ratio = odd_number(0.7);
    found.friction_interval = {odd_number(0.85), odd_number(0.95)};
    found.corrected.effects.of<ViscousFriction>().drag_N_s_per_m2 = odd_number(3.0);
    found.corrected.effects.of<PulleyFriction>().motor = {odd_number(0.01), 0.0, odd_number(0.05), 0.01};
    LocalBend& bend = found.corrected.effects.of<LocalBend>();
    bend = {odd_number(0.5), odd_number(0.3), odd_number(0.1), BentCables::only_b};
    found.corrected.sensor_faults["load_torque"].offset = odd_number(-0.02);
    found.corrected.sensor_faults["load_torque"].gain = odd_number(0.8);
    found.corrected.sensor_faults["load_torque"].drift_by_100_s = odd_number(0.03);
    found.corrected.sensor_faults["load_torque"].hysteresis = odd_number(0.01);
    found.corrected.sensor_faults["load_torque"].loop_exponent = odd_number(0.3);
    using Following = gap::BenchNumbers::Following;
    Following follows{Following::What::friction, "", "roll_deg", odd_number(-10.0), odd_number(45.0),
                      odd_number(0.1),           0.0};
    found.corrected.follows.push_back(follows);
    follows.what = Following::What::zero;
    follows.channel = "load_torque";
    follows.linear = odd_number(1e-3);
    follows.squared = odd_number(-2e-3);
    found.corrected.follows.push_back(follows);
    found.causes = {{"local_bend",
                     "cable B",
                     "conduit",
                     "",
                     {{"angle", "rad", bend.extra_angle_rad, FittedInterval{0.6, odd_number(0.6)}}},
                     bend.middle_m},
                    {"sensor_offset",
                     "load_torque with roll_deg",
                     "sensor:load_torque",
                     "",
                     {{"change_over_half_range", "N m", odd_number(1e-3), FittedInterval{0.0, 0.002}}},
                     {}}};
    found.bench = {{"zero of load_torque", "N m", odd_number(-0.02), FittedInterval{-0.05, 0.05}},
                   {"friction of the motor's bearing", "N m", odd_number(0.01), FittedInterval{0.0, 0.05}}};
    found.ranked = {{"local_bend", odd_number(0.4), odd_number(0.6), ""},
                    {"sensor_offset", odd_number(0.2), odd_number(0.3), "roll_deg"}};
    return split;
}

/// A law with a feature of each form, of the load torque over the load angle.
inline model_comparison::LeftOver some_law(const Recording& recording) {
    using residual_law::FeatureKind;
    model_comparison::LeftOver left;
    left.channels.output = static_cast<std::size_t>(*recording.channel("load_torque"));
    left.channels.motion = static_cast<std::size_t>(*recording.channel("load_angle"));
    left.channels.load = static_cast<std::size_t>(*recording.channel("motor_torque"));
    left.law.scales = {odd_number(0.1), odd_number(0.5), odd_number(2.0), odd_number(-0.2), 100.0};
    left.law.weights = {{{FeatureKind::friction, odd_number(0.1), true}, odd_number(0.01)},
                        {{FeatureKind::speed, 0.0, false}, odd_number(-0.02)}};
    left.law.terms = {{{left.law.weights[0].feature}, odd_number(0.01), odd_number(0.001), "a \"torque\""}};
    left.law.band = odd_number(0.03);
    left.law.removed_fraction = odd_number(0.3);
    left.law.removed_low = -0.1;
    left.law.removed_high = 0.9;
    return left;
}

inline BenchModel full_model() {
    const model_comparison::DiagnosedSplit split = full_split();
    return model_of(split, {some_law(split.recorded)},
                    {split.recorded.name, split.split.fit, "0.0", "A verdict."}, {});
}

}  // namespace capstan::bench_model
