#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capstan/cable/cable_cut.h"
#include "capstan/gap/effects_twin.h"
#include "capstan/gap/equivalent_bench.h"
#include "lumped_session.h"

namespace capstan::gap {
namespace {

TEST(Routing, KeepsLengthAndWrapWhereverTheBendsAre) {
    const std::vector<CurvaturePiece> described = {{0.4, 0.2}, {0.8, straight}};
    BenchNumbers numbers;
    EXPECT_EQ(numbers.routing(described).size(), described.size()) << "as described unless they are moved";
    numbers.bend_at_motor_ratio = 5.0;
    numbers.bend_at_load_ratio = 0.25;
    const std::vector<CurvaturePiece> moved = numbers.routing(described);
    ASSERT_EQ(moved.size(), 3u);
    EXPECT_NEAR(moved[0].length_m + moved[1].length_m + moved[2].length_m, 1.2, 1e-12);
    EXPECT_NEAR(wrap_rad(moved), wrap_rad(described), 1e-12);
    EXPECT_NEAR(moved[1].bend_radius_m / moved[0].bend_radius_m, 5.0, 1e-9);
    EXPECT_NEAR(moved[1].bend_radius_m / moved[2].bend_radius_m, 0.25, 1e-9);
}

// Where all of the cable slides, friction depends on the wrap alone (E1). After a reversal the slip begins at
// the motor, and meets the bends there first.
TEST(Routing, WhereTheBendsAreShowsOnlyWhileAPartOfTheCableSlides) {
    const Recording drive = lumped_session({});
    const Recording bench = equivalent_bench(drive, drive);
    const EffectsTwin twin(bench, {.segments = 40, .stride = 1, .reports_sliding_fraction = true});
    BenchNumbers at_motor;
    at_motor.bend_at_motor_ratio = 8.0;
    const TwinRun even = twin.run(0, {});
    const TwinRun moved = twin.run(0, at_motor);
    const auto torque = static_cast<std::size_t>(*bench.channel("motor_torque"));
    const auto [least, most] = std::minmax_element(even.values[torque].begin(), even.values[torque].end());
    double while_all_slides = 0.0;
    double while_a_part_slides = 0.0;
    for (std::size_t sample = 0; sample < even.values[torque].size(); ++sample) {
        const bool all_slides = even.sliding_fraction[sample] == 1.0 && moved.sliding_fraction[sample] == 1.0;
        double& largest = all_slides ? while_all_slides : while_a_part_slides;
        largest = std::max(
            largest, std::abs(moved.values[torque][sample] - even.values[torque][sample]) / (*most - *least));
    }
    EXPECT_GT(while_all_slides, 0.0) << "no sample with all of the cable sliding";
    EXPECT_LT(while_all_slides, 0.01);
    EXPECT_GT(while_a_part_slides, 0.05);
}

}  // namespace
}  // namespace capstan::gap
