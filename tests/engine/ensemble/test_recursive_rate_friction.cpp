#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "capstan/cable/invalid_input.h"
#include "capstan/ensemble/rate_friction.h"
#include "capstan/estimation/recursive_estimator.h"
#include "example_cables.h"

namespace capstan {
namespace {

constexpr double sample_s = 0.01;

CableSpecification without_stiction() {
    CableSpecification specification = test::unevenly_cut_specification();
    specification.static_friction = specification.dynamic_friction;
    return specification;
}

RateFriction some_friction(double severity) {
    return {.viscous = {.drag_N_s_per_m2 = 100.0 * severity},
            .stribeck = {.extra_friction = 0.1 * severity, .speed_m_per_s = 0.02, .memory_s = 0.04}};
}

double moved_m(int step) {
    return 0.003 * std::sin(2.0 * std::numbers::pi * 1.5 * sample_s * step);
}

// The tension at every node and sample of an estimator that knows both ends and reads nothing.
std::vector<double> estimated_N(const Cable& cable, const RecursiveSettings& settings) {
    const QuasiStaticStep model(cable, ModelRules::consistent());
    const CableState start = pretensioned(cable);
    RecursiveEstimator estimator(model, start, settings);
    std::vector<double> all_N;
    for (int step = 1; step <= 150; ++step) {
        estimator.step({start.displacement_m.front() - moved_m(step), 0.0}, {});
        all_N.insert(all_N.end(), estimator.mean_N().begin(), estimator.mean_N().end());
    }
    return all_N;
}

// An independent way to the same equations: the ensemble's cables, each with its own speed.
std::vector<double> stepped_N(const Cable& cable, const RateFriction& friction) {
    CableEnsemble members(cable, 8);
    RateFrictionStep step(friction, members, cable.mean_segment_length_m(), sample_s);
    std::vector<double> wrap_rad;
    for (const double each_rad : cable.wrap_angle_rad()) wrap_rad.insert(wrap_rad.end(), 8, each_rad);
    const std::vector<double> distal_m(8, 0.0);
    std::vector<double> all_N;
    for (int k = 1; k <= 150; ++k) {
        step.advance(members, wrap_rad, -(moved_m(k) - moved_m(k - 1)), {1.0, 0.0, distal_m});
        for (int node = 0; node < members.nodes(); ++node) all_N.push_back(members.tension_N(node)[3]);
    }
    return all_N;
}

double largest_difference_N(const std::vector<double>& a_N, const std::vector<double>& b_N) {
    EXPECT_EQ(a_N.size(), b_N.size());
    double largest_N = 0.0;
    for (std::size_t k = 0; k < a_N.size(); ++k) largest_N = std::max(largest_N, std::abs(a_N[k] - b_N[k]));
    return largest_N;
}

TEST(RecursiveRateFriction, WithEverythingKnownMovesAsACableOfTheEnsembleDoes) {
    const Cable cable(without_stiction());
    RecursiveSettings settings{
        .members = 8, .wander = {}, .rate_friction = some_friction(1.0), .interval_s = sample_s};
    const std::vector<double> with_N = estimated_N(cable, settings);
    EXPECT_LT(largest_difference_N(with_N, stepped_N(cable, settings.rate_friction)), 1e-6);
    settings.rate_friction = {};
    EXPECT_GT(largest_difference_N(with_N, estimated_N(cable, settings)), 1.0);
    settings.rate_friction.viscous = some_friction(1.0).viscous;
    EXPECT_LT(largest_difference_N(estimated_N(cable, settings), stepped_N(cable, settings.rate_friction)),
              1e-6);
}

// A weak one is a small change, not another algorithm; without severity it changes no bit.
TEST(RecursiveRateFriction, GoesToTheStepWithoutItAsItsSeverityGoesToZero) {
    const Cable cable(without_stiction());
    RecursiveSettings settings{.members = 8, .wander = {}, .interval_s = sample_s};
    const std::vector<double> without_N = estimated_N(cable, settings);
    settings.rate_friction = some_friction(1e-8);
    EXPECT_LT(largest_difference_N(estimated_N(cable, settings), without_N), 1e-5);
    settings.rate_friction = some_friction(0.0);
    EXPECT_EQ(estimated_N(cable, settings), without_N);
}

// The ends of members that wander by half a millimetre in a hundredth of a second move at 50 mm/s, each its
// own way. That is what is not known of a cable at rest: no drag belongs to it.
TEST(RecursiveRateFriction, AWanderIsNoSpeed) {
    const Cable cable(without_stiction());
    const QuasiStaticStep model(cable, ModelRules::consistent());
    const CableState start = pretensioned(cable);
    const auto at_rest = [&](const RateFriction& friction) {
        RecursiveEstimator estimator(
            model, start,
            {.members = 32, .wander = {5e-4, 5e-4}, .rate_friction = friction, .interval_s = sample_s});
        for (int step = 1; step <= 20; ++step) estimator.step({start.displacement_m.front(), 0.0}, {});
        return std::vector<double>(estimator.deviation_N().begin(), estimator.deviation_N().end());
    };
    const std::vector<double> without_N = at_rest({});
    const double drag_N = 100.0 * cable.length_m() * 0.05;  // of all of the cable at 50 mm/s
    EXPECT_GT(drag_N, 5.0);
    EXPECT_LT(largest_difference_N(at_rest({.viscous = {.drag_N_s_per_m2 = 100.0}}), without_N), 0.2);
}

TEST(RecursiveRateFriction, NeedsAnIntervalAndConsistentRules) {
    const Cable cable(without_stiction());
    const CableState start = pretensioned(cable);
    const QuasiStaticStep model(cable, ModelRules::consistent());
    RecursiveSettings settings{.wander = {}, .rate_friction = some_friction(1.0)};
    EXPECT_THROW(RecursiveEstimator(model, start, settings), InvalidInput);
    settings.interval_s = sample_s;
    EXPECT_NO_THROW(RecursiveEstimator(model, start, settings));
    const QuasiStaticStep papers(cable, ModelRules::paper());
    EXPECT_THROW(RecursiveEstimator(papers, start, settings), InvalidInput);
    QuasiStaticStep step(cable, ModelRules::consistent());
    EXPECT_THROW(step.set_sliding_exponents(std::vector<double>(3, 0.1)), InvalidInput);
}

}  // namespace
}  // namespace capstan
