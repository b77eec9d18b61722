#include "capstan/gap_trial/lumped_bench.h"

#include <cmath>

#include "capstan/gap_trial/lumped_cable.h"
#include "capstan/gap_trial/lumped_ends.h"

namespace capstan::gap_trial {

namespace {

LumpedCableNumbers cable_numbers(const TrialBench& bench, const TrialRun& run, const TrueEffects& effects,
                                 const LumpedBenchOptions& options) {
    LumpedCableNumbers numbers;
    numbers.curvature = bench.nominal.curvature;
    numbers.axial_stiffness_N = effects.stiffness_ratio * bench.nominal.axial_stiffness_N;
    numbers.mass_kg_per_m = bench.cable_mass_kg_per_m;
    numbers.dynamic_friction = effects.friction_ratio * bench.nominal.dynamic_friction;
    numbers.static_friction =
        effects.friction_ratio *
        std::lerp(bench.nominal.dynamic_friction, bench.nominal.static_friction, options.static_fraction);
    numbers.pretension_N = effects.pretension_ratio * run.pretension_N;
    numbers.damping_s =
        options.damping_fraction > 0.0
            ? options.damping_fraction * LumpedCable::stable_time_step_s(numbers, options.masses)
            : options.damping_s;
    numbers.loss_stiffness_ratio = options.loss_stiffness_ratio;
    numbers.loss_time_s = options.loss_time_s;
    numbers.session_start_s = run.session_start_s;
    return numbers;
}

// A load pulley's rim: the cable length that it has taken up at an angle, and its lever arm there.
struct Rim {
    double radius_m;
    LobedPulley lobes;

    double taken_up_m(double angle_rad) const {
        if (lobes.fraction == 0.0) return radius_m * angle_rad;
        return radius_m * (angle_rad - lobes.fraction / lobes.lobes *
                                           (std::cos(lobes.lobes * angle_rad + lobes.phase_rad) -
                                            std::cos(lobes.phase_rad)));
    }
    double arm_m(double angle_rad) const {
        if (lobes.fraction == 0.0) return radius_m;
        return radius_m * (1.0 + lobes.fraction * std::sin(lobes.lobes * angle_rad + lobes.phase_rad));
    }
};

// Sums of the channels over the steps of one fine sample.
class FineSample {
  public:
    FineSample(const TrialBench& bench, TrueRun& into) : bench_(bench), into_(into) {
        sums_.assign(into.values.size(), 0.0);
    }

    void add(double motor_torque_Nm, double motor_rad, double load_rad, double load_torque_Nm,
             const LumpedCable& a, const LumpedCable* b) {
        sums_[0] += motor_torque_Nm;
        sums_[1] = motor_rad;
        sums_[2] = load_rad;
        sums_[3] += load_torque_Nm;
        for (std::size_t k = 0; k < bench_.tension_sensors.size(); ++k) {
            const TensionSensor& sensor = bench_.tension_sensors[k];
            const LumpedCable& cable = sensor.cable == CableName::b && b != nullptr ? *b : a;
            sums_[4 + k] += cable.tension_N(sensor.position_m);
        }
    }
    void finish(int steps) {
        for (std::size_t k = 0; k < sums_.size(); ++k) {
            const bool is_angle = k == 1 || k == 2;
            into_.values[k].push_back(is_angle ? sums_[k] : sums_[k] / steps);
            sums_[k] = 0.0;
        }
    }

  private:
    const TrialBench& bench_;
    TrueRun& into_;
    std::vector<double> sums_;
};

int steps_per_fine_sample(const LumpedCableNumbers& numbers, int masses) {
    return static_cast<int>(
        std::ceil(1.0 / (fine_rate_Hz * LumpedCable::stable_time_step_s(numbers, masses))));
}

// What the four sensors of the ends read at a step.
struct EndReadings {
    double motor_torque_Nm;
    double motor_rad;
    double load_rad;
    double load_torque_Nm;
};

// Two cables between the pulleys of a motor and a load.
struct Pair {
    LumpedCable a;
    LumpedCable b;
    MotorSide motor;
    LoadSide load;
    Rim rim;
    double motor_radius_m;

