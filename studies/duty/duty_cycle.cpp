#include "capstan/duty/duty_cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/calibration/parameter_file.h"
#include "capstan/calibration/twin.h"
#include "capstan/plan/true_motion.h"
#include "capstan/platform/parallel_for.h"
#include "capstan/platform/work_meter.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/rig/channel_names.h"
#include "capstan/solver/pull_pull.h"

namespace capstan::duty {

namespace {

struct RunMotion {
    MotionTimes times;
    int unsolved_steps = 0;
};

class RunClassifier {
  public:
    /// `values`: of the twin's parameters, in its order.
    RunClassifier(const Recording& recording, const DutyOptions& options, const std::vector<double>& values)
        : recording_(recording),
          options_(options),
          numbers_{
              .dynamic_friction = values[0], .static_friction = values[1], .axial_stiffness_N = values[2]},
          pretension_ratio_(values[3]) {}

    RunMotion classify(const RecordedRun& run) const {
        switch (recording_.mode) {
            case BenchMode::pull_pull:
                return pull_pull(run);
            case BenchMode::single_cable:
                return single_cable(run);
            case BenchMode::lumped_drive:
            case BenchMode::capstan_band:
                break;
        }
        return {};
    }

  private:
    double sample_s() const { return 1.0 / recording_.sample_rate_Hz; }

    Cable cable(const RecordedRun& run) const {
        CableNumbers numbers = numbers_;
        numbers.pretension_N = pretension_ratio_ * run.pretension_N.value_or(0.0);
        return Cable(cable_specification(recording_.nominal->curvature, numbers, options_.segments));
    }

    // Adds the motion of one cable between two samples, counted as `weight` of a cable.
    void count(const CableState& before, const CableState& now, double weight, RunMotion& motion) const {
        const double still_m = options_.still_m_per_s * sample_s();
        const auto moved_m = [&](auto end) {
            return std::abs(end(now.displacement_m) - end(before.displacement_m));
        };
        const bool still = moved_m([](const auto& u) { return u.front(); }) < still_m &&
                           moved_m([](const auto& u) { return u.back(); }) < still_m;
        const double time_s = weight * sample_s();
        const std::optional<Regime> regime = regime_of(now.last_motion);
        if (now.last_motion.kind == MotionKind::slack) {
            motion.times.slack_s += time_s;
        } else if (still || !regime) {
            motion.times.still_s += time_s;
        } else {
            motion.times.regime_s[static_cast<std::size_t>(*regime)] += time_s;
        }
    }

    const std::vector<double>& channel(const DrivenInputs& inputs, std::string_view name) const {
        return inputs.values[static_cast<std::size_t>(*recording_.channel(name))];
    }

    RunMotion pull_pull(const RecordedRun& run) const {
        const NominalBench& bench = *recording_.nominal;
        const PullPull pair(cable(run), cable(run), {bench.motor_radius_m, bench.load_radius_m});
        const DrivenInputs inputs = driven_inputs(recording_, run);
        RunMotion motion;
        PullPullState state = pair.at_rest();
        for (int sample = 0; sample < run.samples(); ++sample) {
            const auto at = [&](std::string_view name) {
                return channel(inputs, name)[static_cast<std::size_t>(sample)];
            };
            PullPullInputs ends;
            if (run.drives(channel::motor_angle)) {
                ends.motor = MotorAngle{at(channel::motor_angle)};
            } else {
                ends.motor = MotorTorque{at(channel::motor_torque)};
            }
            if (run.drives(channel::load_angle)) {
                ends.load = LoadAngle{at(channel::load_angle)};
            } else {
                ends.load = LoadTorque{at(channel::load_torque)};
            }
            const PullPullState before = state;
            motion.unsolved_steps += !pair.advance(state, ends).solved();
            if (sample == 0) continue;  // from rest to the beginning of the recording
            count(before.cable_a, state.cable_a, 0.5, motion);
            count(before.cable_b, state.cable_b, 0.5, motion);
        }
        return motion;
    }

