#include "walk.h"

#include <cmath>
#include <ostream>

#include "capstan/cable/invalid_input.h"
#include "capstan/cable/motion_name.h"
#include "capstan/solver/pull_pull.h"
#include "promises.h"
#include "pull_pull_walk.h"
#include "random_bench.h"

namespace capstan::fuzz {

namespace {

// Friction exponent of the complete cable (mu_d times wrap angle), beyond which the ends' tensions can be so far
// apart that the smaller one, and the end's place by it, is below the rounding of the other: 1 to 5e8.
constexpr double exponent_that_doubles_resolve = 20.0;

double friction_exponent(const Cable& cable) {
    double wrap_rad = 0.0;
    for (const double segment_rad : cable.wrap_angle_rad()) wrap_rad += segment_rad;
    return cable.dynamic_friction() * wrap_rad;
}

// Some pattern verifies (engine/README.md, departure 3): consistent rules, mu_s = mu_d, within rounding.
bool must_verify(const QuasiStaticStep& step) {
    return step.rules().elongation == ElongationRule::mean_tension &&
           step.cable().static_friction() == step.cable().dynamic_friction() &&
           friction_exponent(step.cable()) < exponent_that_doubles_resolve;
}

std::string group_of(const QuasiStaticStep& step) {
    const bool consistent = step.rules().elongation == ElongationRule::mean_tension;
    const bool stiction = step.cable().static_friction() > step.cable().dynamic_friction();
    const bool resolved = friction_exponent(step.cable()) < exponent_that_doubles_resolve;
    return std::string(consistent ? "consistent rules, mu_s " : "paper's rules, mu_s ") +
           (stiction ? "above" : "equal to") + " mu_d, friction exponent " +
           (resolved ? "below 20" : "20 to 300");
}

void write(std::ostream& out, const EndConditions& ends) {
    for (const EndCondition& end : {ends.proximal, ends.distal}) {
        out << "  " << end.displacement_factor << " u + " << end.tension_factor << " T = " << end.value;
    }
    out << "\n";
}

void write(std::ostream& out, const StepReport& report, const CableState& state) {
    const MotionPattern& pattern = report.pattern;
    out << "    " << name_of(pattern.kind) << (report.verified ? "" : ", not verified") << ", moving "
        << sign(pattern.proximal_direction) * pattern.proximal_moving_nodes << " and "
        << sign(pattern.distal_direction) * pattern.distal_moving_nodes << " of " << state.tension_N.size()
        << ", tensions " << state.tension_N.front() << " to " << state.tension_N.back() << "\n";
}

// Springs with far walls can carry a slack cable off; with it go the last bits of its displacements.
bool far_away(const CableState& state) {
    constexpr double far_m = 10.0;
    return std::abs(state.displacement_m.front()) > far_m || std::abs(state.displacement_m.back()) > far_m;
}

void single_cable_walk(const Cable& cable, Choices& choices, Tally& tally, std::ostream* trace) {
    const QuasiStaticStep step(cable, any_rules(choices));
    test::InputPair pair = any_pair(choices);
    const std::string group = group_of(step);
    if (trace) *trace << group << "\n";
    CableState state = pretensioned(cable);
    VerifiedAnswers verified_answers(step);
    while (!choices.used_up()) {
        if (choices.one_in(32)) pair = any_pair(choices);
        if (far_away(state)) {
            state = pretensioned(cable);
            verified_answers.restart();
        }
        const Trial<EndConditions> trial = any_ends(choices, pair, state, cable);
        if (trace) write(*trace, trial.input);
        const CableState before = state;
        ++tally.steps;
        try {
            const StepReport report = step.advance(state, trial.input);
            if (!trial.refused_by.empty()) throw BrokenPromise("taken, not refused: " + trial.refused_by);
            if (trace) write(*trace, report, state);
            demand_a_state(cable, state);
            ++tally.of_kind[static_cast<std::size_t>(report.pattern.kind)];
            ++tally.taken[group];
            tally.unverified[group] += !report.verified;
            if (!report.verified && must_verify(step)) throw BrokenPromise("an answer that verifies");
            verified_answers.demand_of(report, state, trial.input);
        } catch (const InvalidInput& refusal) {
            if (trial.refused_by.empty()) throw BrokenPromise(std::string("refused: ") + refusal.what());
            demand_words(refusal.what(), trial.refused_by);
            demand_unchanged(before, state);
            ++tally.refused[trial.refused_by];
        }
    }
}

}  // namespace

void walk(Choices choices, Tally& tally, std::ostream* trace) {
    const Trial<CableSpecification> trial = any_cable(choices);
    try {
        const Cable cable(trial.input);
        if (!trial.refused_by.empty()) throw BrokenPromise("taken, not refused: " + trial.refused_by);
        if (choices.one_in(4)) {
            pull_pull_walk(cable, choices, tally, trace);
        } else {
            single_cable_walk(cable, choices, tally, trace);
        }
    } catch (const InvalidInput& refusal) {
        if (trial.refused_by.empty()) throw BrokenPromise(std::string("refused: ") + refusal.what());
        demand_words(refusal.what(), trial.refused_by);
        ++tally.refused[trial.refused_by];
    }
}

std::ostream& operator<<(std::ostream& out, const Tally& tally) {
    out << tally.steps << " steps of a cable:";
    for (std::size_t k = 0; k < tally.of_kind.size(); ++k) {
        out << ' ' << name_of(static_cast<MotionKind>(k)) << ' ' << tally.of_kind[k];
    }
    out << "; " << tally.pull_pull_steps << " steps of a pull-pull pair, torque not met in "
        << tally.unmet_torques << "\nnot verified:";
    for (const auto& [group, taken] : tally.taken) {
        const auto found = tally.unverified.find(group);
        const long count = found == tally.unverified.end() ? 0 : found->second;
        out << "\n  " << group << ": " << count << " of " << taken << " ("
            << 100.0 * static_cast<double>(count) / static_cast<double>(taken) << "%)";
    }
    out << "\nrefused:";
    for (const auto& [words, count] : tally.refused) out << "\n  " << count << " x \"" << words << "\"";
    return out << "\n";
}

}  // namespace capstan::fuzz
