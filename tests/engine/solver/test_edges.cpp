// Exactly at the edges of E4, E5 and E6, and of slack. No operation rounds in these cables: stiffness over
// length and the tensions are powers of two or small integers, and a straight segment has the tension
// ratio 1.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/cable_ensemble.h"
#include "capstan/solver/quasi_static_step.h"
#include "capstan/solver/sides.h"
#include "capstan/solver/sliding_run.h"
#include "example_cables.h"

namespace capstan {
namespace {

constexpr int members = 8;

// 2 m in `segments` equal segments: straight for half a metre at both ends, bent or straight between them.
Cable exact_cable(int segments, double bend_radius_m) {
    CableSpecification specification = test::paper_specification(segments);
    specification.curvature = {{0.5, straight}, {1.0, bend_radius_m}, {0.5, straight}};
    specification.axial_stiffness_N = 1024.0;
    specification.pretension_N = 8.0;
    return Cable(specification);
}

// Stretched by these tensions (E2), the proximal end where it is under pretension.
CableState stretched(const Cable& cable, const std::vector<double>& tension_N) {
    CableState state = pretensioned(cable);
    state.tension_N = tension_N;
    for (int node = 1; node < cable.nodes(); ++node)
        state.displacement_m[node] =
            state.displacement_m[node - 1] +
            0.5 * cable.segment_compliance_m_per_N(node - 1) * (tension_N[node - 1] + tension_N[node]);
    return state;
}

void put(const CableState& state, CableEnsemble& ensemble) {
    for (int node = 0; node < ensemble.nodes(); ++node) {
        for (double& each : ensemble.tension_N(node)) each = state.tension_N[node];
        for (double& each : ensemble.displacement_m(node)) each = state.displacement_m[node];
    }
}

CableEnsemble all_in(const CableState& state, const Cable& cable) {
    CableEnsemble ensemble(cable, members);
    put(state, ensemble);
    return ensemble;
}

// A tension at the distal end, the proximal one locked.
EnsembleReport load(CableEnsemble& ensemble, double tension_N) {
    const std::vector<double> value(members, tension_N);
    return ensemble.advance(0.0, {0.0, 1.0, value});
}

// E4 with equality. The segment beside a driven end is straight, so its neighbour joins; the bend holds the
// next.
TEST(Edge, ANeighbourExactlyAtTheEdgeOfTheConeJoins) {
    const Cable cable = exact_cable(4, 0.3);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    for (const double before_N : {4.0, 16.0}) {
        const CableState state = stretched(cable, {before_N, 8.0, 8.0, 8.0, before_N});
        CableState pulled = state;
        step.advance(pulled,
                     {EndCondition::tension_N(8.0), EndCondition::position_m(state.displacement_m.back())});
        EXPECT_EQ(pulled.last_motion.proximal_moving_nodes, 2);
        pulled = state;
        step.advance(pulled,
                     {EndCondition::position_m(state.displacement_m.front()), EndCondition::tension_N(8.0)});
        EXPECT_EQ(pulled.last_motion.distal_moving_nodes, 2);
        CableEnsemble ensemble = all_in(state, cable);
        EXPECT_EQ(load(ensemble, 8.0).searched, 0);
        EXPECT_EQ(ensemble.state_of(3).last_motion.distal_moving_nodes, 2);
    }
}

// E4 from the other side: a front stays valid up to the edge of the cone and its rounding, and not beyond.
TEST(Edge, AnEnsemblesFrontHoldsUpToTheEdgeOfTheCone) {
    const Cable cable = exact_cable(4, 0.3);
    const double hold = 1.0 + tension_rounding;
    double lowest_N = 8.0 / hold;
    while (lowest_N * hold < 8.0) lowest_N = std::nextafter(lowest_N, 9.0);
    while (std::nextafter(lowest_N, 0.0) * hold >= 8.0) lowest_N = std::nextafter(lowest_N, 0.0);
    ASSERT_EQ(lowest_N * hold, 8.0);
    struct Case {
        double before_N;
        double edge_N;
        double beyond_N;
    };
    for (const auto& [before_N, edge_N, beyond_N] : {Case{4.0, lowest_N, std::nextafter(lowest_N, 0.0)},
                                                     {16.0, 8.0 * hold, std::nextafter(8.0 * hold, 9.0)}}) {
        const CableState state = stretched(cable, {8.0, 8.0, 8.0, 8.0, before_N});
        CableEnsemble at_edge = all_in(state, cable);
        EXPECT_EQ(load(at_edge, edge_N).searched, 0);
        EXPECT_EQ(at_edge.state_of(3).last_motion.distal_moving_nodes, 1);
        CableEnsemble beyond = all_in(state, cable);
        EXPECT_EQ(load(beyond, beyond_N).searched, members);
    }
}

// 2^-10 is the sum of both ends' displacements and the input, and 64 times epsilon of it is 2^-56.
TEST(Edge, AChangeAsLargeAsTheRoundingDrivesNothing) {
    const Cable cable = exact_cable(4, 0.3);
    const PrefixTables tables(cable, ModelRules::consistent());
    const ModelRules rules = ModelRules::consistent();
    CableState state = pretensioned(cable);
    state.displacement_m.front() = -(0x1p-10 - 0x1p-56);
    state.displacement_m.back() = 0.0;
    const StepView view{tables, rules, state};
    const auto driven_by = [&](double change_m) {
        const EndConditions ends{EndCondition::position_m(state.displacement_m.front()),
                                 EndCondition::position_m(change_m)};
        return driven_direction(CableEnd<End::distal>(view, ends));
    };
    EXPECT_EQ(driven_by(0x1p-56), Direction::none);
    EXPECT_EQ(driven_by(0x1.1p-56), Direction::forward);
    for (const double change_m : {0x1p-56, 0x1.1p-56}) {
        CableEnsemble ensemble = all_in(state, cable);
        const std::vector<double> value(members, change_m);
        ensemble.advance(0.0, {1.0, 0.0, value});
        EXPECT_EQ(ensemble.displacement_m(cable.segments())[3], change_m > 0x1p-56 ? change_m : 0.0);
    }
}

// E5: everything slides forward, in a second step the middle node to where it was, less what may be rounding.
TEST(Edge, AnEnsemblesNodeMayStayBehindByTheRounding) {
    const Cable cable = exact_cable(2, straight);
    for (const double ahead_m : {displacement_rounding_m, 2.0 * displacement_rounding_m}) {
        CableEnsemble ensemble(cable, members);
        const std::vector<double> first(members, 0x1p-5);
        ensemble.advance(0x1p-5, {1.0, 0.0, first});
        ASSERT_EQ(ensemble.state_of(3).last_motion.kind, MotionKind::mass);
        CableState state = pretensioned(cable);
        state.tension_N = {4.0, 4.0, 4.0};
        state.displacement_m = {-0x1p-8 - 0x1p-10, ahead_m, 0x1p-8 - 0x1p-10};
        put(state, ensemble);
        const std::vector<double> second(members, 0x1p-8);
        const EnsembleReport report = ensemble.advance(0x1p-10, {1.0, 0.0, second});
        EXPECT_EQ(report.searched, ahead_m > displacement_rounding_m ? members : 0);
        if (report.searched == 0) {
            EXPECT_EQ(ensemble.displacement_m(1)[3], 0.0);
            EXPECT_EQ(ensemble.tension_N(1)[3], 4.0);
        }
    }
}

// E5 over a run whose nodes have no elongation, and under the paper's rules in the mean.
TEST(Edge, ARunMayStayBehindByTheRounding) {
    const Cable cable = exact_cable(4, 0.3);
    const PrefixTables tables(cable, ModelRules::consistent());
    const std::array<double, 8> ratio{};
    const std::array<double, 8> elongation_m_per_N{};
    for (const Direction direction : {Direction::forward, Direction::backward}) {
        for (int end = 1; end <= 8; ++end) {
            const SlidingRun run{0, end, direction, 1.0, 0.0, 1.0, ratio.data(), elongation_m_per_N.data()};
            const auto moves_behind = [&](const ModelRules& rules, double behind_m) {
                CableState state;
                state.tension_N.assign(8, 1.0);
                state.displacement_m.assign(8, sign(direction) * behind_m);
                return moves(run, {tables, rules, state});
            };
            const double edge_m = displacement_rounding_m;
            EXPECT_TRUE(moves_behind(ModelRules::consistent(), edge_m));
            EXPECT_FALSE(moves_behind(ModelRules::consistent(), std::nextafter(edge_m, 1.0)));
            EXPECT_TRUE(moves_behind(ModelRules::paper(), 0.5 * edge_m));
            EXPECT_EQ(moves_behind(ModelRules::paper(), 0.5 * std::nextafter(edge_m, 1.0)), end == 1);
        }
    }
}

// The ends meet at the unstretched length: driven against each other, and driven one way.
TEST(Edge, ACableThatCarriesNothingIsSlack) {
    const Cable cable = exact_cable(4, 0.3);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    const double from_m = pretensioned(cable).displacement_m.front();
    for (const double to_m : {-0x1p-9, 0x1p-9}) {
        CableState state = pretensioned(cable);
        const StepReport report =
            step.advance(state, {EndCondition::position_m(to_m), EndCondition::position_m(to_m)});
        EXPECT_EQ(report.pattern.kind, MotionKind::slack);
        EXPECT_EQ(state.tension_N, std::vector<double>(cable.nodes(), 0.0));
        CableEnsemble ensemble(cable, members);
        const std::vector<double> value(members, to_m);
        ensemble.advance(to_m - from_m, {1.0, 0.0, value});
        EXPECT_TRUE(ensemble.is_slack(3));
        EXPECT_EQ(ensemble.tension_N(2)[3], 0.0);
    }
}

TEST(Edge, TheLargestNumberIsAccepted) {
    const double beyond = std::nextafter(largest_number, 1e300);
    for (const double number : {largest_number, -largest_number}) {
        EXPECT_TRUE(std::isfinite(number * number));
        Candidate candidate;
        candidate.proximal = candidate.distal = {number, number};
        EXPECT_TRUE(is_finite(candidate));
    }
    for (int which = 0; which < 4; ++which) {
        Candidate candidate;
        const std::array<double*, 4> fields{&candidate.proximal.tension_N, &candidate.proximal.displacement_m,
                                            &candidate.distal.tension_N, &candidate.distal.displacement_m};
        *fields[which] = beyond;
        EXPECT_FALSE(is_finite(candidate));
    }
    const EndCondition fixed = EndCondition::position_m(0.0);
    EXPECT_TRUE(solvable({fixed, EndCondition::position_m(largest_number)}));
    EXPECT_FALSE(solvable({fixed, EndCondition::position_m(beyond)}));
}

// What is wrong with an end that is as large as one may be is named too.
TEST(Edge, ARefusalNamesTheReasonUpToTheLargestEnd) {
    const auto refusal = [](double tension_N) -> std::string {
        try {
            refuse({EndCondition::tension_N(tension_N), EndCondition::tension_N(1.0)});
        } catch (const InvalidInput& refused) {
            return refused.what();
        }
    };
    const double largest_N = 0.25 * largest_number;
    EXPECT_NE(refusal(largest_N).find("at both ends"), std::string::npos);
    EXPECT_NE(refusal(std::nextafter(largest_N, 1e300)).find("not a finite number"), std::string::npos);
}

}  // namespace
}  // namespace capstan