    RunMotion single_cable(const RecordedRun& run) const {
        const QuasiStaticStep step(cable(run), ModelRules::consistent());
        const DrivenInputs inputs = driven_inputs(recording_, run);
        const std::vector<double>& motor_angle_rad = channel(inputs, channel::motor_angle);
        RunMotion motion;
        CableState state = pretensioned(step.cable());
        const double rest_m = state.displacement_m.front();
        for (int sample = 0; sample < run.samples(); ++sample) {
            const double reeled_in_m =
                recording_.nominal->motor_radius_m * motor_angle_rad[static_cast<std::size_t>(sample)];
            const CableState before = state;
            motion.unsolved_steps += !step.advance(state, {EndCondition::position_m(rest_m - reeled_in_m),
                                                           EndCondition::position_m(0.0)})
                                          .verified;
            if (sample > 0) count(before, state, 1.0, motion);
        }
        return motion;
    }

    const Recording& recording_;
    const DutyOptions& options_;
    CableNumbers numbers_;  // without the pretension, which each run has
    double pretension_ratio_;
};

}  // namespace

double MotionTimes::moving_s() const {
    double sum_s = 0.0;
    for (const double time_s : regime_s) sum_s += time_s;
    return sum_s;
}

double DutyCycle::fraction(Regime regime) const {
    const double moving_s = all.moving_s();
    if (!(moving_s > 0.0)) {
        throw InvalidInput(
            {fmt::format("nothing moves in this recording: its cables stand still for {:.1f} s; lower "
                         "the speed below which a cable stands still, or record the drive at work",
                         all.still_s)});
    }
    return all.regime_s[static_cast<std::size_t>(regime)] / moving_s;
}

DutyCycle measure_duty(const Recording& recording, const DutyOptions& options) {
    // The twin's constructor refuses a recording whose driven channels determine no motion.
    const std::unique_ptr<gap::Twin> twin = gap::make_twin(recording, options.segments);
    const bool known = recording.mode == BenchMode::pull_pull || recording.mode == BenchMode::single_cable;
    if (!known || !recording.nominal) {
        throw InvalidInput(
            {fmt::format("{}: which nodes of a cable move follows from its length, bends and stiffness, "
                         "which this recording's sidecar does not give; say \"nominal\" there, with mode "
                         "pull_pull or single_cable",
                         recording.name)});
    }
    if (!options.parameters)
        require_stated_numbers(recording, "give them with --parameters, as a calibration writes them");
    const std::vector<double> values =
        options.parameters ? gap::read_parameter_values(*options.parameters, twin->parameters())
                           : gap::nominal_values(*twin);
    const RunClassifier classifier(recording, options, values);
    std::vector<RunMotion> motions(recording.runs.size());
    expect_work(static_cast<double>(motions.size()));
    parallel_for_each_index(static_cast<int>(motions.size()), options.jobs, [&](int run) {
        motions[static_cast<std::size_t>(run)] =
            classifier.classify(recording.runs[static_cast<std::size_t>(run)]);
        note_work();
    });
    DutyCycle duty;
    for (const RunMotion& motion : motions) {
        duty.runs.push_back(motion.times);
        duty.all.still_s += motion.times.still_s;
        duty.all.slack_s += motion.times.slack_s;
        for (std::size_t k = 0; k < duty.all.regime_s.size(); ++k)
            duty.all.regime_s[k] += motion.times.regime_s[k];
        duty.unsolved_steps += motion.unsolved_steps;
    }
    return duty;
}

double use_duty(const DutyCycle& duty, StudyPlan& plan) {
    double covered = 0.0;
    for (const RegimeInstants& regime : plan.regimes) covered += duty.fraction(regime.regime);
    if (!(covered > 0.0)) {
        std::string missing;
        for (const Regime regime : all_regimes) {
            if (duty.fraction(regime) > 0.0)
                missing += (missing.empty() ? "" : ", ") + std::string(name_of(regime));
        }
        throw InvalidInput({"the recording's drive is never in a regime of the configuration, only in " +
                            missing + "; add a [[regime]] for it"});
    }
    for (RegimeInstants& regime : plan.regimes) regime.duty_fraction = duty.fraction(regime.regime) / covered;
    return 1.0 - covered;
}

}  // namespace capstan::duty
