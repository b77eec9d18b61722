#include "capstan/solver/bench_simulation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "capstan/cable/invalid_input.h"

namespace capstan {

namespace {

// Stiffness of contact once a backlash is closed: far above any cable's.
constexpr double contact_Nm_per_rad = 5e3;
// Bristles of a pulley's bearing: as the cable's, at a radius of some centimetres.
constexpr double bearing_presliding_rad = 1e-4;
constexpr double bearing_speed_rad_per_s = 0.01;
constexpr double move_tolerance_m = 1e-9;
// A free pulley turns no further than this in one iteration.
constexpr double most_motor_turn_rad = 0.2;
constexpr double most_load_turn_rad = 0.02;
constexpr int most_iterations = 60;
constexpr int iterations_at_full_step = 15;

// Wrap angle of the cable that each node stands for: half of each segment beside it.
std::vector<double> node_wrap_rad(const Cable& cable) {
    std::vector<double> wrap(static_cast<std::size_t>(cable.nodes()), 0.0);
    for (std::size_t segment = 0; segment < cable.wrap_angle_rad().size(); ++segment) {
        wrap[segment] += 0.5 * cable.wrap_angle_rad()[segment];
        wrap[segment + 1] += 0.5 * cable.wrap_angle_rad()[segment];
    }
    return wrap;
}

// Spreads an angle over the nodes whose cable lies in a stretch.
void add_bend(const Cable& cable, const Stretch& stretch, double angle_rad, std::vector<double>& nodes) {
    const double half_m = 0.5 * cable.segment_length_m();
    for (int node = 0; node < cable.nodes(); ++node) {
        const double middle_m = cable.node_position_m(node);
        nodes[static_cast<std::size_t>(node)] +=
            angle_rad * stretch.share_within(middle_m - half_m, middle_m + half_m);
    }
}

std::vector<double> wrap_of(const Cable& cable, const LocalBend& bend, BentCables not_bent) {
    std::vector<double> wrap = node_wrap_rad(cable);
    if (bend.cables != not_bent) add_bend(cable, bend.stretch, bend.extra_angle_rad, wrap);
    return wrap;
}

// Torque through a joint with lost motion, for an angle across it.
double beyond_gap_rad(double angle_rad, double half_gap_rad) {
    return angle_rad > half_gap_rad    ? angle_rad - half_gap_rad
           : angle_rad < -half_gap_rad ? angle_rad + half_gap_rad
                                       : 0.0;
}

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
    if (!(inputs.time_step_s > 0.0)) problems.push_back("the time step is not positive");
    if (!pull_pull && !std::holds_alternative<LoadAngle>(inputs.load))
        problems.push_back("a single cable's load end is held: prescribe a load angle");
    if (!problems.empty()) throw InvalidInput(problems);
}

}  // namespace

BenchSimulation::BenchSimulation(const BenchDescription& description, const BenchEffects& effects)
    : description_(description), effects_(effects) {
    effects_.inertia.motor_kg_m2 += description_.inertia.motor_kg_m2;
    effects_.inertia.load_kg_m2 += description_.inertia.load_kg_m2;
    const Cable& cable = description_.cable;
    equations_.reserve(2);  // they refer to effects_
    equations_.emplace_back(cable, wrap_of(cable, effects_.local_bend, BentCables::only_b), effects_);
    cables_[0] = equations_[0].at_rest(cable.pretension_N());
    if (description_.has_second_cable) {
        equations_.emplace_back(cable, wrap_of(cable, effects_.local_bend, BentCables::only_a), effects_);
        cables_[1] = equations_[1].at_rest(cable.pretension_N());
    }
    if (effects_.moving_bend.extra_angle_per_load_angle != 0.0) {
        wrap_per_load_angle_.assign(static_cast<std::size_t>(cable.nodes()), 0.0);
        add_bend(cable, effects_.moving_bend.stretch, effects_.moving_bend.extra_angle_per_load_angle,
                 wrap_per_load_angle_);
    }
    if (!description_.has_second_cable) {
        motor_.torque_Nm = description_.pulleys.motor_radius_m * cable.pretension_N();
        load_.torque_Nm = description_.pulleys.load_radius_m * cable.pretension_N();
    }
}

