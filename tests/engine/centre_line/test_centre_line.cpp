#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>
#include <random>

#include "capstan/centre_line/centre_line.h"

namespace capstan {
namespace {

using Place = std::array<double, 3>;
constexpr double half_turn_rad = std::numbers::pi;

CentreLine measured(const std::function<Place(double)>& at, double length_m, int points, double noise_m,
                    unsigned seed) {
    std::mt19937_64 bits(seed);
    std::normal_distribution<double> normal(0.0, noise_m);
    CentreLine line{{}, noise_m};
    for (int k = 0; k < points; ++k) {
        Place place = at(length_m * k / (points - 1));
        for (double& coordinate : place) coordinate += normal(bits);
        line.points_m.push_back(place);
    }
    return line;
}

Place on_a_straight_line(double s) {
    return {0.6 * s, 0.8 * s, 0.0};
}
// Radius 0.1 m.
Place on_a_circle(double s) {
    return {0.1 * std::sin(s / 0.1), 0.1 * (1.0 - std::cos(s / 0.1)), 0.3};
}
// Radius 0.06 m, pitch 2 pi 0.03 m: curvature r / (r^2 + c^2) = 13.3 1/m, torsion half of it.
Place on_a_helix(double s) {
    const double turned = s / std::hypot(0.06, 0.03);
    return {0.06 * std::cos(turned), 0.06 * std::sin(turned), 0.03 * turned};
}
// Straight 0.3 m, a quarter turn of radius 0.08 m in one plane, straight 0.2 m, then one of 1 rad and 0.1 m
// in a plane across, straight for the rest.
Place on_an_arm(double s) {
    const double bend_m = 0.5 * half_turn_rad * 0.08;
    if (s < 0.3) return {s, 0.0, 0.0};
    if (s < 0.3 + bend_m) {
        const double turned = (s - 0.3) / 0.08;
        return {0.3 + 0.08 * std::sin(turned), 0.08 * (1.0 - std::cos(turned)), 0.0};
    }
    s -= 0.3 + bend_m;
    if (s < 0.2) return {0.38, 0.08 + s, 0.0};
    const double turned = std::min((s - 0.2) / 0.1, 1.0);
    const double beyond = std::max(s - 0.3, 0.0);
    return {0.38, 0.28 + 0.1 * std::sin(turned) + beyond * std::cos(turned),
            0.1 * (1.0 - std::cos(turned)) + beyond * std::sin(turned)};
}

struct Shape {
    const char* name;
    Place (*at)(double);
    double length_m;
    double wrap_rad;
    std::size_t bends;
};
const Shape shapes[] = {{"circle", on_a_circle, 0.3, 3.0, 1},
                        {"helix", on_a_helix, 0.6, 0.6 * 0.06 / (0.06 * 0.06 + 0.03 * 0.03), 1},
                        {"arm", on_an_arm, 1.2, 0.5 * half_turn_rad + 1.0, 2}};

double length_of(const MeasuredConduit& conduit) {
    double length_m = 0.0;
    for (const CurvaturePiece& piece : conduit.pieces) length_m += piece.length_m;
    return length_m;
}

std::size_t bends_of(const MeasuredConduit& conduit) {
    return static_cast<std::size_t>(
        std::count_if(conduit.pieces.begin(), conduit.pieces.end(),
                      [](const auto& piece) { return piece.bend_radius_m < straight; }));
}

// A circle has the angle that was drawn, a helix the curvature r / (r^2 + c^2) whatever its torsion, and an
// arm its two bends in different planes: to 3% in the mean over draws of the noise.
TEST(CentreLine, HasTheWrapAngleOfItsShapeWithoutBias) {
    for (const Shape& shape : shapes) {
        for (const int points : {60, 200, 1000}) {
            for (const double noise_m : {1e-5, 2e-4, 1e-3}) {
                constexpr unsigned draws = 6;
                double mean_rad = 0.0;
                for (unsigned seed = 1; seed <= draws; ++seed) {
                    const auto conduit =
                        measured_conduit(measured(shape.at, shape.length_m, points, noise_m, seed));
                    mean_rad += conduit.wrap_rad / draws;
                    EXPECT_NEAR(length_of(conduit), shape.length_m, 0.03 * shape.length_m) << shape.name;
                    EXPECT_EQ(bends_of(conduit), shape.bends) << shape.name << ", noise " << noise_m << " m";
                }
                EXPECT_NEAR(mean_rad, shape.wrap_rad, 0.03 * shape.wrap_rad)
                    << shape.name << ", " << points << " points, noise " << noise_m << " m";
            }
        }
    }
}

// The bias of smoothing is part of what is stated, so that 95% bands hold the true angle more often than
// that.
TEST(CentreLine, StatesAnUncertaintyThatHoldsTheTruth) {
    int within = 0;
    int all = 0;
    for (const Shape& shape : shapes) {
        for (const double noise_m : {1e-4, 1e-3, 3e-3}) {
            for (unsigned seed = 21; seed <= 40; ++seed) {
                const auto conduit = measured_conduit(measured(shape.at, shape.length_m, 120, noise_m, seed));
                within +=
                    std::abs(conduit.wrap_rad - shape.wrap_rad) <= 1.96 * conduit.total_deviation_rad ? 1 : 0;
                ++all;
                if (noise_m > 1e-3) continue;  // some draws show one bend of the arm only, and say so
                EXPECT_LT(conduit.total_deviation_rad, 0.15 * shape.wrap_rad)
                    << shape.name << ", " << noise_m;
            }
        }
    }
    std::cout << "    the band held the truth in " << within << " of " << all << " draws\n";
    EXPECT_GE(within, 0.95 * all);
}

TEST(CentreLine, PlacesTheBendsOfAnArm) {
    const auto conduit = measured_conduit(measured(on_an_arm, 1.2, 200, 2e-4, 1));
    ASSERT_EQ(conduit.pieces.size(), 5u);
    const double bend_m = 0.5 * half_turn_rad * 0.08;
    const double ends_m[] = {0.3, 0.3 + bend_m, 0.5 + bend_m, 0.6 + bend_m, 1.2};
    double at_m = 0.0;
    for (std::size_t k = 0; k < 5; ++k) {
        at_m += conduit.pieces[k].length_m;
        EXPECT_NEAR(at_m, ends_m[k], 0.02) << "piece " << k;
    }
    EXPECT_NEAR(conduit.pieces[1].length_m / conduit.pieces[1].bend_radius_m, 0.5 * half_turn_rad, 0.05);
    EXPECT_NEAR(conduit.pieces[3].length_m / conduit.pieces[3].bend_radius_m, 1.0, 0.05);
}

// Summed as it is, the curvature of these points would wrap by tens of radians.
TEST(CentreLine, OfNoisyPointsOnAStraightLineHasNoBend) {
    for (const int points : {20, 100, 1000}) {
        int bent = 0;
        for (unsigned seed = 1; seed <= 60; ++seed)
            bent +=
                bends_of(measured_conduit(measured(on_a_straight_line, 1.0, points, 1e-3, seed))) > 0 ? 1 : 0;
        EXPECT_LE(bent, 1) << points << " points";
    }
}

TEST(CentreLine, IsTheSameForTheSamePointsAndInAnyPosition) {
    const CentreLine line = measured(on_an_arm, 1.2, 100, 5e-4, 7);
    CentreLine turned = line;
    for (Place& place : turned.points_m) place = {3.0 - place[1], place[2] - 1.0, -place[0]};
    const auto a = measured_conduit(line);
    const auto b = measured_conduit(turned);
    EXPECT_EQ(a.wrap_rad, measured_conduit(line).wrap_rad);
    EXPECT_NEAR(a.wrap_rad, b.wrap_rad, 1e-3);
    EXPECT_EQ(a.pieces.size(), b.pieces.size());
}

TEST(CentreLine, OfTooFewPointsOrTooMuchNoiseIsRefused) {
    const auto problem = [](const CentreLine& line) {
        const auto problems = problems_of(line);
        return problems.empty() ? std::string() : problems.front().text();
    };
    EXPECT_NE(problem(measured(on_a_circle, 0.3, 7, 1e-3, 1)).find("at least 8"), std::string::npos);
    EXPECT_NE(problem(measured(on_a_circle, 0.3, 50, 0.1, 1)).find("too much"), std::string::npos);
    CentreLine silent = measured(on_a_circle, 0.3, 50, 1e-3, 1);
    silent.noise_m = 0.0;
    EXPECT_NE(problem(silent).find("noise_m"), std::string::npos);
    EXPECT_THROW(measured_conduit(silent), InvalidInput);
    CentreLine lost = measured(on_a_circle, 0.3, 50, 1e-3, 1);
    lost.points_m[4][1] = std::nan("");
    EXPECT_NE(problem(lost).find("points[5]"), std::string::npos);
}

}  // namespace
}  // namespace capstan