    void move_cables() {
        const CableEnds ends{-motor_radius_m * motor.pulley_rad(), -motor_radius_m * motor.pulley_rad_per_s(),
                             -rim.taken_up_m(load.pulley_rad()),
                             -rim.arm_m(load.pulley_rad()) * load.pulley_rad_per_s()};
        a.step(ends);
        b.step({-ends.motor_m, -ends.motor_m_per_s, -ends.load_m, -ends.load_m_per_s});
    }
    double motor_pull_Nm() const { return motor_radius_m * (a.motor_tension_N() - b.motor_tension_N()); }
    double load_pull_Nm() const {
        return rim.arm_m(load.pulley_rad()) * (a.load_tension_N() - b.load_tension_N());
    }
};

// `start`: what is read at rest; `step` moves both ends to a fraction of the way from a fine sample to the
// next, after the cables have moved.
template <class Step>
TrueRun run_between_pulleys(const TrialBench& bench, const TrialRun& run, const TrueEffects& effects,
                            const LumpedBenchOptions& options, std::size_t samples, const EndReadings& start,
                            const Step& step) {
    LumpedCableNumbers numbers = cable_numbers(bench, run, effects, options);
    const int steps = steps_per_fine_sample(numbers, options.masses);
    const double dt = 1.0 / (fine_rate_Hz * steps);
    const LumpedCable a(numbers, effects, options.masses, dt);
    numbers.is_cable_b = true;
    Pair pair{a,
              LumpedCable(numbers, effects, options.masses, dt),
              MotorSide(bench.nominal.rotor_inertia_kg_m2, effects, dt),
              LoadSide(bench.nominal.load_pulley_inertia_kg_m2, effects, dt),
              {bench.nominal.load_radius_m, effects.lobed_pulley},
              bench.nominal.motor_radius_m};

    TrueRun result;
    result.values.resize(bench.channels().size());
    FineSample sample(bench, result);
    const auto add = [&](const EndReadings& read) {
        sample.add(read.motor_torque_Nm, read.motor_rad, read.load_rad, read.load_torque_Nm, pair.a, &pair.b);
    };
    add(start);
    sample.finish(1);
    for (std::size_t fine = 0; fine + 1 < samples; ++fine) {
        for (int now = 1; now <= steps; ++now) {
            pair.move_cables();
            add(step(pair, fine, static_cast<double>(now) / steps));
        }
        sample.finish(steps);
        const double session_s = run.session_start_s + static_cast<double>(fine + 1) / fine_rate_Hz;
        pair.a.follow(pair.load.pulley_rad(), session_s, 1.0 / fine_rate_Hz);
        pair.b.follow(pair.load.pulley_rad(), session_s, 1.0 / fine_rate_Hz);
    }
    return result;
}

// A torque drives the motor, a hand or a clamp the load.
TrueRun run_pair(const TrialBench& bench, const TrialRun& run, const TrueEffects& effects,
                 const LumpedBenchOptions& options) {
    const MotionBetweenSamples torque(run.motor_torque_Nm, fine_rate_Hz);
    const MotionBetweenSamples hand(run.load_angle_rad, fine_rate_Hz);
    return run_between_pulleys(
        bench, run, effects, options, run.load_angle_rad.size(),
        {run.motor_torque_Nm.front(), 0.0, run.load_angle_rad.front(), 0.0},
        [&](Pair& pair, std::size_t fine, double fraction) -> EndReadings {
            const double torque_Nm = torque.at(fine, fraction).value;
            const MotionBetweenSamples::Point hand_now = hand.at(fine, fraction);
            pair.motor.step(torque_Nm, pair.motor_pull_Nm());
            pair.load.step(hand_now, pair.load_pull_Nm());
            return {torque_Nm, pair.motor.rotor_rad(), hand_now.value, pair.load.torque_Nm()};
        });
}

// A servo turns the motor, a load motor resists: a drive between two shafts.
TrueRun run_drive(const TrialBench& bench, const TrialRun& run, const TrueEffects& effects,
                  const LumpedBenchOptions& options) {
    const MotionBetweenSamples input(run.motor_angle_rad, fine_rate_Hz);
    const MotionBetweenSamples resisting(run.load_torque_Nm, fine_rate_Hz);
    return run_between_pulleys(
        bench, run, effects, options, run.motor_angle_rad.size(), {0.0, 0.0, 0.0, run.load_torque_Nm.front()},
        [&](Pair& pair, std::size_t fine, double fraction) -> EndReadings {
            const MotionBetweenSamples::Point rotor = input.at(fine, fraction);
            const double load_Nm = resisting.at(fine, fraction).value;
            const double motor_Nm = pair.motor.step_prescribed(rotor, pair.motor_pull_Nm());
            pair.load.step_against(load_Nm, pair.load_pull_Nm());
            return {motor_Nm, pair.motor.rotor_rad(), pair.load.pulley_rad(), load_Nm};
        });
}

TrueRun run_single(const TrialBench& bench, const TrialRun& run, const TrueEffects& effects,
                   const LumpedBenchOptions& options) {
    const LumpedCableNumbers numbers = cable_numbers(bench, run, effects, options);
    const int steps = steps_per_fine_sample(numbers, options.masses);
    LumpedCable cable(numbers, effects, options.masses, 1.0 / (fine_rate_Hz * steps));
    const MotionBetweenSamples input(run.motor_angle_rad, fine_rate_Hz);
    const double motor_radius_m = bench.nominal.motor_radius_m;
    const double load_radius_m = bench.nominal.load_radius_m;
    MotorSide motor(0.0, effects, 1.0 / (fine_rate_Hz * steps));

    TrueRun result;
    result.values.resize(bench.channels().size());
    FineSample sample(bench, result);
    sample.add(motor_radius_m * numbers.pretension_N, run.motor_angle_rad.front(), 0.0,
               load_radius_m * numbers.pretension_N, cable, nullptr);
    sample.finish(1);
    for (std::size_t fine = 0; fine + 1 < run.motor_angle_rad.size(); ++fine) {
        for (int step = 1; step <= steps; ++step) {
            const MotionBetweenSamples::Point now = input.at(fine, static_cast<double>(step) / steps);
            cable.step({-motor_radius_m * now.value, -motor_radius_m * now.speed, 0.0, 0.0});
            sample.add(motor.step_prescribed(now, motor_radius_m * cable.motor_tension_N()), now.value, 0.0,
                       load_radius_m * cable.load_tension_N(), cable, nullptr);
        }
        sample.finish(steps);
        cable.follow(0.0, run.session_start_s + static_cast<double>(fine + 1) / fine_rate_Hz,
                     1.0 / fine_rate_Hz);
    }
    return result;
}

}  // namespace

TrueRun run_lumped_bench(const TrialBench& bench, const TrialRun& run, const TrueEffects& effects,
                         const LumpedBenchOptions& options) {
    const TrueEffects now = effects.under(run.conditions);
    TrueRun result = bench.is_drive()  ? run_drive(bench, run, now, options)
                     : bench.is_pair() ? run_pair(bench, run, now, options)
                                       : run_single(bench, run, now, options);
    result.conditions = run.conditions;
    return result;
}

}  // namespace capstan::gap_trial