bool BenchSimulation::motor_is_free(const BenchInputs& inputs) const {
    return std::holds_alternative<MotorTorque>(inputs.motor) || effects_.motor_backlash.half_gap_rad > 0.0;
}

bool BenchSimulation::load_is_free(const BenchInputs& inputs) const {
    return !std::holds_alternative<LoadAngle>(inputs.load) || effects_.load_backlash.half_gap_rad > 0.0 ||
           effects_.environment_coupling.compliance_rad_per_Nm > 0.0;
}

// Inside a gap only inertia holds a load pulley whose cables slide.
double BenchSimulation::load_inertia_kg_m2(const BenchInputs& inputs) const {
    constexpr double least_kg_m2 = 1e-5;
    return load_is_free(inputs) ? std::max(least_kg_m2, effects_.inertia.load_kg_m2)
                                : effects_.inertia.load_kg_m2;
}

void BenchSimulation::begin_cables(const BenchInputs& inputs) {
    if (!wrap_per_load_angle_.empty()) {
        const auto* given = std::get_if<LoadAngle>(&inputs.load);
        const double angle_rad = given != nullptr ? given->angle_rad : load_.angle_rad;
        added_wrap_rad_.resize(wrap_per_load_angle_.size());
        for (std::size_t node = 0; node < added_wrap_rad_.size(); ++node)
            added_wrap_rad_[node] = angle_rad * wrap_per_load_angle_[node];
    }
    for (std::size_t cable = 0; cable < equations_.size(); ++cable)
        equations_[cable].begin(cables_[cable], added_wrap_rad_, inputs.time_step_s);
}

// Positive angles: the motor pulley reels cable A in and lets B out, the load pulley goes where A pulls
// (E15). The motor end's rest follows the pretension (E33).
BenchSimulation::Pull BenchSimulation::linearise_cables(double motor_rad, double load_rad,
                                                        double session_time_s) {
    const double pretension_N =
        description_.cable.pretension_N() * effects_.pretension_drift.ratio(session_time_s);
    const ConduitCompliance& conduit = effects_.conduit_compliance;
    const double rest_m =
        equations_.front().rest_displacement_m(pretension_N) - conduit.motor_m_per_N * pretension_N;
    Pull pull;
    double way = -1.0;
    for (BenchCableEquations& equations : equations_) {
        const double motor_m_per_rad = way * description_.pulleys.motor_radius_m;
        const double load_m_per_rad = way * description_.pulleys.load_radius_m;
        const BenchCableEquations::Ends ends = equations.linearise(
            {rest_m + motor_m_per_rad * motor_rad, motor_m_per_rad, conduit.motor_m_per_N},
            {load_m_per_rad * load_rad, load_m_per_rad, conduit.load_m_per_N});
        for (auto [sum, end] : {std::pair{&pull.motor, &ends.motor}, std::pair{&pull.load, &ends.load}}) {
            sum->value_N -= way * end->value_N;
            sum->per_motor_rad -= way * end->per_motor_rad;
            sum->per_load_rad -= way * end->per_load_rad;
        }
        way = 1.0;
    }
    return pull;
}

// What a pulley's bearing and inertia take at this angle (E27, E35).
BenchSimulation::Torque BenchSimulation::losses(const Pulley& pulley, Bearing bearing,
                                                const PulleyFriction& friction, double inertia_kg_m2,
                                                double angle_rad, double time_step_s) {
    const double turned_rad = angle_rad - pulley.angle_rad;
    const double speed = turned_rad / time_step_s;
    Bristle sign;  // of the motion, and how it goes with the angle
    switch (bearing) {
        case Bearing::finds_its_angle:
            sign = Presliding{bearing_presliding_rad, 0.0}.after(pulley.bristle, turned_rad);
            break;
        case Bearing::is_turned:
            sign.bend = std::tanh(speed / bearing_speed_rad_per_s);
            sign.bend_per_m = (1.0 - sign.bend * sign.bend) / (bearing_speed_rad_per_s * time_step_s);
            break;
    }
    return {friction.coulomb_Nm * sign.bend + friction.viscous_Nm_s * speed +
                inertia_kg_m2 * (speed - pulley.speed_rad_per_s) / time_step_s,
            friction.coulomb_Nm * sign.bend_per_m + friction.viscous_Nm_s / time_step_s +
                inertia_kg_m2 / (time_step_s * time_step_s)};
}

