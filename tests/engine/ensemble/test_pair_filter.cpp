#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "capstan/cable/invalid_input.h"
#include "capstan/ensemble/ensemble_filter.h"
#include "capstan/sensing/random_stream.h"
#include "capstan/solver/pull_pull.h"

namespace capstan {
namespace {

constexpr double pair_interval_s = 0.01;
constexpr int pair_samples = 150;

CableSpecification forearm() {
    return {.curvature = {{0.3, straight}, {0.2, 0.12}, {0.3, straight}, {0.15, 0.08}},
            .segments = 10,
            .axial_stiffness_N = 9000.0,
            .dynamic_friction = 0.12,
            .static_friction = 0.16,
            .pretension_N = 40.0};
}

double pair_motor_m(int sample) {
    return 0.002 * std::sin(2.0 * std::numbers::pi * 0.7 * sample * pair_interval_s);
}

CableBelief pair_belief() {
    CableBelief belief;
    belief.arrangement = CableArrangement::pull_pull;
    belief.interval_s = pair_interval_s;
    return belief;
}

// One world of a belief: a pair with its own numbers, moved at both pulleys.
struct PairWorld {
    std::vector<std::vector<double>> tension_N;  // samples x (cables x nodes)
    std::vector<double> far_end_m;               // samples
};

PairWorld pair_world(const UncertainCable& cable, const CableBelief& belief, std::uint32_t index) {
    const auto normal = [&](RandomPurpose purpose, std::uint32_t scenario, std::uint32_t node) {
        return standard_normals({3, purpose, scenario, index, node});
    };
    std::vector<Cable> cables;
    for (std::uint32_t which = 0; which < 2; ++which) {
        const auto draw = [&](double deviation, std::uint32_t k) {
            return deviation * normal(RandomPurpose::world_cable, which, k)[0];
        };
        const CableUncertainty& unknown = belief.uncertainty;
        CableFactors factors{
            draw(unknown.friction, 0), draw(unknown.stiffness, 1), draw(unknown.pretension, 2), {}};
        for (int bend = 0; bend < cable.bends(); ++bend)
            factors.log_wrap.push_back(draw(unknown.wrap, 3 + static_cast<std::uint32_t>(bend)));
        cables.emplace_back(cable.with(factors));
    }
    const PullPull pair(cables[0], cables[1], {1.0, 1.0});  // angles are metres
    PullPullState state = pair.at_rest();
    const FarEndProcess process(belief.far_end, belief.interval_s);
    PairWorld world;
    double y = 0.0;
    double v = 0.0;
    for (int n = 1; n <= pair_samples; ++n) {
        const auto normals = normal(RandomPurpose::world_far_end, static_cast<std::uint32_t>(n), 0);
        process.advance(y, v, normals[0], normals[1]);
        pair.advance(state, {MotorAngle{-pair_motor_m(n)}, LoadAngle{-y}});
        world.far_end_m.push_back(y);
        std::vector<double> tension_N = state.cable_a.tension_N;
        tension_N.insert(tension_N.end(), state.cable_b.tension_N.begin(), state.cable_b.tension_N.end());
        world.tension_N.push_back(std::move(tension_N));
    }
    return world;
}

SensorErrors noise_of(double additive) {
    SensorErrors errors;
    errors.additive = additive;
    return errors;
}

struct PairScore {
    double mean_square_N2[2] = {0.0, 0.0};  // cables
    double covered_fraction = 0.0;
};

// The filter with these sensors on `worlds` worlds that are drawn from its own belief.
PairScore score_of(const CableBelief& belief, const std::vector<SensorOffer>& offers, int worlds,
                   int members = 64) {
    const UncertainCable cable(forearm());
    const Cable nominal(forearm());
    const auto nodes = static_cast<std::size_t>(nominal.nodes());
    std::vector<int> sensors;
    for (std::size_t s = 0; s < offers.size(); ++s) sensors.push_back(static_cast<int>(s));
    PairScore score;
    for (int w = 0; w < worlds; ++w) {
        const PairWorld world = pair_world(cable, belief, static_cast<std::uint32_t>(w));
        const EnsembleDraws draws({9, static_cast<std::uint32_t>(w)}, members,
                                  2 * EnsembleCable::drawn_numbers(cable), static_cast<int>(offers.size()),
                                  pair_samples);
        EnsembleFilter filter(cable, belief, offers, sensors, draws);
        for (int n = 1; n <= pair_samples; ++n) {
            const std::vector<double>& truth_N = world.tension_N[static_cast<std::size_t>(n - 1)];
            std::vector<double> readings;
            for (std::size_t s = 0; s < offers.size(); ++s) {
                const SensorOffer& offer = offers[s];
                const auto node = static_cast<std::size_t>(nominal.nearest_node(offer.place_m));
                const double of_b_N = truth_N[nodes + node];
                const double value = offer.kind == SensorKind::tension
                                         ? (offer.cable == 0 ? truth_N[node] : of_b_N)
                                     : offer.kind == SensorKind::load_displacement
                                         ? world.far_end_m[static_cast<std::size_t>(n - 1)]
                                         : truth_N[node] - of_b_N;
                const auto noise =
                    standard_normals({3, RandomPurpose::world_reading, static_cast<std::uint32_t>(n),
                                      static_cast<std::uint32_t>(w), static_cast<std::uint32_t>(s)});
                readings.push_back(value + offer.errors.additive * noise[0]);
            }
            filter.step(pair_motor_m(n) - pair_motor_m(n - 1), readings);
            for (std::size_t k = 0; k < 2 * nodes; ++k) {
                const double error_N = filter.mean_N()[k] - truth_N[k];
                const double share = 1.0 / (pair_samples * static_cast<double>(nodes) * worlds);
                score.mean_square_N2[k / nodes] += share * error_N * error_N;
                if (std::abs(error_N) <= deviations_of_95 * filter.deviation_N()[k])
                    score.covered_fraction += 0.5 * share;
            }
        }
    }
    return score;
}

CableBelief uncertain_pair() {
    CableBelief belief = pair_belief();
    belief.uncertainty = {.friction = 0.09, .stiffness = 0.05, .pretension = 0.07, .wrap = 0.05};
    belief.far_end = {.range_m = 0.001};
    return belief;
}

TEST(PairFilter, FollowsThePairExactlyWhereEverythingIsKnown) {
    const UncertainCable cable(forearm());
    const CableBelief belief = pair_belief();
    const EnsembleDraws draws({1, 0}, 16, 2 * EnsembleCable::drawn_numbers(cable), 0, pair_samples);
    EnsembleFilter filter(cable, belief, {}, {}, draws);
    const PairWorld world = pair_world(cable, belief, 0);
    for (int n = 1; n <= pair_samples; ++n) {
        filter.step(pair_motor_m(n) - pair_motor_m(n - 1), {});
        const auto& truth_N = world.tension_N[static_cast<std::size_t>(n - 1)];
        ASSERT_EQ(filter.mean_N().size(), truth_N.size());
        for (std::size_t k = 0; k < truth_N.size(); ++k)
            ASSERT_NEAR(filter.mean_N()[k], truth_N[k], 1e-6) << "sample " << n << ", " << k;
    }
}

// Cable A is told by its sensor, cable B by the far end that both have.
TEST(PairFilter, AReadingOnOneCableTellsOfTheOther) {
    const PairScore none = score_of(uncertain_pair(), {}, 20);
    const PairScore on_a =
        score_of(uncertain_pair(), {{SensorKind::tension, 0.95, noise_of(0.2), 1.0, 0}}, 20);
    EXPECT_LT(on_a.mean_square_N2[0], 0.1 * none.mean_square_N2[0]);
    EXPECT_LT(on_a.mean_square_N2[1], 0.4 * none.mean_square_N2[1]);
}

TEST(PairFilter, ATorqueTellsOfBothCables) {
    const PairScore none = score_of(uncertain_pair(), {}, 20);
    for (const SensorKind kind : {SensorKind::motor_torque, SensorKind::load_torque}) {
        const double place_m = kind == SensorKind::motor_torque ? 0.0 : 0.95;
        const PairScore torque = score_of(uncertain_pair(), {{kind, place_m, noise_of(0.2)}}, 20);
        EXPECT_LT(torque.mean_square_N2[0], 0.3 * none.mean_square_N2[0]) << name_of(kind);
        EXPECT_LT(torque.mean_square_N2[1], 0.3 * none.mean_square_N2[1]) << name_of(kind);
    }
}

TEST(PairFilter, TheBandHoldsTheTruthAsOftenAsItSays) {
    const std::vector<SensorOffer> torque = {{SensorKind::motor_torque, 0.0, noise_of(0.5)}};
    const std::vector<SensorOffer> ends = {{SensorKind::tension, 0.0, noise_of(0.5), 1.0, 0},
                                           {SensorKind::tension, 0.95, noise_of(0.5), 1.0, 1}};
    for (const auto& offers : {std::vector<SensorOffer>{}, torque, ends}) {
        const PairScore score = score_of(uncertain_pair(), offers, 60, 128);
        EXPECT_GT(score.covered_fraction, 0.93);
        EXPECT_LT(score.covered_fraction, 0.97);
    }
}

TEST(PairFilter, WithTwoTorquesTheBandIsHonestToo) {
    const std::vector<SensorOffer> torques = {{SensorKind::motor_torque, 0.0, noise_of(0.5)},
                                              {SensorKind::load_torque, 0.95, noise_of(0.5)}};
    for (const int members : {64, 128}) {
        const double covered = score_of(uncertain_pair(), torques, 300, members).covered_fraction;
        std::printf("two torques, %d members: %.1f%%\n", members, 100.0 * covered);
        EXPECT_GT(covered, 0.93);
        EXPECT_LT(covered, 0.97);
    }
    EXPECT_GT(score_of(uncertain_pair(), {torques[0]}, 300).covered_fraction, 0.93);
}

TEST(PairFilter, AFurtherSensorDoesNotRaiseTheSquaredError) {
    const std::vector<SensorOffer> all = {{SensorKind::motor_torque, 0.0, noise_of(0.3)},
                                          {SensorKind::tension, 0.95, noise_of(0.3), 1.0, 1},
                                          {SensorKind::load_displacement, 0.95, noise_of(1e-4)},
                                          {SensorKind::tension, 0.0, noise_of(0.3), 1.0, 0}};
    double before_N2 = 1e9;
    for (std::size_t count = 0; count <= all.size(); ++count) {
        const PairScore score = score_of(
            uncertain_pair(),
            std::vector<SensorOffer>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)), 40);
        const double now_N2 = 0.5 * (score.mean_square_N2[0] + score.mean_square_N2[1]);
        EXPECT_LT(now_N2, 1.02 * before_N2) << count;
        before_N2 = now_N2;
    }
}

TEST(PairFilter, RefusesASpringAtTheLoad) {
    const UncertainCable cable(forearm());
    CableBelief belief = pair_belief();
    belief.support.spring_stiffness_N_per_m = 1000.0;
    const EnsembleDraws draws({1, 0}, 16, 2 * EnsembleCable::drawn_numbers(cable), 0, 1);
    EXPECT_THROW(EnsembleFilter(cable, belief, {}, {}, draws), InvalidInput);
}

}  // namespace
}  // namespace capstan
