#include "capstan/calibration/twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "capstan/cable/invalid_input.h"
#include "capstan/rig/channel_names.h"
#include "capstan/solver/pull_pull.h"

namespace capstan::gap {

namespace {

enum CableParameter : std::size_t { dynamic_friction, static_friction, axial_stiffness, pretension };

std::vector<TwinParameter> parameters_of(const NominalBench& bench) {
    return {{"dynamic_friction", "", "mu_d of a sliding cable", bench.dynamic_friction},
            {"static_friction", "", "mu_s of a cable about to slide", bench.static_friction},
            {"axial_stiffness", "N", "EA of the cable", bench.axial_stiffness_N},
            {"pretension", "", "pretension in parts of what the sidecar says of each run", 1.0}};
}

double tension_at_N(const Cable& cable, const CableState& state, double position_m) {
    const auto [segment, fraction] = cable.spot_at(position_m);
    const auto node = static_cast<std::size_t>(segment);
    return (1.0 - fraction) * state.tension_N[node] + fraction * state.tension_N[node + 1];
}

class KnownBench : public Twin {
  public:
    KnownBench(const Recording& recording, int segments)
        : recording_(recording), segments_(segments), parameters_(parameters_of(*recording.nominal)) {
        for (const RecordedRun& run : recording.runs) inputs_.push_back(driven_inputs(recording, run));
    }

    const std::vector<TwinParameter>& parameters() const final { return parameters_; }

  protected:
    const Recording& recording() const { return recording_; }
    const NominalBench& bench() const { return *recording_.nominal; }
    const RecordedRun& recorded(std::size_t run) const { return recording_.runs[run]; }
    PredictedChannels predictions(std::size_t run) const {
        return {recording_, recording_.runs[run], inputs_[run]};
    }

    Cable cable(std::size_t run, std::span<const double> values) const {
        const CableNumbers numbers{.dynamic_friction = values[dynamic_friction],
                                   .static_friction = values[static_friction],
                                   .axial_stiffness_N = values[axial_stiffness],
                                   .pretension_N = values[pretension] * *recorded(run).pretension_N};
        return Cable(cable_specification(bench().curvature, numbers, segments_));
    }

    void check_driven(std::initializer_list<const char*> any_of) const {
        for (const RecordedRun& run : recording_.runs) {
            const bool driven = std::any_of(any_of.begin(), any_of.end(),
                                            [&](const char* channel) { return run.drives(channel); });
            if (driven) continue;
            std::string names;
            for (const char* channel : any_of) names += (names.empty() ? "" : " or ") + std::string(channel);
            throw InvalidInput({fmt::format("{}: run {}: the driven channels determine no motion; drive {}",
                                            recording_.name, run.number, names)});
        }
    }

  private:
    const Recording& recording_;
    int segments_;
    std::vector<TwinParameter> parameters_;
    std::vector<DrivenInputs> inputs_;
};

class PullPullTwin final : public KnownBench {
  public:
    PullPullTwin(const Recording& recording, int segments) : KnownBench(recording, segments) {
        check_driven({channel::motor_angle, channel::motor_torque});
        check_driven({channel::load_angle, channel::load_torque});
        for (const RecordedRun& run : recording.runs) {
            if (!run.drives(channel::load_angle) && !run.drives(channel::motor_angle))
                throw InvalidInput(
                    {fmt::format("{}: run {}: torques at both pulleys leave the angles undetermined; "
                                 "drive load_angle or motor_angle",
                                 recording.name, run.number)});
        }
    }

    TwinRun run(std::size_t run, std::span<const double> values) const override {
        const PullPull pair(cable(run, values), cable(run, values),
                            {bench().motor_radius_m, bench().load_radius_m});
        const RecordedRun& recorded_run = recorded(run);
        const bool by_motor_angle = recorded_run.drives(channel::motor_angle);
        const bool by_load_angle = recorded_run.drives(channel::load_angle);
        PredictedChannels channels = predictions(run);
        PullPullState state = pair.at_rest();
        for (int sample = 0; sample < recorded_run.samples(); ++sample) {
            PullPullInputs inputs;
            if (by_motor_angle) {
                inputs.motor = MotorAngle{channels.driven(channel::motor_angle, sample)};
            } else {
                inputs.motor = MotorTorque{channels.driven(channel::motor_torque, sample)};
            }
            if (by_load_angle) {
                inputs.load = LoadAngle{channels.driven(channel::load_angle, sample)};
            } else {
                inputs.load = LoadTorque{channels.driven(channel::load_torque, sample)};
            }
            if (!pair.advance(state, inputs).solved()) channels.count_unsolved();
            channels.predict(channel::motor_torque, sample, pair.motor_torque_Nm(state));
            channels.predict(channel::motor_angle, sample, state.motor_angle_rad);
            channels.predict(channel::load_angle, sample, state.load_angle_rad);
            channels.predict(channel::load_torque, sample, pair.load_torque_Nm(state));
            for (const TensionSensor& sensor : recording().tension_sensors) {
                const CableState& sensed = sensor.cable == CableName::a ? state.cable_a : state.cable_b;
                channels.predict(sensor.channel, sample,
                                 tension_at_N(pair.cable_a(), sensed, sensor.position_m));
            }
        }
        return channels.take();
    }
};

class SingleCableTwin final : public KnownBench {
  public:
    SingleCableTwin(const Recording& recording, int segments) : KnownBench(recording, segments) {
        check_driven({channel::motor_angle});
    }

    TwinRun run(std::size_t run, std::span<const double> values) const override {
        const QuasiStaticStep step(cable(run, values), ModelRules::consistent());
        PredictedChannels channels = predictions(run);
        CableState state = pretensioned(step.cable());
        const double rest_m = state.displacement_m.front();
        for (int sample = 0; sample < recorded(run).samples(); ++sample) {
            const double reeled_in_m = bench().motor_radius_m * channels.driven(channel::motor_angle, sample);
            const StepReport report = step.advance(
                state, {EndCondition::position_m(rest_m - reeled_in_m), EndCondition::position_m(0.0)});
            if (!report.verified) channels.count_unsolved();
            channels.predict(channel::motor_torque, sample, bench().motor_radius_m * state.tension_N.front());
            channels.predict(channel::load_torque, sample, bench().load_radius_m * state.tension_N.back());
            for (const TensionSensor& sensor : recording().tension_sensors)
                channels.predict(sensor.channel, sample,
                                 tension_at_N(step.cable(), state, sensor.position_m));
        }
        return channels.take();
    }
};

}  // namespace

std::unique_ptr<Twin> make_pull_pull_twin(const Recording& recording, int segments) {
    return std::make_unique<PullPullTwin>(recording, segments);
}

std::unique_ptr<Twin> make_single_cable_twin(const Recording& recording, int segments) {
    return std::make_unique<SingleCableTwin>(recording, segments);
}

std::vector<double> nominal_values(const Twin& twin) {
    std::vector<double> values;
    for (const TwinParameter& parameter : twin.parameters()) values.push_back(parameter.nominal);
    return values;
}

std::unique_ptr<Twin> make_twin(const Recording& recording, int segments) {
    switch (recording.mode) {
        case BenchMode::pull_pull:
            return make_pull_pull_twin(recording, segments);
        case BenchMode::single_cable:
            return make_single_cable_twin(recording, segments);
        case BenchMode::lumped_drive:
            return make_lumped_drive_twin(recording);
        case BenchMode::capstan_band:
            break;
    }
    throw InvalidInput({recording.name +
                        ": a band round a drum has no model of its own; known are pull_pull, "
                        "single_cable and lumped_drive"});
}

}  // namespace capstan::gap