// A pulley whose angle is prescribed cannot creep, and its encoder knows little of the first tenth of a
// milliradian.
BenchSimulation::Bearing BenchSimulation::bearing_of(bool free) {
    return free ? Bearing::finds_its_angle : Bearing::is_turned;
}

// What the motor must give beyond the cables' pull (E27, E28, E35), less what it gives.
BenchSimulation::Torque BenchSimulation::motor_balance(const BenchInputs& inputs, double angle_rad) const {
    const Torque lost = losses(motor_, bearing_of(motor_is_free(inputs)), effects_.motor_friction,
                               effects_.inertia.motor_kg_m2, angle_rad, inputs.time_step_s);
    Torque balance = {lost.value_Nm + effects_.motor_cogging.torque_Nm(angle_rad),
                      lost.per_rad + effects_.motor_cogging.slope_Nm_per_rad(angle_rad)};
    if (const auto* torque = std::get_if<MotorTorque>(&inputs.motor)) {
        balance.value_Nm -= torque->torque_Nm;
    } else if (motor_is_free(inputs)) {
        const double across = beyond_gap_rad(std::get<MotorAngle>(inputs.motor).angle_rad - angle_rad,
                                             effects_.motor_backlash.half_gap_rad);
        balance.value_Nm -= contact_Nm_per_rad * across;
        balance.per_rad += across == 0.0 ? 0.0 : contact_Nm_per_rad;
    }
    return balance;
}

// What holds the load pulley takes (E17, E29, E34).
BenchSimulation::Torque BenchSimulation::held_by(const BenchInputs& inputs, double angle_rad) const {
    if (const auto* torque = std::get_if<LoadTorque>(&inputs.load)) return {torque->torque_Nm, 0.0};
    if (const auto* spring = std::get_if<LoadSpring>(&inputs.load)) {
        return {spring->stiffness_Nm_per_rad * (angle_rad - spring->wall_angle_rad),
                spring->stiffness_Nm_per_rad};
    }
    const double held_rad = std::get<LoadAngle>(inputs.load).angle_rad;
    const EnvironmentCoupling& coupling = effects_.environment_coupling;
    const double stiffness = 1.0 / (coupling.compliance_rad_per_Nm + 1.0 / contact_Nm_per_rad);
    const double across = beyond_gap_rad(angle_rad - held_rad, effects_.load_backlash.half_gap_rad);
    const double damping = coupling.damping_Nm_s_per_rad / inputs.time_step_s;
    const double spread_rad = (angle_rad - load_.angle_rad) - (held_rad - load_.encoder_rad);
    return {stiffness * across + damping * spread_rad, (across == 0.0 ? 0.0 : stiffness) + damping};
}

// What the load pulley passes on of the cables' pull: all but its losses, less what is taken.
BenchSimulation::Torque BenchSimulation::load_balance(const BenchInputs& inputs, double angle_rad) const {
    const Torque lost = losses(load_, bearing_of(load_is_free(inputs)), effects_.load_friction,
                               load_inertia_kg_m2(inputs), angle_rad, inputs.time_step_s);
    if (!load_is_free(inputs)) return {-lost.value_Nm, -lost.per_rad};
    const Torque taken = held_by(inputs, angle_rad);
    return {-lost.value_Nm - taken.value_Nm, -lost.per_rad - taken.per_rad};
}

