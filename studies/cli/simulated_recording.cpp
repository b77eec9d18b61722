#include "capstan/cli/simulated_recording.h"

#include <fmt/format.h>

#include <iterator>

#include "capstan/cable/invalid_input.h"
#include "capstan/cli/output.h"
#include "capstan/cli/page_recording.h"
#include "capstan/gap/parameter_file.h"
#include "capstan/gap/twin.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::cli {

namespace {

using gap::TwinRun;

// What a run was driven by and what the model says to it, channel by channel.
std::vector<std::vector<double>> fed_and_predicted(const Recording& recording, std::size_t run,
                                                   const TwinRun& twin) {
    DrivenInputs inputs = driven_inputs(recording, recording.runs[run]);
    std::vector<std::vector<double>> values = twin.values;
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        if (!inputs.values[channel].empty()) values[channel] = std::move(inputs.values[channel]);
    }
    return values;
}

std::string head_line(const Recording& recording) {
    std::string line = "run,t";
    for (const Channel& channel : recording.channels) line += "," + channel.name;
    return line + "\n";
}

void append_run(std::string& text, const RecordedRun& run, const std::vector<std::vector<double>>& values) {
    auto out = std::back_inserter(text);
    for (std::size_t sample = 0; sample < run.time_s.size(); ++sample) {
        fmt::format_to(out, "{},{}", run.number, run.time_s[sample]);
        for (const std::vector<double>& channel : values) {
            if (channel.empty()) {
                fmt::format_to(out, ",");
            } else {
                fmt::format_to(out, ",{}", channel[sample]);
            }
        }
        text += "\n";
    }
}

}  // namespace

ExitCode simulate_recording(const Invocation& invocation) {
    const Recording recording = read_recording(invocation.argument("CONFIG"));
    const auto twin = gap::make_twin(recording, static_cast<int>(invocation.whole("segments")));
    std::vector<double> values = gap::nominal_values(*twin);
    if (invocation.has("parameters"))
        values = gap::read_parameter_values(invocation.text("parameters"), twin->parameters());
    std::string text = head_line(recording);
    std::vector<TwinRun> modelled;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        modelled.push_back(twin->run(run, values));
        append_run(text, recording.runs[run], fed_and_predicted(recording, run, modelled.back()));
    }
    deliver_page(invocation,
                 [&] { return reports::experiment_page_html(recording_page(recording, modelled)); });
    deliver(invocation, text);
    return ExitCode::success;
}

}  // namespace capstan::cli
