#include "capstan/bench/bench_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/plan/true_motion.h"
#include "capstan/recording/channel_range.h"
#include "capstan/rig/channel_names.h"
#include "capstan/sensing/random_stream.h"

namespace capstan::bench {

namespace {

constexpr int finest_segments = 100;

NominalBench nominal_of(const CableSpecification& cable, const Pulleys& pulleys) {
    NominalBench nominal;
    nominal.curvature = cable.curvature;
    nominal.motor_radius_m = pulleys.motor_radius_m;
    nominal.load_radius_m = pulleys.load_radius_m;
    nominal.axial_stiffness_N = cable.axial_stiffness_N;
    nominal.dynamic_friction = cable.dynamic_friction;
    nominal.static_friction = cable.static_friction;
    return nominal;
}

// Evenly from end to end; one alone is in the middle.
double even_place_m(int sensor, int count, double length_m) {
    return count == 1 ? 0.5 * length_m : length_m * sensor / (count - 1);
}

// Linear between nodes.
double tension_at_place_N(const Cable& cable, const std::vector<double>& tension_N, double place_m) {
    int node = 0;
    while (node + 2 < cable.nodes() && cable.node_position_m(node + 1) < place_m) ++node;
    const double from_m = cable.node_position_m(node);
    const double part = std::clamp((place_m - from_m) / (cable.node_position_m(node + 1) - from_m), 0.0, 1.0);
    const auto below = static_cast<std::size_t>(node);
    return tension_N[below] + part * (tension_N[below + 1] - tension_N[below]);
}

void add_sensors(Recording& recording, CableName cable, const std::string& prefix, int count,
                 double length_m) {
    for (int sensor = 0; sensor < count; ++sensor) {
        const std::string name = fmt::format("{}{}", prefix, sensor + 1);
        recording.channels.push_back({name, "N", {}, {}});
        recording.tension_sensors.push_back({name, cable, even_place_m(sensor, count, length_m)});
    }
}

Recording with_shaft_channels(const std::string& name, BenchMode mode, double sample_rate_Hz) {
    Recording recording;
    recording.name = name;
    recording.mode = mode;
    recording.sample_rate_Hz = sample_rate_Hz;
    recording.channels = {{channel::motor_torque, "N m", {}, {}},
                          {channel::motor_angle, "rad", {}, {}},
                          {channel::load_torque, "N m", {}, {}},
                          {channel::load_angle, "rad", {}, {}}};
    return recording;
}

bool same_transmission(const NominalBench& a, const NominalBench& b) {
    const auto same_piece = [](const CurvaturePiece& one, const CurvaturePiece& other) {
        return one.length_m == other.length_m && one.bend_radius_m == other.bend_radius_m;
    };
    return std::equal(a.curvature.begin(), a.curvature.end(), b.curvature.begin(), b.curvature.end(),
                      same_piece) &&
           a.motor_radius_m == b.motor_radius_m && a.load_radius_m == b.load_radius_m &&
           a.axial_stiffness_N == b.axial_stiffness_N && a.dynamic_friction == b.dynamic_friction &&
           a.static_friction == b.static_friction;
}

}  // namespace

Recording empty_recording(const BenchPlan& plan, const Instruments& instruments) {
    Recording recording = with_shaft_channels(plan.name, BenchMode::pull_pull, plan.sample_rate_Hz);
    recording.nominal = nominal_of(plan.cable, plan.pulleys);
    const double cable_m = length_m(plan.cable.curvature);
    add_sensors(recording, CableName::a, "tension_a_", instruments.tension_sensors, cable_m);
    add_sensors(recording, CableName::b, "tension_b_", instruments.tension_sensors, cable_m);
    return recording;
}

void begin_run(Recording& recording, const BenchPlan& plan) {
    if (!same_transmission(*recording.nominal, nominal_of(plan.cable, plan.pulleys)) ||
        plan.sample_rate_Hz != recording.sample_rate_Hz)
        throw InvalidInput({fmt::format(
            "{}: the benches of a recording share their cable, pulleys and sample rate; only motion, "
            "load, pretension and effects may differ from run to run",
            plan.name)});
    RecordedRun run;
    run.number = static_cast<int>(recording.runs.size()) + 1;
    run.protocol = plan.name;
    if (!recording.runs.empty())
        run.session_start_s = recording.runs.back().session_start_s + recording.runs.back().time_s.back();
    run.pretension_N = plan.cable.pretension_N;
    run.output = plan.load_kind == LoadKind::locked ? OutputKind::locked : OutputKind::handle;
    run.driven = {plan.motor_drive == MotorDrive::torque ? channel::motor_torque : channel::motor_angle,
                  plan.load_kind == LoadKind::torque && plan.motor_drive == MotorDrive::angle
                      ? channel::load_torque
                      : channel::load_angle};
    run.values.resize(recording.channels.size());
    recording.runs.push_back(std::move(run));
}

void record(Recording& recording, const Cable& cable, const BenchInstant& now) {
    RecordedRun& run = recording.runs.back();
    run.time_s.push_back(now.time_s);
    const double shafts[] = {now.motor_torque_Nm, now.motor_angle_rad, now.load_torque_Nm,
                             now.load_angle_rad};
    for (std::size_t channel = 0; channel < 4; ++channel) run.values[channel].push_back(shafts[channel]);
    for (std::size_t sensor = 0; sensor < recording.tension_sensors.size(); ++sensor) {
        const TensionSensor& at = recording.tension_sensors[sensor];
        run.values[4 + sensor].push_back(tension_at_place_N(
            cable, at.cable == CableName::a ? now.tension_a_N : now.tension_b_N, at.position_m));
    }
}

Recording recorded_motion(const StudyPlan& plan, const Instruments& instruments) {
    Recording recording = with_shaft_channels(plan.name, BenchMode::single_cable, plan.motion.sample_rate_Hz);
    recording.channels.pop_back();  // the far end is held
    CableSpecification cable = plan.transmission.cable;
    cable.segments = std::max(cable.segments, finest_segments);  // a real cable is not cut
    cable.node_places_m.clear();
    recording.nominal = nominal_of(cable, {recorded_pulley_radius_m, recorded_pulley_radius_m});
    add_sensors(recording, CableName::a, "tension_", instruments.tension_sensors, length_m(cable.curvature));
    const QuasiStaticStep step(Cable(cable), plan.transmission.rules);
    const CableState start = pretensioned(step.cable());
    RecordedRun& run = recording.runs.emplace_back();
    run.number = 1;
    run.protocol = plan.name;
    run.pretension_N = cable.pretension_N;
    run.output = OutputKind::locked;
    run.driven = {channel::motor_angle};
    run.values.resize(recording.channels.size());
    const auto note = [&](int sample, const CableState& now) {
        if (std::abs(now.displacement_m.back() - start.displacement_m.back()) > 1e-12)
            throw InvalidInput({fmt::format(
                "{}: the far end moves; a recording of a single cable has its far end held (leave "
                "[motion.distal] out)",
                plan.name)});
        run.time_s.push_back(sample / plan.motion.sample_rate_Hz);
        run.values[0].push_back(recorded_pulley_radius_m * now.tension_N.front());
        run.values[1].push_back((start.displacement_m.front() - now.displacement_m.front()) /
                                recorded_pulley_radius_m);
        run.values[2].push_back(recorded_pulley_radius_m * now.tension_N.back());
        for (std::size_t sensor = 0; sensor < recording.tension_sensors.size(); ++sensor)
            run.values[3 + sensor].push_back(tension_at_place_N(
                step.cable(), now.tension_N, recording.tension_sensors[sensor].position_m));
    };
    note(0, start);
    simulate(step, plan.motion, [&](const TrueSample& sample) { note(sample.sample, sample.now); });
    return recording;
}

void add_noise(Recording& recording, const Instruments& instruments) {
    if (instruments.noise_fraction <= 0.0) return;
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const double deviation = instruments.noise_fraction * range_of(recording, channel).span();
        if (deviation <= 0.0) continue;
        recording.channels[channel].noise_std = deviation;
        for (std::size_t run = 0; run < recording.runs.size(); ++run) {
            std::vector<double>& values = recording.runs[run].values[channel];
            for (std::size_t sample = 0; sample < values.size(); ++sample)
                values[sample] +=
                    deviation * standard_normals({.seed = instruments.seed,
                                                  .purpose = RandomPurpose::bench_reading,
                                                  .scenario = static_cast<std::uint32_t>(sample),
                                                  .repetition = static_cast<std::uint32_t>(run),
                                                  .node = static_cast<std::uint32_t>(channel)})[0];
        }
    }
}

}  // namespace capstan::bench
