#include <gtest/gtest.h>

#include "capstan/cable/invalid_input.h"
#include "capstan/model_comparison/diagnosis_cost.h"
#include "lumped_session.h"

namespace capstan::model_comparison {
namespace {

constexpr double no_pilot_s = 0.0;  // one simulation is timed

TEST(DiagnosisCost, IsOfTheRunsThatAreFitted) {
    const Recording session = gap::lumped_session({});
    const DiagnosisCost all = predict_diagnosis_cost(session, {}, {}, no_pilot_s);
    const DiagnosisCost one = predict_diagnosis_cost(session, {.fit = {1}, .hold = {2}}, {}, no_pilot_s);
    EXPECT_EQ(all.runs, 2);
    EXPECT_EQ(one.runs, 1);
    EXPECT_EQ(one.samples, session.runs.front().samples());
    EXPECT_EQ(all.samples, session.runs[0].samples() + session.runs[1].samples());
    EXPECT_GT(all.causes, 10);
}

TEST(DiagnosisCost, IsManySimulationsOfTheRecording) {
    gap::DiagnosisOptions options;
    options.threads = 1;
    const DiagnosisCost cost = predict_diagnosis_cost(gap::lumped_session({}), {}, options, no_pilot_s);
    EXPECT_GT(cost.simulation_s, 0.0);
    EXPECT_GT(cost.min_seconds, 100.0 * cost.simulation_s);
    EXPECT_GT(cost.max_seconds, cost.min_seconds);
}

TEST(DiagnosisCost, EndsAtTheTimeLimit) {
    gap::DiagnosisOptions options;
    options.time_limit_s = 1e-6;
    const DiagnosisCost cost = predict_diagnosis_cost(gap::lumped_session({}), {}, options, no_pilot_s);
    EXPECT_EQ(cost.max_seconds, options.time_limit_s);
    EXPECT_LE(cost.min_seconds, cost.max_seconds);
}

TEST(DiagnosisCost, ThrowsForARunThatIsMissing) {
    EXPECT_THROW(predict_diagnosis_cost(gap::lumped_session({}), {.runs = {7}}, {}, no_pilot_s),
                 InvalidInput);
}

}  // namespace
}  // namespace capstan::model_comparison
