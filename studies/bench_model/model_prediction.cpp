#include "capstan/bench_model/model_prediction.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/cable/invalid_input.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/simple_models/simple_models.h"

namespace capstan::bench_model {

namespace {

using model_comparison::Predictions;

// The bench without what the diagnosis found: as the recording describes it, if it does.
Recording nominal_bench(const BenchModel& model, const Recording& recording, const Recording& bench) {
    Recording nominal = bench;
    if (!model.is_of_unknown_geometry() && recording.nominal) nominal.nominal = recording.nominal;
    return nominal;
}

// The channels that a law is a function of, where the recording has them all.
std::optional<model_comparison::LeftOver> law_for(const ModelLaw& law, const Recording& recording) {
    const auto output = recording.channel(law.channel);
    const auto motion = recording.channel(law.motion);
    const auto load = recording.channel(law.load);
    if (!law.law.holds() || !output || !motion || (!law.load.empty() && !load)) return {};
    model_comparison::LeftOver left;
    left.channels.output = static_cast<std::size_t>(*output);
    left.channels.motion = static_cast<std::size_t>(*motion);
    if (load) left.channels.load = static_cast<std::size_t>(*load);
    left.law = law.law;
    return left;
}

Predictions laws_added(const BenchModel& model, const Recording& recording, const Predictions& corrected) {
    Predictions with_law;
    for (const RecordedRun& run : recording.runs) with_law.values.emplace_back(run.values.size());
    for (const ModelLaw& law : model.laws) {
        const auto left = law_for(law, recording);
        if (!left) continue;
        const auto values = model_comparison::with_law(recording, corrected, *left);
        for (std::size_t run = 0; run < values.size(); ++run)
            with_law.values[run][left->channels.output] = values[run];
    }
    return with_law;
}

double span_of(const RecordedRun& run, std::size_t channel) {
    const auto first = static_cast<std::ptrdiff_t>(simple_models::first_scored_sample(run));
    const auto [low, high] =
        std::minmax_element(run.values[channel].begin() + first, run.values[channel].end());
    return *high - *low;
}

std::vector<ChannelError> errors_of(const ModelPrediction& prediction, const BenchModel& model,
                                    const Recording& recording) {
    std::vector<ChannelError> errors;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const RecordedRun& recorded = recording.runs[run];
        if (simple_models::first_scored_sample(recorded) >= recorded.time_s.size()) continue;
        const auto rms = [&](const Predictions& of, std::size_t channel) {
            return simple_models::scored_rms(recorded, channel, of.values[run][channel]);
        };
        const std::vector<int>& fitted = model.origin.runs;
        const bool was_fitted = recording.name == model.origin.recording &&
                                std::find(fitted.begin(), fitted.end(), recorded.number) != fitted.end();
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            if (prediction.model.values[run][channel].empty()) continue;
            ChannelError error{run,
                               channel,
                               was_fitted,
                               span_of(recorded, channel),
                               rms(prediction.nominal, channel),
                               rms(prediction.model, channel),
                               {}};
            if (!prediction.with_law.values[run][channel].empty())
                error.with_law_rms = rms(prediction.with_law, channel);
            errors.push_back(error);
        }
    }
    return errors;
}

std::vector<std::string> notes_on(const BenchModel& model, const Recording& recording) {
    std::vector<std::string> notes;
    if (model.recorded_mode == BenchMode::lumped_drive)
        notes.push_back("The zero of the load angle is not known; it is set anew in each run.");
    for (const ModelFollowing& follows : model.follows) {
        for (const RecordedRun& run : recording.runs) {
            const auto stated = run.conditions.find(follows.condition);
            if (stated == run.conditions.end())
                notes.push_back(fmt::format(
                    "Run {} does not state {}, which numbers of the model follow; the middle of its range, "
                    "{:.4g}, is taken.",
                    run.number, follows.condition, follows.middle));
            else if (std::abs(stated->second - follows.middle) > 1.001 * follows.half_range)
                notes.push_back(fmt::format(
                    "In run {}, {} is {:.4g}, outside of the {:.4g} to {:.4g} that the model was fitted to.",
                    run.number, follows.condition, stated->second, follows.middle - follows.half_range,
                    follows.middle + follows.half_range));
        }
    }
    for (const ModelSensor& sensor : model.sensors) {
        if (!recording.channel(sensor.channel))
            notes.push_back(
                fmt::format("The recording has no {}, whose sensor the model corrects.", sensor.channel));
    }
    return notes;
}

}  // namespace

Recording recording_of_bench(const BenchModel& model, const Recording& recording) {
    if (recording.mode != model.recorded_mode)
        throw InvalidInput({fmt::format(
            "{}: the recording is of a bench of the kind {}, and the model is of one of the kind {}, recorded "
            "in {}; a model predicts recordings of its own bench",
            recording.name, mode_name(recording.mode), mode_name(model.recorded_mode),
            model.origin.recording)});
    if (model.is_of_unknown_geometry()) return gap::as_bench(recording, model.description);
    Recording bench = recording;
    bench.nominal = model.description.bench;
    for (RecordedRun& run : bench.runs)
        if (!run.pretension_N) run.pretension_N = model.description.pretension_N;
    return bench;
}

gap::BenchNumbers numbers_for(const BenchModel& model, const Recording& recording) {
    gap::BenchNumbers numbers = model.numbers();
    const auto is_missing = [&](const auto& of_channel) { return !recording.channel(of_channel.first); };
    std::erase_if(numbers.sensor_faults, is_missing);
    std::erase_if(numbers.follows, [&](const gap::BenchNumbers::Following& each) {
        return each.what == gap::BenchNumbers::Following::What::zero && !recording.channel(each.channel);
    });
    return numbers;
}

ModelPrediction predict(const BenchModel& model, const Recording& recording, int threads) {
    gap::CauseSearchOptions options;
    options.segments = model.segments;
    options.threads = threads;
    const Recording bench = recording_of_bench(model, recording);
    const Recording nominal = nominal_bench(model, recording, bench);
    const auto predicted = [&](const Recording& driven, const gap::BenchNumbers& numbers) {
        return model_comparison::in_recorded_channels(recording, driven,
                                                      model_comparison::bench_runs(driven, numbers, options));
    };
    ModelPrediction prediction;
    prediction.nominal = predicted(nominal, {});
    prediction.model = predicted(bench, numbers_for(model, bench));
    prediction.with_law = laws_added(model, recording, prediction.model);
    prediction.errors = errors_of(prediction, model, recording);
    prediction.notes = notes_on(model, recording);
    return prediction;
}

}  // namespace capstan::bench_model
