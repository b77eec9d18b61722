#include "capstan/gap/effects_twin.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/bench_simulation.h"

namespace capstan::gap {

namespace {

// A twin that lost itself predicts this many times nothing, so that no fit goes there.
constexpr double absurd = 1e3;

BenchDescription description_of(const Recording& recording, const RecordedRun& run,
                                const BenchNumbers& numbers, int segments) {
    const NominalBench& bench = *recording.nominal;
    CableSpecification cable;
    cable.curvature = bench.curvature;
    cable.segments = segments;
    cable.axial_stiffness_N = numbers.stiffness_ratio * bench.axial_stiffness_N;
    cable.dynamic_friction = cable.static_friction = numbers.friction_ratio * bench.dynamic_friction;
    cable.pretension_N = numbers.pretension_ratio * *run.pretension_N;
    return {Cable(cable),
            recording.mode == BenchMode::pull_pull,
            {bench.motor_radius_m, bench.load_radius_m},
            {bench.rotor_inertia_kg_m2, bench.load_pulley_inertia_kg_m2}};
}

void demand_motion(const Recording& recording) {
    if (recording.mode != BenchMode::pull_pull && recording.mode != BenchMode::single_cable)
        throw InvalidInput({recording.name +
                            ": the geometry of this bench is not known; effects can be told apart on "
                            "pull_pull and single_cable benches"});
    for (const RecordedRun& run : recording.runs) {
        const bool motor = run.drives("motor_angle") || run.drives("motor_torque");
        const bool load =
            run.drives("load_angle") || (run.drives("load_torque") && run.drives("motor_angle"));
        if (!motor || (recording.mode == BenchMode::pull_pull && !load))
            throw InvalidInput(
                {recording.name + ": run " + std::to_string(run.number) +
                 ": the driven channels determine no motion; drive motor_torque or motor_angle, and "
                 "load_angle"});
    }
}

}  // namespace

EffectsTwin::EffectsTwin(const Recording& recording, const EffectsTwinOptions& options)
    : recording_(recording), options_(options) {
    demand_motion(recording);
    for (const RecordedRun& run : recording.runs) inputs_.push_back(driven_inputs(recording, run));
}

int EffectsTwin::samples(std::size_t run) const {
    return (recording_.runs[run].samples() + options_.stride - 1) / options_.stride;
}

TwinRun EffectsTwin::run(std::size_t run_index, const BenchNumbers& numbers) const {
    const RecordedRun& run = recording_.runs[run_index];
    const DrivenInputs& inputs = inputs_[run_index];
    BenchSimulation bench(description_of(recording_, run, numbers, options_.segments), numbers.effects);
    const auto given = [&](const char* channel, int sample) {
        return inputs
            .values[static_cast<std::size_t>(*recording_.channel(channel))][static_cast<std::size_t>(sample)];
    };
    const bool by_torque = !run.drives("motor_angle");
    const bool load_driven = run.drives("load_angle");
    const bool by_load_torque = !load_driven && run.drives("load_torque");

    TwinRun twin;
    twin.values.resize(recording_.channels.size());
    std::vector<std::pair<std::size_t, std::function<double()>>> readers;
    for (std::size_t channel = 0; channel < recording_.channels.size(); ++channel) {
        const std::string& name = recording_.channels[channel].name;
        if (run.drives(name)) continue;
        if (name == "motor_torque") readers.emplace_back(channel, [&] { return bench.motor_torque_Nm(); });
        if (name == "motor_angle") readers.emplace_back(channel, [&] { return bench.motor_angle_rad(); });
        if (name == "load_torque") readers.emplace_back(channel, [&] { return bench.load_torque_Nm(); });
        if (name == "load_angle" && by_load_torque)
            readers.emplace_back(channel, [&] { return bench.load_angle_rad(); });
    }
    for (const TensionSensor& sensor : recording_.tension_sensors) {
        const BenchCable& cable = sensor.cable == CableName::a ? bench.cable_a() : bench.cable_b();
        if (run.drives(sensor.channel)) continue;
        readers.emplace_back(
            static_cast<std::size_t>(*recording_.channel(sensor.channel)),
            [&bench, &cable, at_m = sensor.position_m] { return bench.tension_at_N(cable, at_m); });
    }
    for (auto& [channel, reader] : readers)
        twin.values[channel].reserve(static_cast<std::size_t>(samples(run_index)));

    const double time_step_s = options_.stride / recording_.sample_rate_Hz;
    for (int sample = 0; sample < run.samples(); sample += options_.stride) {
        BenchInputs step{MotorAngle{0.0}, LoadAngle{0.0}, time_step_s,
                         run.session_start_s + run.time_s[static_cast<std::size_t>(sample)]};
        if (by_torque) {
            step.motor = MotorTorque{given("motor_torque", sample)};
        } else {
            step.motor = MotorAngle{given("motor_angle", sample)};
        }
        if (load_driven) {
            step.load = LoadAngle{given("load_angle", sample)};
        } else if (by_load_torque) {
            step.load = LoadTorque{given("load_torque", sample)};
        }
        if (!bench.advance(step).converged) ++twin.unsolved_steps;
        for (auto& [channel, reader] : readers) {
            const double value = reader();
            twin.values[channel].push_back(std::isfinite(value) ? std::clamp(value, -absurd, absurd)
                                                                : absurd);
        }
    }
    for (const auto& [channel, faults] : numbers.sensor_faults) {
        std::vector<double>& values = twin.values[static_cast<std::size_t>(*recording_.channel(channel))];
        if (!values.empty()) values = sensed(std::move(values), faults, time_step_s);
    }
    return twin;
}

}  // namespace capstan::gap
