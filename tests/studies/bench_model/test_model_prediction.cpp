#include <gtest/gtest.h>

#include "capstan/bench_model/model_file.h"
#include "capstan/bench_model/model_prediction.h"
#include "capstan/cable/invalid_input.h"
#include "full_model.h"
#include "lumped_session.h"
#include "session_with_effects.h"

namespace capstan::bench_model {
namespace {

using model_comparison::runs_of;

// The recording and diagnosis of a bench that is exactly as the diagnosis says.
model_comparison::DiagnosedSplit exact_split() {
    model_comparison::DiagnosedSplit split = full_split();
    split.recorded = gap::exact_session(split.diagnosis.corrected, {.segments = 40});
    split.bench = split.recorded;
    split.split = {{1}, {2}};
    split.diagnosed = runs_of(split.recorded, {1});
    return split;
}

TEST(ModelPrediction, MeetsABenchThatIsAsTheModelSays) {
    const model_comparison::DiagnosedSplit split = exact_split();
    const BenchModel model = model_of(split, {}, {"bench", {1}, "", ""}, {});
    const ModelPrediction prediction = predict(model, split.recorded, 1);
    ASSERT_EQ(prediction.errors.size(), 6u);  // two runs, three channels
    for (const ChannelError& error : prediction.errors) {
        EXPECT_LT(error.model_rms, 1e-9 * error.span) << error.channel;
        EXPECT_GT(error.nominal_rms, 1e-3 * error.span) << error.channel;
        EXPECT_EQ(error.was_fitted, error.run == 0);
        EXPECT_FALSE(error.with_law_rms);
    }
}

// What `capstan diagnose --fit --hold` reports of the runs held out.
void expect_the_errors_of(const model_comparison::DiagnosedSplit& split) {
    model_comparison::ModelComparison comparison;
    add_split(comparison, split, model_comparison::Compared::bench_alone, {});
    const Recording fitted = runs_of(split.recorded, split.split.fit);
    model_comparison::Predictions corrected = model_comparison::in_recorded_channels(
        split.recorded, split.bench,
        model_comparison::bench_runs(split.bench, split.diagnosis.corrected, {}));
    corrected.values.resize(split.split.fit.size());
    const BenchModel model =
        parse_model(model_text(model_of(split, fit_left_over(fitted, corrected),
                                        {split.recorded.name, split.split.fit, "", ""}, {})),
                    "m.toml");
    const Recording held_out = runs_of(split.recorded, split.split.hold);
    const ModelPrediction prediction = predict(model, held_out, 1);
    ASSERT_FALSE(comparison.outputs.empty());
    for (const model_comparison::OutputComparison& output : comparison.outputs) {
        const auto channel = static_cast<std::size_t>(*held_out.channel(output.channel));
        for (const ChannelError& error : prediction.errors) {
            if (error.channel != channel) continue;
            EXPECT_FALSE(error.was_fitted);
            for (const model_comparison::ModelErrors& each : output.models) {
                const double predicted = each.name == "corrected" ? error.model_rms
                                         : each.name == "corrected_with_law"
                                             ? error.with_law_rms.value_or(error.model_rms)
                                             : error.nominal_rms;
                EXPECT_EQ(predicted, each.held_out.at(error.run).rms) << output.channel << " " << each.name;
            }
        }
    }
}

TEST(ModelPrediction, HasTheErrorsThatTheDiagnosisReportsOfRunsHeldOut) {
    model_comparison::DiagnosedSplit split = exact_split();
    split.diagnosis.corrected.friction_ratio *= 1.1;  // the diagnosis is not exact
    expect_the_errors_of(split);
}

// What differs between runs is not known of another one, which gets the mean.
TEST(ModelPrediction, HasThemWhereANumberDiffersBetweenRuns) {
    model_comparison::DiagnosedSplit split = exact_split();
    gap::BenchNumbers& corrected = split.diagnosis.corrected;
    corrected.follows.push_back({.what = gap::BenchNumbers::Following::What::pretension,
                                 .of_runs = {{1, 0.0}, {3, odd_number(0.2)}}});
    const double in_run_2 = corrected.in_run(split.recorded.runs[1]).pretension_ratio;
    EXPECT_NEAR(in_run_2 / corrected.pretension_ratio, std::exp(0.5 * odd_number(0.2)), 1e-12);
    expect_the_errors_of(split);
}

TEST(ModelPrediction, HasThemForADriveOfUnknownGeometryToo) {
    const Recording session = gap::lumped_session({.motor_torque_sign = -1.0});
    model_comparison::DiagnosedSplit split;
    split.split = {{1}, {2}};
    split.recorded = session;
    split.equivalence = gap::fit_equivalence(runs_of(session, {1}));
    split.bench = gap::as_bench(session, *split.equivalence);
    split.diagnosed = runs_of(split.bench, {1});
    split.diagnosis.corrected.friction_ratio = odd_number(0.9);
    split.diagnosis.corrected.sensor_faults["motor_torque"].offset = odd_number(0.01);
    split.diagnosis.ranked = {{"sensor_offset", 1.0, 1.0, ""}};
    expect_the_errors_of(split);
}

TEST(ModelPrediction, RejectsARecordingOfAnotherKindOfBench) {
    EXPECT_THROW(predict(full_model(), gap::lumped_session({}), 1), InvalidInput);
}

TEST(ModelPrediction, SaysWhereAConditionIsNotStatedOrWasNotSeen) {
    Recording recording = gap::exact_session({}, {.segments = 24});
    recording.runs[1].conditions["roll_deg"] = 300.0;
    const std::vector<std::string> notes = predict(full_model(), recording, 1).notes;
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_NE(notes[0].find("Run 1 does not state roll_deg"), std::string::npos);
    EXPECT_NE(notes[1].find("outside of"), std::string::npos);
}

TEST(ModelPrediction, LeavesOutASensorThatTheRecordingDoesNotHave) {
    BenchModel model = full_model();
    model.sensors.push_back({"tension_9", {{"offset", "N", 1.0}}});
    const Recording recording = gap::exact_session({}, {.segments = 24});
    const std::vector<std::string> notes = predict(model, recording, 1).notes;
    EXPECT_NE(notes.back().find("has no tension_9"), std::string::npos);
}

}  // namespace
}  // namespace capstan::bench_model
