#include "capstan/estimate/sensed_cable.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/cable_state.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/rig/channel_names.h"

namespace capstan::estimate {

namespace {

// Where a channel's tension is its value times `newtons_per_unit`.
struct Source {
    SensedChannel sensed;
    std::size_t channel = 0;
    double newtons_per_unit = 1.0;
};

void demand_what_it_takes(const Recording& recording) {
    std::vector<std::string> problems;
    if (recording.tension_sensors.empty()) {
        problems.push_back(fmt::format(
            "{}: no channel measures a tension, so there is nothing to estimate from; name the strain sensors in "
            "tension_sensors of the sidecar (channel, cable, position s)",
            recording.name));
    }
    const bool cables = recording.mode == BenchMode::pull_pull || recording.mode == BenchMode::single_cable;
    if (!cables || !recording.nominal) {
        problems.push_back(fmt::format(
            "{}: the cable's geometry is not known, so a sensor has no place on it; estimating needs mode pull_pull or "
            "single_cable with nominal values",
            recording.name));
    }
    if (!recording.channel(channel::motor_angle))
        problems.push_back(
            fmt::format("{}: nobody measured motor_angle, which moves the cable's near end", recording.name));
    if (recording.mode == BenchMode::pull_pull && !recording.channel(channel::load_angle))
        problems.push_back(
            fmt::format("{}: nobody measured load_angle, which moves the cable's far end", recording.name));
    for (const RecordedRun& run : recording.runs) {
        if (!run.pretension_N)
            problems.push_back(fmt::format("{}: run {}: no pretension T0, from which the estimate starts",
                                           recording.name, run.number));
    }
    if (!problems.empty()) throw InvalidInput(std::move(problems));
}

std::vector<Source> sources_of(const Recording& recording, CableName cable) {
    std::vector<Source> sources;
    const auto add = [&](const std::string& name, double position_m, double newtons_per_unit) {
        const auto index = static_cast<std::size_t>(*recording.channel(name));
        const double noise_N = newtons_per_unit * sample_noise(recording.channels[index]);
        sources.push_back({{name, position_m, noise_N}, index, newtons_per_unit});
    };
    for (const TensionSensor& sensor : recording.tension_sensors) {
        if (sensor.cable == cable) add(sensor.channel, sensor.position_m, 1.0);
    }
    if (recording.mode != BenchMode::single_cable || sources.empty()) return sources;
    const NominalBench& bench = *recording.nominal;
    const auto free_everywhere = [&](const char* name) {
        return recording.channel(name) && std::none_of(recording.runs.begin(), recording.runs.end(),
                                                       [&](const auto& run) { return run.drives(name); });
    };
    if (free_everywhere(channel::motor_torque)) add(channel::motor_torque, 0.0, 1.0 / bench.motor_radius_m);
    if (free_everywhere(channel::load_torque))
        add(channel::load_torque, length_m(bench.curvature), 1.0 / bench.load_radius_m);
    return sources;
}

// A measured angle of a run, freed of noise; zeros where there is none.
std::vector<double> angle_of(const Recording& recording, const RecordedRun& run, const char* name) {
    const auto index = recording.channel(name);
    if (!index) return std::vector<double>(run.time_s.size(), 0.0);
    const auto channel = static_cast<std::size_t>(*index);
    if (run.drives(name)) return driven_inputs(recording, run).values[channel];
    return smoothed(run.values[channel], sample_noise(recording.channels[channel]));
}

std::vector<KnownEnds> ends_of(const Recording& recording, const RecordedRun& run, CableName name,
                               const Cable& cable) {
    const NominalBench& bench = *recording.nominal;
    const double side = name == CableName::a ? 1.0 : -1.0;  // E15
    const CableState rest = pretensioned(cable);
    const std::vector<double> motor_rad = angle_of(recording, run, channel::motor_angle);
    const bool far_end_moves = recording.mode == BenchMode::pull_pull;
    const std::vector<double> load_rad = far_end_moves ? angle_of(recording, run, channel::load_angle)
                                                       : std::vector<double>(run.time_s.size(), 0.0);
    std::vector<KnownEnds> ends;
    for (std::size_t k = 0; k < run.time_s.size(); ++k) {
        ends.push_back({rest.displacement_m.front() - side * bench.motor_radius_m * motor_rad[k],
                        rest.displacement_m.back() - side * bench.load_radius_m * load_rad[k]});
    }
    return ends;
}

SensedRun sensed_run(const Recording& recording, const RecordedRun& run, CableName name,
                     CableSpecification specification, const std::vector<Source>& sources) {
    specification.pretension_N = *run.pretension_N;
    SensedRun sensed{run.number, run.protocol, *run.pretension_N, run.time_s, {}, {}};
    sensed.ends = ends_of(recording, run, name, Cable(specification));
    for (const Source& source : sources) {
        std::vector<double> reading_N = run.values[source.channel];
        for (double& value : reading_N) value *= source.newtons_per_unit;
        sensed.reading_N.push_back(std::move(reading_N));
    }
    return sensed;
}

}  // namespace

bool ShiftedCable::is_shifted() const {
    const double ratios[] = {friction_ratio, stiffness_ratio, pretension_ratio, viscous_ratio,
                             stribeck_ratio};
    return std::any_of(std::begin(ratios), std::end(ratios), [](double ratio) { return ratio != 1.0; });
}

CableSpecification SensedCable::specification_in(const SensedRun& run) const {
    CableSpecification in_run = specification;
    in_run.pretension_N = run.pretension_N;
    in_run.dynamic_friction *= run.friction_ratio;
    in_run.static_friction *= run.friction_ratio;
    return in_run;
}

std::vector<SensedCable> sensed_cables(const Recording& as_recorded, int segments) {
    demand_what_it_takes(as_recorded);
    require_stated_numbers(as_recorded, "give the model that a diagnosis saves, with --model");
    const Recording recording = with_estimated_noise(as_recorded);
    const NominalBench& bench = *recording.nominal;
    std::vector<SensedCable> cables;
    for (const CableName name : {CableName::a, CableName::b}) {
        const std::vector<Source> sources = sources_of(recording, name);
        if (sources.empty()) continue;
        SensedCable cable;
        cable.name = name == CableName::a ? "A" : "B";
        cable.interval_s = 1.0 / recording.sample_rate_Hz;
        cable.specification = cable_specification(bench.curvature,
                                                  {.dynamic_friction = bench.dynamic_friction,
                                                   .static_friction = bench.static_friction,
                                                   .axial_stiffness_N = bench.axial_stiffness_N},
                                                  segments);
        for (const Source& source : sources) cable.channels.push_back(source.sensed);
        for (const RecordedRun& run : recording.runs)
            cable.runs.push_back(sensed_run(recording, run, name, cable.specification, sources));
        cables.push_back(std::move(cable));
    }
    return cables;
}

}  // namespace capstan::estimate
