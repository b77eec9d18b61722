#include <gtest/gtest.h>

#include <cmath>

#include "capstan/worlds/diagnosed_world.h"
#include "capstan/worlds/error_table.h"
#include "capstan/worlds/world_trial.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::arm_plan;

storage::DiagnosisRecord drag_diagnosis() {
    storage::DiagnosisRecord diagnosis;
    diagnosis.confidence_fraction = 0.9;
    diagnosis.friction_ratio = 1.2;
    diagnosis.causes = {
        {"viscous_friction", "", "cable_a", "", {}, {{"drag_Ns_per_m2", 4.0, "N s/m2", {}, {}}}}};
    return diagnosis;
}

std::size_t viscous() {
    std::size_t at = 0;
    while (effect_catalogue()[at].name != "viscous_friction") ++at;
    return at;
}

// The standard deviation over worlds of a number of each world.
template <class Number>
double spread_of(const StudyPlan& plan, const Number& number) {
    const WorldQuestion question = world_question(plan);
    constexpr int worlds = 200;
    double sum = 0.0;
    double squares = 0.0;
    for (std::uint32_t index = 0; index < worlds; ++index) {
        const double each = number(draw_world(question, index));
        sum += each / worlds;
        squares += each * each / worlds;
    }
    return std::sqrt(squares - sum * sum);
}

StudyPlan plan_about(const storage::DiagnosisRecord& diagnosis) {
    StudyPlan plan = arm_plan();
    plan.motion.samples = 40;
    const DiagnosedWorld found = world_of(diagnosis);
    plan.truth = found.truth;
    plan.uncertainty.truth_probability = found.probability;
    return plan;
}

double log_friction(const World& world) {
    return world.factors[0].log_friction;
}

TEST(DiagnosedWorld, DrawsFrictionFromTheIntervalOfTheFit) {
    storage::DiagnosisRecord diagnosis = drag_diagnosis();
    diagnosis.causes.clear();
    for (const double factor : {1.03, 1.3}) {
        diagnosis.friction_low_ratio = 1.2 / factor;
        diagnosis.friction_high_ratio = 1.2 * factor;
        EXPECT_NEAR(spread_of(plan_about(diagnosis), log_friction), std::log(factor) / 1.96,
                    0.12 * std::log(factor) / 1.96);
    }
}

TEST(DiagnosedWorld, WithoutIntervalsIsAsUncertainAsStated) {
    storage::DiagnosisRecord diagnosis = drag_diagnosis();
    diagnosis.causes.clear();
    EXPECT_EQ(spread_of(plan_about(diagnosis), log_friction), spread_of(arm_plan(), log_friction));
}

TEST(DiagnosedWorld, DrawsTheNumbersOfACauseFromTheirIntervals) {
    storage::DiagnosisRecord diagnosis = drag_diagnosis();
    auto& number = diagnosis.causes.front().numbers.front();
    number.name = effect_catalogue()[viscous()].parameters.front().name;
    const auto tension = [](const World& world) { return world.tensions_N(30).back(); };
    const double fixed = spread_of(plan_about(diagnosis), tension);
    number.low_in_unit = 0.0;
    number.high_in_unit = 8.0;
    const StudyPlan plan = plan_about(diagnosis);
    EXPECT_NEAR(plan.truth.effect_deviations[viscous()].front(), 8.0 / (2.0 * 1.96), 1e-3);
    EXPECT_NE(spread_of(plan, tension), fixed);
    EXPECT_EQ(plan.truth.effects[viscous()].front(), 4.0);
}

// What the estimator does not know of costs more where it lies in a wider interval.
TEST(DiagnosedWorld, AWiderIntervalGivesAWiderWorldAndALargerError) {
    double spread_before = 0.0;
    double error_before_N = 0.0;
    for (const double factor : {1.02, 1.3, 2.0}) {
        storage::DiagnosisRecord diagnosis = drag_diagnosis();
        diagnosis.causes.clear();
        diagnosis.friction_ratio = 1.0;
        diagnosis.friction_low_ratio = 1.0 / factor;
        diagnosis.friction_high_ratio = factor;
        const StudyPlan plan = plan_about(diagnosis);
        const WorldQuestion question = world_question(plan);
        double error_N = 0.0;
        for (std::uint32_t index = 0; index < 100; ++index) {
            const World world = draw_world(question, index);
            error_N += filter_error(question, question.belief, world, ensemble_draws(question, index),
                                    std::vector<int>{10})
                           .mean_abs_N;
        }
        const double spread = spread_of(plan, log_friction);
        EXPECT_GT(spread, spread_before);
        EXPECT_GT(error_N, error_before_N) << factor;
        spread_before = spread;
        error_before_N = error_N;
    }
}

