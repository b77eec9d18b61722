#include "capstan/model_comparison/model_comparison.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/simple_models/simple_models.h"

namespace capstan::model_comparison {

namespace {

// A model's predictions of one channel.
struct PredictedOutput {
    ModelErrors model;                        // without errors
    std::vector<std::vector<double>> values;  // runs x samples
};

std::vector<std::vector<double>> of_channel(const Predictions& predictions, std::size_t channel) {
    std::vector<std::vector<double>> values;
    for (const auto& run : predictions.values) values.push_back(run[channel]);
    return values;
}

OutputComparison& output_of(ModelComparison& comparison, const Channel& channel) {
    for (OutputComparison& each : comparison.outputs)
        if (each.channel == channel.name) return each;
    comparison.outputs.push_back({channel.name, channel.unit, {}});
    return comparison.outputs.back();
}

void add_errors(OutputComparison& output, const DiagnosedSplit& split, std::size_t channel,
                const PredictedOutput& predicted) {
    auto model = std::find_if(output.models.begin(), output.models.end(),
                              [&](const ModelErrors& each) { return each.name == predicted.model.name; });
    if (model == output.models.end()) model = output.models.insert(output.models.end(), predicted.model);
    for (std::size_t run = 0; run < split.recorded.runs.size(); ++run) {
        const RecordedRun& recorded = split.recorded.runs[run];
        if (simple_models::first_scored_sample(recorded) >= recorded.time_s.size()) continue;
        std::vector<RunError>& errors = run < split.split.fit.size() ? model->fitted : model->held_out;
        errors.push_back(
            {recorded.number, simple_models::scored_rms(recorded, channel, predicted.values[run])});
    }
    for (std::vector<RunError>* errors : {&model->fitted, &model->held_out})
        std::sort(errors->begin(), errors->end(),
                  [](const RunError& one, const RunError& other) { return one.run < other.run; });
}

}  // namespace

std::vector<RunSplit> alternating_splits(const Recording& recording) {
    RunSplit odd;
    for (std::size_t run = 0; run < recording.runs.size(); ++run)
        (run % 2 == 0 ? odd.fit : odd.hold).push_back(recording.runs[run].number);
    if (odd.hold.empty()) return {odd};
    return {odd, {odd.hold, odd.fit}};
}

Recording runs_of(const Recording& recording, const std::vector<int>& numbers) {
    Recording some = recording;
    some.runs.clear();
    for (const int number : numbers) {
        const auto run = std::find_if(recording.runs.begin(), recording.runs.end(),
                                      [&](const RecordedRun& each) { return each.number == number; });
        if (run == recording.runs.end())
            throw InvalidInput({recording.name + ": there is no run " + std::to_string(number)});
        some.runs.push_back(*run);
    }
    return some;
}

DiagnosedSplit prepared_split(const Recording& recording, const RunSplit& split,
                              const std::vector<int>& calibrate_on) {
    std::vector<int> all = split.fit;
    all.insert(all.end(), split.hold.begin(), split.hold.end());
    DiagnosedSplit diagnosed{split, runs_of(recording, all), {}, {}, {}, {}};
    diagnosed.bench = diagnosed.recorded;
    if (gap::has_unknown_geometry(recording)) {
        diagnosed.equivalence =
            gap::fit_equivalence(runs_of(recording, calibrate_on.empty() ? split.fit : calibrate_on));
        diagnosed.bench = gap::as_bench(diagnosed.recorded, *diagnosed.equivalence);
    }
    diagnosed.diagnosed = runs_of(diagnosed.bench, split.fit);
    return diagnosed;
}

DiagnosedSplit diagnose_split(const Recording& recording, const RunSplit& split,
                              const gap::DiagnosisOptions& options, const std::vector<int>& calibrate_on) {
    DiagnosedSplit diagnosed = prepared_split(recording, split, calibrate_on);
    diagnosed.diagnosis = gap::diagnose(diagnosed.diagnosed, options);
    return diagnosed;
}

std::optional<double> rms_over_runs(const std::vector<RunError>& errors) {
    if (errors.empty()) return {};
    double squares = 0.0;
    for (const RunError& each : errors) squares += each.rms * each.rms;
    return std::sqrt(squares / static_cast<double>(errors.size()));
}

void add_split(ModelComparison& comparison, const DiagnosedSplit& split, Compared compared,
               const gap::DiagnosisOptions& options) {
    comparison.splits.push_back(split.split);
    const Recording& recording = split.recorded;
    const Recording fitted = runs_of(recording, split.split.fit);
    const gap::BenchNumbers& corrected_to = split.diagnosis.corrected;
    const Predictions uncorrected =
        in_recorded_channels(recording, split.bench, bench_runs(split.bench, {}, options));
    const Predictions corrected =
        in_recorded_channels(recording, split.bench, bench_runs(split.bench, corrected_to, options));
    Predictions corrected_fit = corrected;
    corrected_fit.values.resize(split.split.fit.size());
    const ModelErrors before =
        recording.nominal
            ? ModelErrors{"nominal", "nominal model of the bench", "nominal", "as the sidecar states it", {},
                          {}}
            : ModelErrors{"calibrated", "calibrated model of the bench",
                          "calibrated", "friction, stiffness, pretension and ratio fitted",
                          {},           {}};
    const ModelErrors after{
        "corrected", "corrected model", "corrected", "with the causes that the diagnosis found", {}, {}};
    const ModelErrors after_law{"corrected_with_law",
                                "corrected model and law",
                                "with law",
                                "with the law of what the corrected model leaves",
                                {},
                                {}};
    for (const LeftOver& left : fit_left_over(fitted, corrected_fit)) {
        const std::size_t channel = left.channels.output;
        OutputComparison& output = output_of(comparison, recording.channels[channel]);
        if (compared == Compared::with_simple_models) {
            for (const simple_models::SimpleModel& model :
                 simple_models::fit_simple_models(fitted, channel)) {
                PredictedOutput predicted{{model.name, model.title, model.heading, model.formula, {}, {}},
                                          {}};
                for (const RecordedRun& run : recording.runs) predicted.values.push_back(model.predict(run));
                add_errors(output, split, channel, predicted);
            }
        }
        add_errors(output, split, channel, {before, of_channel(uncorrected, channel)});
        add_errors(output, split, channel, {after, of_channel(corrected, channel)});
        add_errors(output, split, channel, {after_law, with_law(recording, corrected, left)});
    }
}

}  // namespace capstan::model_comparison