// Newton's method on all nodes and the free pulleys, from the cables' present guess.
bool BenchSimulation::iterate(const BenchInputs& inputs, const Free& free, Angles& angles, int& iterations) {
    for (int iteration = 1; iteration <= most_iterations; ++iteration) {
        ++iterations;
        // A front can send Newton's method to and fro; shorter steps end that.
        double share = iteration <= iterations_at_full_step ? 1.0 : 0.5;
        const Pull pull = linearise_cables(angles.motor_rad, angles.load_rad, inputs.session_time_s);
        const Torque motor = motor_balance(inputs, angles.motor_rad);
        const Torque load = load_balance(inputs, angles.load_rad);
        // A pulley that is not free does not turn further.
        const double r_m = description_.pulleys.motor_radius_m;
        const double r_l = description_.pulleys.load_radius_m;
        const double motor_error = free.motor ? r_m * pull.motor.value_N + motor.value_Nm : 0.0;
        const double load_error = free.load ? r_l * pull.load.value_N + load.value_Nm : 0.0;
        const double mm = free.motor ? r_m * pull.motor.per_motor_rad + motor.per_rad : 1.0;
        const double ml = free.motor && free.load ? r_m * pull.motor.per_load_rad : 0.0;
        const double lm = free.motor && free.load ? r_l * pull.load.per_motor_rad : 0.0;
        const double ll = free.load ? r_l * pull.load.per_load_rad + load.per_rad : 1.0;
        const double determinant = mm * ll - ml * lm;
        const double motor_turn = -(motor_error * ll - load_error * ml) / determinant;
        const double load_turn = -(load_error * mm - motor_error * lm) / determinant;
        const double farthest =
            std::max(std::abs(motor_turn) / most_motor_turn_rad, std::abs(load_turn) / most_load_turn_rad);
        if (share * farthest > 1.0) share = 1.0 / farthest;
        double largest_m = 0.0;
        for (BenchCableEquations& equations : equations_)
            largest_m = std::max(largest_m, equations.move(motor_turn, load_turn, share));
        angles.motor_rad += share * motor_turn;
        angles.load_rad += share * load_turn;
        if (largest_m < move_tolerance_m) return true;
        if (!std::isfinite(largest_m)) return false;
    }
    return false;
}

// Where contact opens and closes Newton's method can go to and fro. The torque left on the load pulley falls
// as it turns, so its angle is bracketed and the bracket closed (Illinois), all else solved for each.
bool BenchSimulation::bracket_load(const BenchInputs& inputs, const Free& free, Angles& angles,
                                   int& iterations) {
    constexpr double first_width_rad = 0.005;
    constexpr double angle_tolerance_rad = 1e-9;
    constexpr double balanced_Nm = 1e-7;
    constexpr int most_trials = 60;
    const auto torque_left = [&](double load_rad) {
        begin_cables(inputs);
        angles = {free.motor ? motor_.angle_rad : angles.motor_rad, load_rad};
        iterate(inputs, {free.motor, false}, angles, iterations);
        const Pull pull = linearise_cables(angles.motor_rad, load_rad, inputs.session_time_s);
        return description_.pulleys.load_radius_m * pull.load.value_N +
               load_balance(inputs, load_rad).value_Nm;
    };
    double low = load_.angle_rad;
    double at_low = torque_left(low);
    double width = at_low > 0.0 ? first_width_rad : -first_width_rad;
    double high = low + width;
    double at_high = torque_left(high);
    for (int trial = 0; at_low * at_high > 0.0; ++trial) {
        if (trial == most_trials || !std::isfinite(at_high)) return false;
        low = high;
        at_low = at_high;
        width *= 1.6;
        high += width;
        at_high = torque_left(high);
    }
    for (int trial = 0; trial < most_trials; ++trial) {
        const double middle =
            at_low == at_high ? 0.5 * (low + high) : low + (high - low) * at_low / (at_low - at_high);
        const double at_middle = torque_left(middle);
        if (std::abs(at_middle) < balanced_Nm || std::abs(high - low) < angle_tolerance_rad)
            return true;
        if (at_middle * at_high < 0.0) {
            low = high;
            at_low = at_high;
        } else {
            at_low *= 0.5;
        }
        high = middle;
        at_high = at_middle;
    }
    return false;
}

