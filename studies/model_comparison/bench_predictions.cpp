#include "capstan/model_comparison/bench_predictions.h"

#include <algorithm>
#include <string>

#include "capstan/platform/parallel_for.h"
#include "capstan/rig/channel_names.h"

namespace capstan::model_comparison {

namespace {

// What a recorded channel is called on the equivalent bench.
std::string name_on_bench(const Recording& recording, const std::string& name) {
    if (name == channel::motor_current && !recording.channel(channel::motor_torque))
        return channel::motor_torque;
    if (recording.mode != BenchMode::capstan_band) return name;
    const bool second_drives = recording.runs.front().drives("tension_2");
    if (name == "tension_1") return second_drives ? channel::load_torque : channel::motor_torque;
    if (name == "tension_2") return second_drives ? channel::motor_torque : channel::load_torque;
    return "";
}

// A channel of the bench is `factor` times the recorded one plus `offset`, in each run.
struct Translation {
    double factor = 1.0;
    double offset = 0.0;
};

// From the samples themselves: both recordings hold the same ones.
Translation translation(const std::vector<double>& recorded, const std::vector<double>& on_bench) {
    const auto [low, high] = std::minmax_element(recorded.begin(), recorded.end());
    const auto at_low = static_cast<std::size_t>(low - recorded.begin());
    const auto at_high = static_cast<std::size_t>(high - recorded.begin());
    Translation between;
    if (*high > *low) between.factor = (on_bench[at_high] - on_bench[at_low]) / (*high - *low);
    between.offset = on_bench[at_low] - between.factor * *low;
    return between;
}

}  // namespace

std::vector<gap::TwinRun> bench_runs(const Recording& bench, const gap::BenchNumbers& numbers,
                                     const gap::CauseSearchOptions& options) {
    const gap::EffectsTwin twin(bench, {.segments = options.segments});
    std::vector<gap::TwinRun> runs(bench.runs.size());
    parallel_for_each_index(static_cast<int>(runs.size()), options.threads, [&](int run) {
        const auto at = static_cast<std::size_t>(run);
        runs[at] = twin.run(at, numbers);
    });
    return runs;
}

Predictions in_recorded_channels(const Recording& recording, const Recording& bench,
                                 const std::vector<gap::TwinRun>& runs) {
    Predictions predictions;
    for (std::size_t run = 0; run < runs.size(); ++run) {
        predictions.values.emplace_back(recording.channels.size());
        for (std::size_t index = 0; index < recording.channels.size(); ++index) {
            const auto there = bench.channel(name_on_bench(recording, recording.channels[index].name));
            if (!there) continue;
            const auto on_bench = static_cast<std::size_t>(*there);
            const std::vector<double>& predicted = runs[run].values[on_bench];
            if (predicted.empty()) continue;
            const Translation between =
                translation(recording.runs[run].values[index], bench.runs[run].values[on_bench]);
            for (const double value : predicted)
                predictions.values[run][index].push_back((value - between.offset) / between.factor);
        }
    }
    return predictions;
}

}  // namespace capstan::model_comparison
