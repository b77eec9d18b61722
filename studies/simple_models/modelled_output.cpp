#include "capstan/simple_models/modelled_output.h"

#include <algorithm>

#include "capstan/recording/channel_range.h"
#include "capstan/rig/channel_names.h"

namespace capstan::simple_models {

namespace {

constexpr double forgetting_s = 1.0;

bool is_motion(const Channel& channel) {
    return channel.unit == "rad" || channel.unit == "m";
}

bool is_predicted(const Recording& recording, std::size_t index) {
    const std::string& name = recording.channels[index].name;
    const bool of_a_model =
        recording.mode == BenchMode::capstan_band
            ? name == "tension_1" || name == "tension_2"
            : name == channel::motor_current ||
                  std::find(channel::all.begin(), channel::all.end(), name) != channel::all.end() ||
                  std::any_of(recording.tension_sensors.begin(), recording.tension_sensors.end(),
                              [&](const TensionSensor& sensor) { return sensor.channel == name; });
    return of_a_model && std::none_of(recording.runs.begin(), recording.runs.end(),
                                      [&](const RecordedRun& run) { return run.drives(name); });
}

}  // namespace

std::vector<std::size_t> output_channels(const Recording& recording) {
    std::vector<std::size_t> outputs;
    for (std::size_t index = 0; index < recording.channels.size(); ++index)
        if (is_predicted(recording, index)) outputs.push_back(index);
    return outputs;
}

std::vector<ModelledOutput> possible_inputs(const Recording& recording, std::size_t output) {
    std::vector<std::size_t> driven;
    for (std::size_t index = 0; index < recording.channels.size(); ++index) {
        const bool always =
            std::all_of(recording.runs.begin(), recording.runs.end(),
                        [&](const RecordedRun& run) { return run.drives(recording.channels[index].name); });
        if (always && index != output && largest_span(recording, index) > 0.0) driven.push_back(index);
    }
    std::vector<ModelledOutput> choices;
    for (const std::size_t motion : driven) {
        if (driven.size() == 1) choices.push_back({output, motion});
        for (const std::size_t load : driven) {
            if (load == motion) continue;
            const bool usual = is_motion(recording.channels[motion]) && !is_motion(recording.channels[load]);
            if (recording.nominal || usual) choices.push_back({output, motion, load});
        }
    }
    return choices;
}

std::size_t first_scored_sample(const RecordedRun& run) {
    const auto first = std::find_if(run.time_s.begin(), run.time_s.end(), [&](double time_s) {
        return time_s - run.time_s.front() >= forgetting_s;
    });
    return static_cast<std::size_t>(first - run.time_s.begin());
}

}  // namespace capstan::simple_models
