#include "capstan/rig/bench_simulation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/pull_pull.h"

namespace capstan {

namespace {

constexpr double move_tolerance_m = 1e-9;
// Newton's method converges quadratically: after moves of a and b the next one is about b^3 / a^2. After a
// small move, a next one below the last number is not made.
constexpr double small_move_m = 1e-7;
constexpr double negligible_move_m = 1e-10;
// A free pulley turns no further than this in one iteration.
constexpr double max_motor_turn_rad = 0.2;
constexpr double max_load_turn_rad = 0.02;
// A front can send Newton's method to and fro. Shorter steps end that, and complete ones then converge.
constexpr double step_fractions[] = {1.0, 0.5, 0.25, 0.125, 1.0};
constexpr int iterations_with_each = 15;
constexpr int max_iterations = iterations_with_each * static_cast<int>(std::size(step_fractions));

void demand_motion(const BenchInputs& inputs, bool pull_pull) {
    std::vector<std::string> problems;
    const auto demand_finite = [&](double value, const char* what) {
        if (!std::isfinite(value)) problems.push_back(std::string("the ") + what + " is not a finite number");
    };
    if (const auto* torque = std::get_if<MotorTorque>(&inputs.motor)) {
        demand_finite(torque->torque_Nm, "motor torque");
    } else {
        demand_finite(std::get<MotorAngle>(inputs.motor).angle_rad, "motor angle");
    }
    if (const auto* angle = std::get_if<LoadAngle>(&inputs.load)) {
        demand_finite(angle->angle_rad, "load angle");
    } else if (const auto* torque = std::get_if<LoadTorque>(&inputs.load)) {
        demand_finite(torque->torque_Nm, "load torque");
        if (std::holds_alternative<MotorTorque>(inputs.motor))
            problems.push_back("a torque is prescribed at both pulleys, so the angles are undetermined");
    } else {
        const LoadSpring& spring = std::get<LoadSpring>(inputs.load);
        demand_finite(spring.wall_angle_rad, "wall angle");
        if (!(spring.stiffness_Nm_per_rad > 0.0))
            problems.push_back("the load spring's stiffness is not positive");
    }
    demand_finite(inputs.motor_rad_per_s2.value_or(0.0), "motor's acceleration");
    demand_finite(inputs.load_rad_per_s2.value_or(0.0), "load's acceleration");
    if (!(inputs.time_step_s > 0.0)) problems.push_back("the time step is not positive");
    if (!pull_pull && !std::holds_alternative<LoadAngle>(inputs.load))
        problems.push_back("a single cable's load end is held: prescribe a load angle");
    if (!problems.empty()) throw InvalidInput(problems);
}

template <class Part>
std::vector<Part> each_of(std::span<const BenchDescription> descriptions, Part BenchDescription::*part) {
    std::vector<Part> parts;
    for (const BenchDescription& each : descriptions) parts.push_back(each.*part);
    return parts;
}

bool any(const LaneFlags& flags) {
    return std::find(std::begin(flags.of), std::end(flags.of), true) != std::end(flags.of);
}

}  // namespace

BenchSimulations::BenchSimulations(std::span<const BenchDescription> descriptions,
                                   std::span<const BenchEffects> effects)
    : count_(static_cast<int>(descriptions.size())),
      effects_(effects.begin(), effects.end()),
      cables_(each_of(descriptions, &BenchDescription::cable),
              each_of(descriptions, &BenchDescription::cable_loss_s), effects,
              each_of(descriptions, &BenchDescription::ends), descriptions.front().arrangement) {
    for (std::size_t bench = 0; bench < descriptions.size(); ++bench) {
        const double pretension_N = descriptions[bench].cable.pretension_N();
        radii_.push_back(checked(descriptions[bench].pulleys));
        pulleys_.emplace_back(radii_[bench], effects_[bench], descriptions[bench].inertia,
                              descriptions[bench].zeros);
        if (cables_.count() == 1)
            pulleys_.back().rest(radii_[bench].motor_radius_m * pretension_N,
                                 radii_[bench].load_radius_m * pretension_N);
        motor_rest_m_.push_back(cables_.rest_displacement_m(static_cast<int>(bench)) -
                                effects_[bench].of<ConduitCompliance>().motor_m_per_N * pretension_N);
        reels_.push_back(
            {0.0, 0.0,
             radii_[bench].motor_radius_m * effects_[bench].of<EccentricPulley>().radius_ratio(0.0)});
    }
    // Lanes without a bench of their own carry the first one's along.
    for (int lane = 0; lane < bench_lanes; ++lane) {
        const auto bench = static_cast<std::size_t>(lane < count_ ? lane : 0);
        const ConduitCompliance& conduit = effects_[bench].of<ConduitCompliance>();
        double way = -1.0;
        for (int cable = 0; cable < cables_.count(); ++cable, way = 1.0) {
            motor_places_[cable].compliance_m_per_N.of[lane] = conduit.motor_m_per_N;
            load_places_[cable].per_rad.of[lane] = way * radii_[bench].load_radius_m;
            load_places_[cable].compliance_m_per_N.of[lane] = conduit.load_m_per_N;
        }
    }
}

void BenchSimulations::begin(EachInputs inputs, const LaneFlags& active) {
    CablesMoment moment;
    LaneValues time_step_s;
    std::fill(std::begin(time_step_s.of), std::end(time_step_s.of), inputs.front().time_step_s);
    for (int lane = 0; lane < count_; ++lane) {
        const BenchInputs& its = inputs[static_cast<std::size_t>(lane)];
        const auto* given = std::get_if<LoadAngle>(&its.load);
        moment.load_angle_rad.of[lane] =
            given != nullptr ? given->angle_rad : pulleys(lane).angles().load_rad;
        moment.session_time_s.of[lane] = its.session_time_s;
        const PretensionDrift& drift = effects_[static_cast<std::size_t>(lane)].of<PretensionDrift>();
        if (drift.lost_by_100_s != 0.0)
            moment.settled_m.of[lane] = cables_.settled_m(lane, drift.ratio(its.session_time_s));
        time_step_s.of[lane] = its.time_step_s;
    }
    cables_.begin(active, moment, time_step_s);
}

// Where the cables leave the motor pulley (E59).
const BenchSimulations::Reel& BenchSimulations::reel(std::size_t bench, double motor_rad) {
    Reel& last = reels_[bench];
    if (last.angle_rad != motor_rad) {
        const EccentricPulley& shape = effects_[bench].of<EccentricPulley>();
        const double r_m = radii_[bench].motor_radius_m;
        last = {motor_rad, r_m * shape.reeled_rad(motor_rad), r_m * shape.radius_ratio(motor_rad)};
    }
    return last;
}

// Positive angles: the motor pulley reels cable A in and lets B out, the load pulley goes where A pulls
// (E15).
BenchSimulations::Pull BenchSimulations::linearise(const LaneFlags& active, const EachAngles& angles) {
    for (int lane = 0; lane < count_; ++lane) {
        if (!active.of[lane]) continue;
        const auto bench = static_cast<std::size_t>(lane);
        const Reel& motor_reel = reel(bench, angles[bench].motor_rad);
        double way = -1.0;
        for (int cable = 0; cable < cables_.count(); ++cable, way = 1.0) {
            motor_places_[cable].at_m.of[lane] = motor_rest_m_[bench] + way * motor_reel.reeled_m;
            motor_places_[cable].per_rad.of[lane] = way * motor_reel.radius_m;
            load_places_[cable].at_m.of[lane] = load_places_[cable].per_rad.of[lane] * angles[bench].load_rad;
        }
    }
    const BenchCables::Ends ends = cables_.linearise(active, motor_places_, load_places_);
    Pull pull;
    double way = -1.0;
    for (int cable = 0; cable < cables_.count(); ++cable, way = 1.0) {
        for (auto [sum, end] :
             {std::pair{&pull.motor, &ends.motor[cable]}, std::pair{&pull.load, &ends.load[cable]}}) {
            for (int lane = 0; lane < bench_lanes; ++lane) {
                sum->value_N.of[lane] -= way * end->value_N.of[lane];
                sum->per_motor_rad.of[lane] -= way * end->per_motor_rad.of[lane];
                sum->per_load_rad.of[lane] -= way * end->per_load_rad.of[lane];
            }
        }
    }
    return pull;
}

// Newton's method on all nodes and the free pulleys of the active benches, from the cables' present guess.
void BenchSimulations::iterate(EachInputs inputs, const Free& free, LaneFlags active, EachAngles& angles,
                               EachReport& reports) {
    cables_.set_free({.motor = any(free.motor), .load = any(free.load)});
    LaneValues last_m;  // the move before; none before the first, which therefore predicts nothing
    std::fill(std::begin(last_m.of), std::end(last_m.of), std::numeric_limits<double>::quiet_NaN());
    for (int iteration = 1; iteration <= max_iterations && any(active); ++iteration) {
        const Pull pull = linearise(active, angles);
        LaneValues motor_turn;
        LaneValues load_turn;
        LaneValues fractions;
        for (int lane = 0; lane < count_; ++lane) {
            if (!active.of[lane]) continue;
            const auto bench = static_cast<std::size_t>(lane);
            const double r_l = radii_[bench].load_radius_m;
            ++reports[bench].iterations;
            double fraction = step_fractions[(iteration - 1) / iterations_with_each];
            // A pulley that is not free does not turn further.
            const bool motor_turns = free.motor.of[lane];
            const bool load_turns = free.load.of[lane];
            double motor_error = 0.0;
            double load_error = 0.0;
            double mm = 1.0;
            double ml = 0.0;
            double lm = 0.0;
            double ll = 1.0;
            if (motor_turns) {
                const double at_rad = angles[bench].motor_rad;
                const double r_m = reel(bench, at_rad).radius_m;
                const double r_m_per_rad = radii_[bench].motor_radius_m *
                                           effects_[bench].of<EccentricPulley>().radius_ratio_per_rad(at_rad);
                const PulleyTorque motor =
                    pulleys_[bench].motor_balance(inputs[bench], at_rad, r_m * pull.motor.value_N.of[lane]);
                motor_error = motor.value_Nm;
                mm = motor.per_pull * (r_m * pull.motor.per_motor_rad.of[lane] +
                                       r_m_per_rad * pull.motor.value_N.of[lane]) +
                     motor.per_rad;
                if (load_turns) ml = motor.per_pull * r_m * pull.motor.per_load_rad.of[lane];
            }
            if (load_turns) {
                const PulleyTorque load = pulleys_[bench].load_balance(inputs[bench], angles[bench].load_rad,
                                                                       r_l * pull.load.value_N.of[lane]);
                load_error = load.value_Nm;
                ll = load.per_pull * r_l * pull.load.per_load_rad.of[lane] + load.per_rad;
                if (motor_turns) lm = load.per_pull * r_l * pull.load.per_motor_rad.of[lane];
            }
            const double determinant = mm * ll - ml * lm;
            motor_turn.of[lane] = -(motor_error * ll - load_error * ml) / determinant;
            load_turn.of[lane] = -(load_error * mm - motor_error * lm) / determinant;
            const double farthest = std::max(std::abs(motor_turn.of[lane]) / max_motor_turn_rad,
                                             std::abs(load_turn.of[lane]) / max_load_turn_rad);
            if (fraction * farthest > 1.0) fraction = 1.0 / farthest;
            fractions.of[lane] = fraction;
            angles[bench].motor_rad += fraction * motor_turn.of[lane];
            angles[bench].load_rad += fraction * load_turn.of[lane];
        }
        const LaneValues largest_m = cables_.move(active, motor_turn, load_turn, fractions);
        for (int lane = 0; lane < count_; ++lane) {
            if (!active.of[lane]) continue;
            const double moved_m = largest_m.of[lane];
            const double ratio = moved_m / last_m.of[lane];
            const bool converged = moved_m < move_tolerance_m ||
                                   (moved_m < small_move_m && moved_m * ratio * ratio < negligible_move_m);
            reports[static_cast<std::size_t>(lane)].converged = converged;
            active.of[lane] = std::isfinite(moved_m) && !converged;
            last_m.of[lane] = moved_m;
        }
    }
}

// One bench alone, its pulleys beginning there.
void BenchSimulations::solve(EachInputs inputs, const Free& free, int lane, PulleyAngles from,
                             EachAngles& angles, EachReport& reports) {
    LaneFlags only;
    only.of[lane] = true;
    begin(inputs, only);
    angles[static_cast<std::size_t>(lane)] = from;
    iterate(inputs, free, only, angles, reports);
    if (!reports[static_cast<std::size_t>(lane)].converged)
        bracket(inputs, free, lane, from, angles, reports);
}

// Where contact opens and closes, or a cable falls slack, Newton's method can go to and fro. The torque left
// on a free pulley falls as it turns, so its angle is bracketed and the bracket closed (Illinois), all else
// solved for each: the load pulley's first, the motor's within.
void BenchSimulations::bracket(EachInputs inputs, const Free& free, int lane, PulleyAngles from,
                               EachAngles& angles, EachReport& reports) {
    constexpr double first_load_width_rad = 0.005;
    constexpr double min_width_rad = 1e-6;
    constexpr double min_stiffness_Nm_per_rad = 1e-9;
    constexpr double beyond_promise = 1.1;
    constexpr double angle_tolerance_rad = 1e-9;
    constexpr double balanced_Nm = 1e-7;
    constexpr double nearly_balanced_Nm = 1e-4;  // where the torque left leaps from one angle to the next
    constexpr int max_trials = 60;
    const auto bench = static_cast<std::size_t>(lane);
    const bool of_load = free.load.of[lane];
    if (!of_load && !free.motor.of[lane]) return;
    LaneFlags only;
    only.of[lane] = true;
    Free held = free;
    (of_load ? held.load : held.motor).of[lane] = false;
    double best_rad = 0.0;
    double min_left_Nm = std::numeric_limits<double>::infinity();
    const auto radius_m = [&](double angle_rad) {
        return of_load ? radii_[bench].load_radius_m : reel(bench, angle_rad).radius_m;
    };
    const auto balance = [&](const Pull& pull, double angle_rad) {
        const BenchPulleys& pulleys = pulleys_[bench];
        const double pull_Nm =
            radius_m(angle_rad) * (of_load ? pull.load.value_N : pull.motor.value_N).of[lane];
        return of_load ? pulleys.load_balance(inputs[bench], angle_rad, pull_Nm)
                       : pulleys.motor_balance(inputs[bench], angle_rad, pull_Nm);
    };
    const auto torque_left = [&](double angle_rad) {
        (of_load ? from.load_rad : from.motor_rad) = angle_rad;
        solve(inputs, held, lane, from, angles, reports);
        const Pull pull = linearise(only, angles);
        const double left_Nm =
            of_load ? balance(pull, angle_rad).value_Nm : -balance(pull, angle_rad).value_Nm;
        if (std::abs(left_Nm) < min_left_Nm) {
            min_left_Nm = std::abs(left_Nm);
            best_rad = angle_rad;
        }
        return left_Nm;
    };
    const auto stiffness_Nm_per_rad = [&](double angle_rad) {
        const Pull pull = linearise(only, angles);
        const PulleyTorque torque = balance(pull, angle_rad);
        return std::abs(torque.per_pull * radius_m(angle_rad) *
                            (of_load ? pull.load.per_load_rad : pull.motor.per_motor_rad).of[lane] +
                        torque.per_rad);
    };
    const auto give_up = [&] {
        torque_left(best_rad);
        reports[bench].converged = false;
    };
    const double first_width_rad =
        of_load ? first_load_width_rad
                : first_load_width_rad * radii_[bench].load_radius_m / radii_[bench].motor_radius_m;
    double low = of_load ? from.load_rad : from.motor_rad;
    double at_low = torque_left(low);
    // What the stiffness there promises, and a little more.
    double width = std::clamp(
        beyond_promise * std::abs(at_low) / std::max(stiffness_Nm_per_rad(low), min_stiffness_Nm_per_rad),
        min_width_rad, first_width_rad);
    if (at_low < 0.0) width = -width;
    double high = low + width;
    double at_high = torque_left(high);
    for (int trial = 0; at_low * at_high > 0.0; ++trial) {
        if (trial == max_trials || !std::isfinite(at_high)) return give_up();
        low = high;
        at_low = at_high;
        width *= std::abs(width) < first_width_rad ? 4.0 : 1.6;
        high += width;
        at_high = torque_left(high);
    }
    for (int trial = 0; trial < max_trials; ++trial) {
        const double middle =
            at_low == at_high ? 0.5 * (low + high) : low + (high - low) * at_low / (at_low - at_high);
        const double at_middle = torque_left(middle);
        if (std::abs(at_middle) < balanced_Nm || std::abs(high - low) < angle_tolerance_rad) {
            // With what was solved for this angle: the nodes, and the other pulley's angle.
            reports[bench].converged = reports[bench].converged && std::abs(at_middle) < nearly_balanced_Nm;
            return;
        }
        if (at_middle * at_high < 0.0) {
            low = high;
            at_low = at_high;
        } else {
            at_low *= 0.5;
        }
        high = middle;
        at_high = at_middle;
    }
    give_up();
}

std::array<BenchReport, bench_lanes> BenchSimulations::advance(const BenchInputs& inputs) {
    std::array<BenchInputs, bench_lanes> alike;
    alike.fill(inputs);
    return advance(std::span(alike).first(static_cast<std::size_t>(count_)));
}

std::array<BenchReport, bench_lanes> BenchSimulations::advance(EachInputs inputs) {
    if (static_cast<int>(inputs.size()) != count_)
        throw InvalidInput({std::to_string(inputs.size()) + " sets of inputs for " + std::to_string(count_) +
                            " benches; give one to each"});
    for (const BenchInputs& each : inputs) demand_motion(each, cables_.count() == 2);
    EachReport reports;
    EachAngles angles;
    LaneFlags all;
    Free free;
    for (int lane = 0; lane < count_; ++lane) {
        const auto bench = static_cast<std::size_t>(lane);
        const BenchPulleys& pulleys = pulleys_[bench];
        all.of[lane] = !stopped_.of[lane];
        free.motor.of[lane] = pulleys.motor_is_free(inputs[bench]);
        free.load.of[lane] = pulleys.load_is_free(inputs[bench]);
        angles[bench] = pulleys.start(inputs[bench]);
    }
    begin(inputs, all);
    iterate(inputs, free, all, angles, reports);
    for (int lane = 0; lane < count_; ++lane) {
        const auto bench = static_cast<std::size_t>(lane);
        if (stopped_.of[lane]) {
            reports[bench].converged = false;
            angles[bench] = pulleys_[bench].angles();
        } else if (!reports[bench].converged) {
            bracket(inputs, free, lane, pulleys_[bench].start(inputs[bench]), angles, reports);
        }
    }
    cables_.store();
    for (int lane = 0; lane < count_; ++lane) {
        if (stopped_.of[lane]) continue;
        double motor_pull_N = 0.0;
        double load_pull_N = 0.0;
        double way = 1.0;
        for (int cable = 0; cable < cables_.count(); ++cable, way = -1.0) {
            motor_pull_N += way * cables_.motor_tension_N(cable, lane);
            load_pull_N += way * cables_.load_tension_N(cable, lane);
        }
        const auto bench = static_cast<std::size_t>(lane);
        pulleys_[bench].settle(inputs[bench], angles[bench], motor_pull_N, load_pull_N);
    }
    return reports;
}

}  // namespace capstan