TEST(DiagnosedWorld, IsAsProbableAsItsLeastProbableCauseIsPresent) {
    storage::DiagnosisRecord diagnosis = drag_diagnosis();
    diagnosis.causes[0].numbers[0].name = "drag";
    EXPECT_EQ(world_of(diagnosis).probability, 0.9);
    diagnosis.confidence_fraction = 0.49;  // two that are certain share it
    diagnosis.causes.push_back({"bending_stiffness", "", "conduit", "", {}, {{"drag", 0.2, "N/m", {}, {}}}});
    diagnosis.effects = {{"viscous_friction", 0.49, 0.98}, {"bending_stiffness", 0.48, 0.96}};
    EXPECT_EQ(world_of(diagnosis).probability, 0.96);
}

StudyPlan pair_about(const storage::DiagnosisRecord& diagnosis) {
    StudyPlan plan = testing::pair_plan();
    plan.transmission.cable.static_friction = plan.transmission.cable.dynamic_friction;
    plan.transmission.cable.segments = 40;
    plan.motion.samples = 40;
    plan.truth = world_of(diagnosis, CableArrangement::pull_pull).truth;
    return plan;
}

// Mean over worlds, samples and nodes of how far the tensions of one cable differ between two plans.
double difference_N(const StudyPlan& a, const StudyPlan& b, int cable) {
    const WorldQuestion questions[] = {world_question(a), world_question(b)};
    double sum_N = 0.0;
    int count = 0;
    for (std::uint32_t index = 0; index < 5; ++index) {
        const World worlds[] = {draw_world(questions[0], index), draw_world(questions[1], index)};
        EXPECT_EQ(worlds[0].unsolved_steps, 0);
        const int nodes = worlds[0].nodes / 2;
        for (int sample = 0; sample < worlds[0].samples(); ++sample) {
            for (int node = cable * nodes; node < (cable + 1) * nodes; ++node, ++count)
                sum_N += std::abs(worlds[0].tensions_N(sample)[static_cast<std::size_t>(node)] -
                                  worlds[1].tensions_N(sample)[static_cast<std::size_t>(node)]);
        }
    }
    return sum_N / count;
}

storage::DiagnosisRecord pair_diagnosis(const std::string& effect, const std::string& variant,
                                        const std::string& number, double value) {
    storage::DiagnosisRecord diagnosis;
    diagnosis.confidence_fraction = 1.0;
    diagnosis.causes = {
        {effect, variant, "conduit", "", {}, {{number, value, "", {}, {}}, {"middle", 0.5, "m", {}, {}}}}};
    return diagnosis;
}

TEST(DiagnosedWorld, OfAPairWithNextToNoDragIsThePairWithoutEffects) {
    const StudyPlan slight = pair_about(pair_diagnosis("viscous_friction", "", "drag", 1e-6));
    const StudyPlan strong = pair_about(pair_diagnosis("viscous_friction", "", "drag", 5000.0));
    const StudyPlan none = pair_about({});
    for (const int cable : {0, 1}) {
        EXPECT_LT(difference_N(slight, none, cable), 0.2);
        EXPECT_GT(difference_N(strong, none, cable), 0.5);
    }
}

TEST(DiagnosedWorld, OfAPairHasABendOfOneCableOnThatCableAlone) {
    const StudyPlan none = pair_about(pair_diagnosis("local_bend", "cable A", "angle", 1e-9));
    const StudyPlan of_a = pair_about(pair_diagnosis("local_bend", "cable A", "angle", 2.0));
    const StudyPlan of_b = pair_about(pair_diagnosis("local_bend", "cable B", "angle", 2.0));
    EXPECT_GT(difference_N(of_a, none, 0), 0.1);
    EXPECT_LT(difference_N(of_a, none, 1), 1e-6);
    EXPECT_LT(difference_N(of_b, none, 0), 1e-6);
    EXPECT_GT(difference_N(of_b, none, 1), 0.1);
}

TEST(DiagnosedWorld, DoesNotLeaveOutAWrongFrictionThatItsRatioHolds) {
    storage::DiagnosisRecord diagnosis = drag_diagnosis();
    diagnosis.causes = {{"param_mu", "", "parameter", "", {}, {}},
                        {"sensor_offset", "load_torque", "sensor:load_torque", "", {}, {}}};
    EXPECT_EQ(world_of(diagnosis).left_out, std::vector<std::string>{"sensor_offset, load_torque"});
}

TEST(DiagnosedWorld, CalibratedFrictionIsThatOfTheTruth) {
    StudyPlan plan = arm_plan(30);
    plan.truth.friction_ratio = 1.6;
    ErrorTable table(plan, {});
    const int one = table.candidate_of({0});  // tension at the motor
    const std::vector<int> candidates = {one};
    table.fill(Condition::as_stated, candidates, 0, 30, "");
    table.fill(Condition::friction_known, candidates, 0, 30, "");
    double stated = 0.0;
    double known = 0.0;
    for (int world = 0; world < 30; ++world) {
        stated += table.at(Condition::as_stated, one, world).mean_abs_N;
        known += table.at(Condition::friction_known, one, world).mean_abs_N;
    }
    EXPECT_LT(known, 0.9 * stated);
}

}  // namespace
}  // namespace capstan