BenchReport BenchSimulation::advance(const BenchInputs& inputs) {
    demand_motion(inputs, description_.has_second_cable);
    const Free free{motor_is_free(inputs), load_is_free(inputs)};
    const Angles start{free.motor ? motor_.angle_rad : std::get<MotorAngle>(inputs.motor).angle_rad,
                       free.load ? load_.angle_rad : std::get<LoadAngle>(inputs.load).angle_rad};
    BenchReport report;
    Angles angles = start;
    begin_cables(inputs);
    report.converged = iterate(inputs, free, angles, report.iterations);
    if (!report.converged && free.load) {
        angles = start;
        report.converged = bracket_load(inputs, free, angles, report.iterations);
    }
    settle(inputs, angles.motor_rad, angles.load_rad);
    return report;
}

void BenchSimulation::turn(Pulley& pulley, double angle_rad, double time_step_s) {
    const double turned_rad = angle_rad - pulley.angle_rad;
    pulley.bristle = Presliding{bearing_presliding_rad, 0.0}.after(pulley.bristle, turned_rad).bend;
    pulley.speed_rad_per_s = turned_rad / time_step_s;
    pulley.angle_rad = angle_rad;
}

// Remembers the step and reads the instruments.
void BenchSimulation::settle(const BenchInputs& inputs, double motor_rad, double load_rad) {
    double motor_pull_N = 0.0;
    double load_pull_N = 0.0;
    double way = 1.0;
    for (std::size_t cable = 0; cable < equations_.size(); ++cable) {
        equations_[cable].store(cables_[cable]);
        motor_pull_N += way * cables_[cable].motor_tension_N;
        load_pull_N += way * cables_[cable].load_tension_N;
        way = -1.0;
    }
    if (const auto* torque = std::get_if<MotorTorque>(&inputs.motor)) {
        // The motor stands on the side of the gap that its torque leans on; without torque it stays.
        constexpr double leaning_Nm = 1e-3;
        const double gap_rad = effects_.motor_backlash.half_gap_rad;
        const double stands_rad = motor_.encoder_rad - motor_rad;
        const double leans_rad = gap_rad * std::clamp(torque->torque_Nm / leaning_Nm, -1.0, 1.0);
        motor_.torque_Nm = torque->torque_Nm;
        motor_.encoder_rad =
            motor_rad + (std::abs(torque->torque_Nm) < leaning_Nm ? std::clamp(stands_rad, -gap_rad, gap_rad)
                                                                  : leans_rad);
    } else {
        motor_.torque_Nm = description_.pulleys.motor_radius_m * motor_pull_N +
                           losses(motor_, bearing_of(motor_is_free(inputs)), effects_.motor_friction,
                                  effects_.inertia.motor_kg_m2, motor_rad, inputs.time_step_s)
                               .value_Nm +
                           effects_.motor_cogging.torque_Nm(motor_rad);
        motor_.encoder_rad = std::get<MotorAngle>(inputs.motor).angle_rad;
    }
    const Torque lost = losses(load_, bearing_of(load_is_free(inputs)), effects_.load_friction,
                               load_inertia_kg_m2(inputs), load_rad, inputs.time_step_s);
    const auto* held = std::get_if<LoadAngle>(&inputs.load);
    load_.torque_Nm = load_is_free(inputs) ? held_by(inputs, load_rad).value_Nm
                                           : description_.pulleys.load_radius_m * load_pull_N - lost.value_Nm;
    load_.encoder_rad = held != nullptr ? held->angle_rad : load_rad;
    turn(motor_, motor_rad, inputs.time_step_s);
    turn(load_, load_rad, inputs.time_step_s);
}

double BenchSimulation::tension_at_N(const BenchCable& cable, double position_m) const {
    const double segments = static_cast<double>(cable.tension_N.size());
    const double place =
        std::clamp(position_m / description_.cable.segment_length_m() - 0.5, 0.0, segments - 1.0);
    const std::size_t segment = std::min(static_cast<std::size_t>(place), cable.tension_N.size() - 2);
    const double fraction = place - static_cast<double>(segment);
    return (1.0 - fraction) * cable.tension_N[segment] + fraction * cable.tension_N[segment + 1];
}

}  // namespace capstan
