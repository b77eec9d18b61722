#include "capstan/solver/bench_cable.h"

#include <algorithm>
#include <cmath>

namespace capstan {

namespace {

// Bristles so stiff that the closed-form step's fronts come out, and so soft that Newton's method sees where
// a front goes: a front's own displacements are of this size.
constexpr double numerical_presliding_m = 3e-6;
// What a slack segment keeps of its stiffness, so that its nodes stay somewhere.
constexpr double slack_stiffness = 1e-9;

Presliding bristles_of(const Presliding& effect) {
    if (effect.length_m > numerical_presliding_m) return effect;
    return {numerical_presliding_m, 0.0};
}

}  // namespace

BenchCableEquations::BenchCableEquations(const Cable& cable, std::vector<double> wrap_angle_rad,
                                         const BenchEffects& effects)
    : effects_(effects),
      bristles_(bristles_of(effects.presliding)),
      axial_stiffness_N_(cable.axial_stiffness_N()),
      segment_m_(cable.segment_length_m()),
      dynamic_friction_(cable.dynamic_friction()),
      wrap_rad_(std::move(wrap_angle_rad)),
      node_span_m_(wrap_rad_.size(), segment_m_) {
    node_span_m_.front() = node_span_m_.back() = 0.5 * segment_m_;
    const std::size_t nodes = wrap_rad_.size();
    for (auto* per_node :
         {&displacement_m_, &friction_, &bend_, &bend_per_m_, &upper_, &value_, &by_motor_, &by_load_})
        per_node->resize(nodes);
    tension_N_.resize(nodes - 1);
    tension_per_m_.resize(nodes - 1);
}

// Of one segment long at rest under a tension.
double BenchCableEquations::crept_m(double pretension_N) const {
    return effects_.creep.ratio * segment_m_ * pretension_N / axial_stiffness_N_;
}

double BenchCableEquations::stretched_m(double pretension_N) const {
    return crept_m(pretension_N) +
           segment_m_ * effects_.nonlinear_stiffness.strain(pretension_N, axial_stiffness_N_);
}

double BenchCableEquations::rest_displacement_m(double pretension_N) const {
    return -effects_.conduit_compliance.load_m_per_N * pretension_N -
           static_cast<double>(tension_N_.size()) * stretched_m(pretension_N);
}

BenchCable BenchCableEquations::at_rest(double pretension_N) const {
    const std::size_t nodes = wrap_rad_.size();
    const double motor_end_m = rest_displacement_m(pretension_N);
    BenchCable cable;
    for (std::size_t node = 0; node < nodes; ++node)
        cable.displacement_m.push_back(motor_end_m + static_cast<double>(node) * stretched_m(pretension_N));
    cable.bristle.assign(nodes, 0.0);
    cable.lagging_speed_m_per_s.assign(nodes, 0.0);
    cable.creep_m.assign(nodes - 1, crept_m(pretension_N));
    cable.tension_N.assign(nodes - 1, pretension_N);
    cable.motor_tension_N = cable.load_tension_N = pretension_N;
    return cable;
}

void BenchCableEquations::begin(const BenchCable& before, const std::vector<double>& added_wrap_rad,
                                double time_step_s) {
    before_ = &before;
    time_step_s_ = time_step_s;
    displacement_m_ = before.displacement_m;
    tension_N_ = before.tension_N;  // where a stiffening cable's tension is sought from
    const std::size_t last = wrap_rad_.size() - 1;
    for (std::size_t node = 0; node <= last; ++node) {
        const double added_rad = added_wrap_rad.empty() ? 0.0 : added_wrap_rad[node];
        const double wrap_rad = std::max(0.0, wrap_rad_[node] + added_rad);
        double coefficient =
            dynamic_friction_ + effects_.stribeck.friction_added(before.lagging_speed_m_per_s[node]);
        if (effects_.load_dependent_friction.exponent != 1.0) {
            const double tension_N = 0.5 * (before.tension_N[std::min(node, last - 1)] +
                                            before.tension_N[node == 0 ? 0 : node - 1]);
            coefficient *= effects_.load_dependent_friction.factor(tension_N * wrap_rad / node_span_m_[node]);
        }
        friction_[node] = std::tanh(0.5 * coefficient * wrap_rad);
    }
}

// Creep at the end of the step, were the tension this (implicit Euler).
double BenchCableEquations::creep_m(std::size_t segment, double tension_N) const {
    const Creep& creep = effects_.creep;
    const double share = time_step_s_ / (creep.time_constant_s + time_step_s_);
    return before_->creep_m[segment] +
           share * (creep.ratio * segment_m_ * tension_N / axial_stiffness_N_ - before_->creep_m[segment]);
}

void BenchCableEquations::evaluate() {
    const NonlinearStiffness& toe = effects_.nonlinear_stiffness;
    const double linear_m_per_N = segment_m_ / axial_stiffness_N_;
    const bool creeps = effects_.creep.ratio > 0.0;
    const double creep_share =
        creeps ? effects_.creep.ratio * time_step_s_ / (effects_.creep.time_constant_s + time_step_s_) : 0.0;
    for (std::size_t segment = 0; segment < tension_N_.size(); ++segment) {
        double stretch_m = displacement_m_[segment + 1] - displacement_m_[segment];
        if (creeps) stretch_m -= creep_m(segment, 0.0);
        double per_N = linear_m_per_N * (1.0 + creep_share);
        double tension_N = stretch_m / per_N;
        if (toe.toe_strain > 0.0 && stretch_m > 0.0) {
            // Strain is concave in tension, so Newton from the left of the root stays there.
            tension_N = std::clamp(tension_N_[segment], 0.0, tension_N);
            for (int refinement = 0; refinement < 4; ++refinement) {
                const double there_m = segment_m_ * toe.strain(tension_N, axial_stiffness_N_) +
                                       creep_share * linear_m_per_N * tension_N;
                per_N = segment_m_ * toe.strain_per_N(tension_N, axial_stiffness_N_) +
                        creep_share * linear_m_per_N;
                tension_N = std::max(0.0, tension_N + (stretch_m - there_m) / per_N);
            }
        }
        const double kept = stretch_m > 0.0 ? 1.0 : slack_stiffness;
        tension_N_[segment] = kept * tension_N;
        tension_per_m_[segment] = kept / per_N;
    }
    for (std::size_t node = 0; node < bend_.size(); ++node) {
        const double slid_m = displacement_m_[node] - before_->displacement_m[node];
        const Bristle bristle = bristles_.after(before_->bristle[node], slid_m);
        bend_[node] = bristle.bend;
        bend_per_m_[node] = bristle.bend_per_m;
    }
}

// Beyond the end node's half segment: T = t (1 - q) / (1 + q) less the drags, q = z tanh(mu theta / 2).
BenchCableEquations::InnerEnd BenchCableEquations::motor_end() const {
    const double pressing_N = std::max(0.0, tension_N_.front());
    const double q = pressing_N > 0.0 ? friction_.front() * bend_.front() : 0.0;
    const double left = (1.0 - q) / (1.0 + q);
    const double rigid_N = effects_.bending_stiffness.drag_N_per_m * node_span_m_.front();
    const double viscous_N_per_m = effects_.viscous_friction.drag_N(node_span_m_.front(), 1.0 / time_step_s_);
    const double slid_m = displacement_m_.front() - before_->displacement_m.front();
    const double by_bend_N = 2.0 * friction_.front() * pressing_N / ((1.0 + q) * (1.0 + q)) + rigid_N;
    const double stiffness = tension_per_m_.front() * left;
    return {tension_N_.front() * left - rigid_N * bend_.front() - viscous_N_per_m * slid_m,
            -stiffness - by_bend_N * bend_per_m_.front() - viscous_N_per_m, stiffness};
}

BenchCableEquations::InnerEnd BenchCableEquations::load_end() const {
    const double pressing_N = std::max(0.0, tension_N_.back());
    const double q = pressing_N > 0.0 ? friction_.back() * bend_.back() : 0.0;
    const double grown = (1.0 + q) / (1.0 - q);
    const double rigid_N = effects_.bending_stiffness.drag_N_per_m * node_span_m_.back();
    const double viscous_N_per_m = effects_.viscous_friction.drag_N(node_span_m_.back(), 1.0 / time_step_s_);
    const double slid_m = displacement_m_.back() - before_->displacement_m.back();
    const double by_bend_N = 2.0 * friction_.back() * pressing_N / ((1.0 - q) * (1.0 - q)) + rigid_N;
    const double stiffness = tension_per_m_.back() * grown;
    return {tension_N_.back() * grown + rigid_N * bend_.back() + viscous_N_per_m * slid_m,
            stiffness + by_bend_N * bend_per_m_.back() + viscous_N_per_m, -stiffness};
}

BenchCableEquations::Ends BenchCableEquations::linearise(const EndPlace& motor, const EndPlace& load) {
    evaluate();
    const std::size_t last = displacement_m_.size() - 1;
    const InnerEnd at_motor = motor_end();
    const InnerEnd at_load = load_end();

    // Motor end: u_0 = at + per_rad turn + compliance T.
    double pivot = 1.0 / (1.0 - motor.compliance_m_per_N * at_motor.per_end_m);
    upper_[0] = -motor.compliance_m_per_N * at_motor.per_inner_m * pivot;
    value_[0] = (motor.at_m + motor.compliance_m_per_N * at_motor.value_N - displacement_m_[0]) * pivot;
    by_motor_[0] = motor.per_rad * pivot;

    const double rigid_N = effects_.bending_stiffness.drag_N_per_m * segment_m_;
    const double viscous_N_per_m = effects_.viscous_friction.drag_N(segment_m_, 1.0 / time_step_s_);
    for (std::size_t node = 1; node < last; ++node) {
        const double before_N = tension_N_[node - 1];
        const double behind_N = tension_N_[node];
        // A slack stretch presses on nothing.
        const double sum_N = std::max(0.0, before_N + behind_N);
        const double q = sum_N > 0.0 ? friction_[node] * bend_[node] : 0.0;
        const double slid_m = displacement_m_[node] - before_->displacement_m[node];
        const double out_of_balance_N =
            behind_N - before_N - q * sum_N - rigid_N * bend_[node] - viscous_N_per_m * slid_m;
        const double lower = tension_per_m_[node - 1] * (1.0 + q);
        const double upper = tension_per_m_[node] * (1.0 - q);
        const double drag = (friction_[node] * sum_N + rigid_N) * bend_per_m_[node] + viscous_N_per_m;
        pivot = 1.0 / (-lower - upper - drag - lower * upper_[node - 1]);
        upper_[node] = upper * pivot;
        value_[node] = (-out_of_balance_N - lower * value_[node - 1]) * pivot;
        by_motor_[node] = -lower * by_motor_[node - 1] * pivot;
    }

    // Load end: u_last = at + per_rad turn - compliance T.
    const double lower = load.compliance_m_per_N * at_load.per_inner_m;
    pivot = 1.0 / (1.0 + load.compliance_m_per_N * at_load.per_end_m - lower * upper_[last - 1]);
    value_[last] = (load.at_m - load.compliance_m_per_N * at_load.value_N - displacement_m_[last] -
                    lower * value_[last - 1]) *
                   pivot;
    by_motor_[last] = -lower * by_motor_[last - 1] * pivot;
    by_load_[last] = load.per_rad * pivot;
    for (std::size_t node = last; node-- > 0;) {
        value_[node] -= upper_[node] * value_[node + 1];
        by_motor_[node] -= upper_[node] * by_motor_[node + 1];
        by_load_[node] = -upper_[node] * by_load_[node + 1];
    }

    const auto end = [&](const InnerEnd& inner, std::size_t node, std::size_t neighbour) {
        return EndTension{
            inner.value_N + inner.per_end_m * value_[node] + inner.per_inner_m * value_[neighbour],
            inner.per_end_m * by_motor_[node] + inner.per_inner_m * by_motor_[neighbour],
            inner.per_end_m * by_load_[node] + inner.per_inner_m * by_load_[neighbour]};
    };
    return {end(at_motor, 0, 1), end(at_load, last, last - 1)};
}

double BenchCableEquations::move(double motor_rad, double load_rad, double share) {
    double largest_m = 0.0;
    for (std::size_t node = 0; node < displacement_m_.size(); ++node) {
        const double move_m = value_[node] + motor_rad * by_motor_[node] + load_rad * by_load_[node];
        displacement_m_[node] += share * move_m;
        largest_m = std::max(largest_m, std::abs(move_m));
    }
    return largest_m;
}

void BenchCableEquations::store(BenchCable& cable) {
    evaluate();
    cable.motor_tension_N = motor_end().value_N;
    cable.load_tension_N = load_end().value_N;
    const bool lags = effects_.stribeck.extra_friction != 0.0;
    for (std::size_t node = 0; lags && node < displacement_m_.size(); ++node) {
        const double speed = std::abs(displacement_m_[node] - cable.displacement_m[node]) / time_step_s_;
        cable.lagging_speed_m_per_s[node] =
            effects_.stribeck.lagging(cable.lagging_speed_m_per_s[node], speed, time_step_s_);
    }
    for (std::size_t segment = 0; effects_.creep.ratio > 0.0 && segment < tension_N_.size(); ++segment)
        cable.creep_m[segment] = creep_m(segment, tension_N_[segment]);
    cable.displacement_m = displacement_m_;
    cable.bristle = bend_;
    cable.tension_N = tension_N_;
}

}  // namespace capstan
