// The power audit: over full cycles with both ends driven, what the hands at the ends put in is stored in the
// cable and its springs or lost to friction, to 1e-9 of all work done. Work is signed, so what one end puts
// in and the other takes out is in it.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <set>

#include "capstan/solver/quasi_static_step.h"
#include "convergence_order.h"
#include "driven_cycle.h"
#include "energy_account.h"
#include "example_cables.h"

namespace capstan {
namespace {

using test::InputPair;

// What drives an end: a hand at the end itself, or behind its spring, where the spring is relaxed.
double hand_m(const EndCondition& end, double end_m) {
    return end.displacement_factor == 0.0 ? end_m : end.value / end.displacement_factor;
}

double spring_J(const EndCondition& end, double tension_N) {
    if (end.displacement_factor == 0.0 || end.tension_factor == 0.0) return 0.0;
    return 0.5 * tension_N * tension_N / std::abs(end.displacement_factor);
}

struct Audit {
    test::EnergyAccount cable;
    double hands_J = 0.0;
    double springs_J = 0.0;
    std::set<MotionKind> kinds{};
    double worst_step = 0.0;  // imbalance of a step, of all work done until then

    double imbalance_J() const {
        return hands_J - springs_J - cable.stored_J - cable.friction_J - cable.untaken_slack_J;
    }
};

void audit_end(const EndCondition& before, const EndCondition& after, const test::EndTarget& was,
               const test::EndTarget& is, double outward, Audit& audit) {
    const double moved_m = hand_m(after, is.displacement_m) - hand_m(before, was.displacement_m);
    audit.hands_J += outward * 0.5 * (was.tension_N + is.tension_N) * moved_m;
    audit.springs_J += spring_J(after, is.tension_N) - spring_J(before, was.tension_N);
}

Audit audit_of(const Cable& cable, const test::DrivenCycle& cycle, int cycles) {
    const QuasiStaticStep step(cable, ModelRules::consistent());
    CableState state = pretensioned(cable);
    EndConditions ends = cycle.ends_at(cable, 0);
    Audit audit;
    for (int n = 1; n <= cycles * cycle.steps; ++n) {
        const CableState before = state;
        const EndConditions ends_before = ends;
        ends = cycle.ends_at(cable, n);
        audit.kinds.insert(step.advance(state, ends).pattern.kind);
        audit.cable += test::account(cable, before, state);
        audit_end(ends_before.proximal, ends.proximal, test::proximal_end(before), test::proximal_end(state),
                  -1.0, audit);
        audit_end(ends_before.distal, ends.distal, test::distal_end(before), test::distal_end(state), 1.0,
                  audit);
        audit.worst_step =
            std::max(audit.worst_step, std::abs(audit.imbalance_J()) / audit.cable.throughput_J);
    }
    return audit;
}

void tell(const char* what, const Audit& audit) {
    std::cout << "    " << what << ": hands " << audit.hands_J << " J = springs " << audit.springs_J
              << " + cable " << audit.cable.stored_J << " + friction " << audit.cable.friction_J
              << " + untaken slack " << audit.cable.untaken_slack_J << "; worst imbalance "
              << audit.worst_step << " of " << audit.cable.throughput_J << " J, kinds of motion "
              << audit.kinds.size() << "\n";
}

class EnergyAudit : public testing::TestWithParam<std::tuple<InputPair, double>> {  // mu_s
  protected:
    const InputPair& pair() const { return std::get<InputPair>(GetParam()); }
    Cable cable() const {
        CableSpecification specification = test::routed_specification(20);
        specification.static_friction = std::get<double>(GetParam());
        return Cable(specification);
    }
};

TEST_P(EnergyAudit, OfATautCycleBalancesToRounding) {
    const Audit audit = audit_of(cable(), {pair(), 0.004, 400}, 3);
    tell("taut", audit);
    EXPECT_FALSE(audit.kinds.contains(MotionKind::slack));
    EXPECT_LT(audit.worst_step, 1e-9);
    EXPECT_NEAR(audit.cable.untaken_slack_J, 0.0, 1e-9 * audit.cable.throughput_J);
    EXPECT_GT(audit.cable.friction_J, 0.01 * audit.cable.throughput_J);
}

constexpr double slackening_amplitude_m = 0.03;

TEST_P(EnergyAudit, OfACycleThroughSlackBalancesWithTheSlackNotTaken) {
    const Audit audit = audit_of(cable(), {pair(), slackening_amplitude_m, 400}, 3);
    tell("through slack", audit);
    EXPECT_TRUE(audit.kinds.contains(MotionKind::slack));
    EXPECT_LT(audit.worst_step, 1e-9);
    EXPECT_GT(audit.cable.friction_J, 0.01 * audit.cable.throughput_J);
}

// Nothing real is lost on the way through slack: all tensions go to nothing together, so the last of the
// stored energy has left through the ends and friction before the cable hangs. What the account leaves over
// belongs to the length of the two steps in which the cable goes slack and taut, and goes with its square. An
// end whose tension is prescribed follows the other one and leaves no gap, so with one nothing is left over.
TEST_P(EnergyAudit, LeavesNothingOverThroughSlackAsStepsGetShorter) {
    test::ErrorsByHalving left;
    double throughput_J = 0.0;
    for (const int steps : {250, 500, 1000, 2000, 4000, 8000}) {
        const Audit audit = audit_of(cable(), {pair(), slackening_amplitude_m, steps}, 1);
        left.add(std::abs(audit.cable.untaken_slack_J));
        throughput_J = audit.cable.throughput_J;
    }
    left.tell("untaken slack [J]");
    if (test::prescribes_a_tension(pair())) {
        EXPECT_LT(left.coarsest(), 1e-12 * throughput_J);
    } else {
        EXPECT_GT(left.mean_order(), 1.5);
        EXPECT_LT(left.finest(), 1e-6 * throughput_J);
    }
}

INSTANTIATE_TEST_SUITE_P(EveryInputPair, EnergyAudit,
                         testing::Combine(testing::ValuesIn(test::every_input_pair()),
                                          testing::Values(0.15, 0.3)),
                         [](const auto& which) {
                             return test::name_of(std::get<InputPair>(which.param)) +
                                    (std::get<double>(which.param) > 0.15 ? "WithStiction" : "");
                         });

}  // namespace
}  // namespace capstan
