#include "capstan/bench_model/prediction_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "capstan/bench_model/model_keys.h"

namespace capstan::bench_model {

namespace {

using Predicted = model_comparison::Predictions;

bool is_in_some_run(const Predicted& predictions, std::size_t channel) {
    return std::any_of(predictions.values.begin(), predictions.values.end(),
                       [&](const auto& run) { return !run[channel].empty(); });
}

// One column; no predictions stand for what was measured.
struct PredictionColumn {
    std::string name;
    std::size_t channel = 0;
    const Predicted* predictions = nullptr;
};

std::vector<PredictionColumn> columns_of(const Recording& recording, const ModelPrediction& prediction) {
    std::vector<PredictionColumn> columns;
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const Channel& described = recording.channels[channel];
        if (!is_in_some_run(prediction.model, channel)) continue;
        const auto add = [&](const char* what, const Predicted* predictions) {
            columns.push_back(
                {key_with_unit(described.name + "_" + what, described.unit), channel, predictions});
        };
        add("measured", nullptr);
        add("nominal", &prediction.nominal);
        add("model", &prediction.model);
        if (is_in_some_run(prediction.with_law, channel)) add("with_law", &prediction.with_law);
    }
    return columns;
}

}  // namespace

std::string prediction_csv(const Recording& recording, const ModelPrediction& prediction) {
    const std::vector<PredictionColumn> columns = columns_of(recording, prediction);
    std::string text = "run,time_s";
    for (const PredictionColumn& column : columns) text += "," + column.name;
    text += "\n";
    auto out = std::back_inserter(text);
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const RecordedRun& recorded = recording.runs[run];
        for (std::size_t sample = 0; sample < recorded.time_s.size(); ++sample) {
            fmt::format_to(out, "{},{}", recorded.number, recorded.time_s[sample]);
            for (const PredictionColumn& column : columns) {
                const std::vector<double>& values = column.predictions == nullptr
                                                        ? recorded.values[column.channel]
                                                        : column.predictions->values[run][column.channel];
                text += ",";
                if (!values.empty()) fmt::format_to(out, "{}", values[sample]);
            }
            text += "\n";
        }
    }
    return text;
}

}  // namespace capstan::bench_model
