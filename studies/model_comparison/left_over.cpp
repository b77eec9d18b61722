#include "capstan/model_comparison/left_over.h"

#include <algorithm>

#include "capstan/rig/channel_names.h"

namespace capstan::model_comparison {

namespace {

using simple_models::ModelledOutput;

std::string noun_of(const Channel& channel) {
    if (channel.unit == "N m") return "torque";
    if (channel.unit == "N") return "tension";
    return channel.unit == "rad" ? "angle" : channel_words(channel.name);
}

residual_law::ResidualNames names_of(const Recording& recording, const ModelledOutput& channels) {
    const Channel& output = recording.channels[channels.output];
    const Channel& motion = recording.channels[channels.motion];
    residual_law::ResidualNames names{channel_words(output.name),
                                      noun_of(output),
                                      output.unit,
                                      channel_words(motion.name),
                                      motion.unit,
                                      "load",
                                      ""};
    if (channels.load) {
        names.load = channel_words(recording.channels[*channels.load].name);
        names.load_unit = recording.channels[*channels.load].unit;
    }
    return names;
}

}  // namespace

residual_law::ResidualRun residual_run(const Recording& recording, std::size_t run,
                                       const ModelledOutput& channels, const Predictions& predictions) {
    const RecordedRun& recorded = recording.runs[run];
    residual_law::ResidualRun made;
    made.motion = recorded.values[channels.motion];
    if (channels.load) made.load = recorded.values[*channels.load];
    made.sample_period_s = 1.0 / recording.sample_rate_Hz;
    made.first_scored = simple_models::first_scored_sample(recorded);
    made.session_start_s = recorded.session_start_s;
    const std::vector<double>& predicted = predictions.values[run][channels.output];
    for (std::size_t sample = 0; sample < predicted.size(); ++sample)
        made.residual.push_back(recorded.values[channels.output][sample] - predicted[sample]);
    return made;
}

std::vector<LeftOver> fit_left_over(const Recording& recording, const Predictions& predictions) {
    std::vector<LeftOver> all;
    for (const std::size_t output : simple_models::output_channels(recording)) {
        const bool is_predicted = std::all_of(predictions.values.begin(), predictions.values.end(),
                                              [&](const auto& run) { return !run[output].empty(); });
        if (!is_predicted) continue;
        std::vector<LeftOver> choices;
        for (const ModelledOutput& channels : simple_models::possible_inputs(recording, output)) {
            std::vector<residual_law::ResidualRun> runs;
            for (std::size_t run = 0; run < recording.runs.size(); ++run)
                runs.push_back(residual_run(recording, run, channels, predictions));
            const residual_law::ResidualNames names = names_of(recording, channels);
            choices.push_back({channels, names, residual_law::fit_residual_law(runs, names)});
        }
        const auto best =
            std::min_element(choices.begin(), choices.end(), [](const LeftOver& one, const LeftOver& other) {
                return one.law.left_out_rms < other.law.left_out_rms;
            });
        if (best != choices.end()) all.push_back(std::move(*best));
    }
    return all;
}

std::vector<std::vector<double>> with_law(const Recording& recording, const Predictions& corrected,
                                          const LeftOver& left) {
    std::vector<std::vector<double>> values;
    for (std::size_t run = 0; run < corrected.values.size(); ++run) {
        values.push_back(corrected.values[run][left.channels.output]);
        if (values.back().empty()) continue;
        const std::vector<double> added =
            left.law.predict(residual_run(recording, run, left.channels, corrected));
        for (std::size_t sample = 0; sample < added.size(); ++sample) values[run][sample] += added[sample];
    }
    return values;
}

}  // namespace capstan::model_comparison
