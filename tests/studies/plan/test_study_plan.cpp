#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/prepared_study.h"
#include "paper_plan.h"

namespace capstan {
namespace {

std::string all_in_one(const std::vector<KeyProblem>& problems) {
    std::string text;
    for (const KeyProblem& problem : problems) text += problem.text() + "\n";
    return text;
}

TEST(StudyPlan, PlanOfThePaperHasNoProblem) {
    EXPECT_EQ(all_in_one(problems_of(test::paper_plan(2))), "");
    EXPECT_EQ(all_in_one(problems_of(test::small_plan(2))), "");
}

struct BadPlan {
    const char* says;  // a part of the message
    std::function<void(StudyPlan&)> spoil;
};

const std::vector<BadPlan> bad_plans = {
    {"name: is empty", [](StudyPlan& p) { p.name.clear(); }},
    {"repetitions: must be at least 2", [](StudyPlan& p) { p.repetitions = 1; }},
    {"unknown layout family \"random\"; there are even, distal, both",
     [](StudyPlan& p) { p.layout_families.push_back("random"); }},
    {"unknown fusion method \"median\"", [](StudyPlan& p) { p.fusion_methods.push_back("median"); }},
    {"estimation.methods: is empty", [](StudyPlan& p) { p.fusion_methods.clear(); }},
    {"12 sensors do not fit on 11 nodes", [](StudyPlan& p) { p.sensor_counts.push_back(12); }},
    {"0 sensors do not fit", [](StudyPlan& p) { p.sensor_counts.push_back(0); }},
    {"node 12 is outside the cable",
     [](StudyPlan& p) {
         p.explicit_layouts = {{0, 11}};
     }},
    {"node 0 is outside the cable", [](StudyPlan& p) { p.explicit_layouts = {{-1}}; }},
    {"a node is named twice",
     [](StudyPlan& p) {
         p.explicit_layouts = {{3, 3}};
     }},
    {"an empty layout", [](StudyPlan& p) { p.explicit_layouts = {{}}; }},
    {"there is no layout", [](StudyPlan& p) { p.layout_families.clear(); }},
    {"duty fractions of all regimes sum to 0.9", [](StudyPlan& p) { p.regimes[0].duty_fraction = 0.4; }},
    {"regime[1].duty_fraction: is -0.5", [](StudyPlan& p) { p.regimes[0].duty_fraction = -0.5; }},
    {"regime[2].name: \"mass\" is given twice", [](StudyPlan& p) { p.regimes[1].regime = Regime::mass; }},
    {"no instant is named", [](StudyPlan& p) { p.regimes.clear(); }},
    {"sample 201 is outside the motion", [](StudyPlan& p) { p.regimes[0].samples = {201}; }},
    {"\"tension\" at both ends",
     [](StudyPlan& p) { p.motion.proximal.kind = p.motion.distal.kind = EndKind::tension; }},
    {"spring_stiffness_N_per_m: must be above 0",
     [](StudyPlan& p) { p.motion.distal.kind = EndKind::spring; }},
    {"sample_rate_Hz", [](StudyPlan& p) { p.motion.sample_rate_Hz = 0.0; }},
    {"motion.proximal", [](StudyPlan& p) { p.motion.proximal.amplitude = std::nan(""); }},
    {"no instant is in the regime mass",
     [](StudyPlan& p) {
         p.regimes = {{Regime::partial_proximal, {6}, 1.0}};
     }},
    {"noise[2].label: \"10 %\" is given twice",
     [](StudyPlan& p) {
         p.noise_levels.push_back({"10 %", {0.2, 0, 0}});
     }},
    {"-0.1 is not the size of a noise", [](StudyPlan& p) { p.noise_levels[0].level.additive_N = -0.1; }},
    {"no noise level", [](StudyPlan& p) { p.noise_levels.clear(); }},
    {"curve_points: is 100", [](StudyPlan& p) { p.curve_points = 100; }},
    {"largest_distal_increment_m: must be above 0", [](StudyPlan& p) { p.largest_distal_increment_m = 0.0; }},
    {"segments: is 64, but a study takes at most 63",
     [](StudyPlan& p) { p.transmission.cable.segments = 64; }},
    {"transmission.pretension_N: is -1", [](StudyPlan& p) { p.transmission.cable.pretension_N = -1.0; }},
    {"worthwhile_gain_N", [](StudyPlan& p) { p.worthwhile_gain_N = -0.1; }},
};

TEST(StudyPlan, NamesEachKindOfMistake) {
    for (const BadPlan& bad : bad_plans) {
        StudyPlan plan = test::paper_plan(2);
        bad.spoil(plan);
        const std::string text = all_in_one(problems_of(plan));
        EXPECT_NE(text.find(bad.says), std::string::npos) << "should say: " << bad.says << "\nsays: " << text;
    }
}

TEST(StudyPlan, ListsAllMistakesAtOnce) {
    StudyPlan plan = test::paper_plan(0);
    plan.layout_families = {"random"};
    plan.sensor_counts = {12};
    plan.curve_points = 7;
    plan.regimes[0].duty_fraction = 0.6;
    const auto problems = problems_of(plan);
    EXPECT_EQ(problems.size(), 5u) << all_in_one(problems);
    try {
        prepare(plan);
        FAIL() << "prepared a plan with problems";
    } catch (const InvalidInput& invalid) {
        EXPECT_EQ(std::string(invalid.what()) + "\n", all_in_one(problems));
    }
}

// The message lists the samples that are in the regime; each of them must be taken.
TEST(StudyPlan, RejectsAnInstantOutsideItsRegimeAndListsTheSamplesInside) {
    StudyPlan plan = test::paper_plan(2);
    plan.regimes[0].samples = {6};
    const auto problems = problems_of(plan);
    ASSERT_EQ(problems.size(), 1u) << all_in_one(problems);
    const std::string text = problems[0].text();
    EXPECT_NE(text.find("regime[1].samples: at sample 6"), std::string::npos) << text;
    const auto colon = text.find("samples that are: ");
    ASSERT_NE(colon, std::string::npos) << text;
    const int offered = std::stoi(text.substr(colon + 18));
    plan.regimes[0].samples = {offered};
    EXPECT_EQ(all_in_one(problems_of(plan)), "");
}

TEST(StudyPlan, ReportsARegimeThatIsNeverReached) {
    StudyPlan plan = test::paper_plan(2);
    plan.regimes[1] = {Regime::partial_distal, {6}, 0.5};
    const std::string text = all_in_one(problems_of(plan));
    EXPECT_NE(text.find("it never is in this motion"), std::string::npos) << text;
}

TEST(StudyPlan, AcceptsSixtyThreeSegments) {
    StudyPlan plan = test::paper_plan(2);
    plan.transmission.cable.segments = 63;
    const std::string text = all_in_one(problems_of(plan));
    EXPECT_EQ(text.find("segments: is"), std::string::npos) << text;
}

}  // namespace
}  // namespace capstan
