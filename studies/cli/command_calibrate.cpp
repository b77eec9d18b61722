#include <fmt/format.h>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/log_argument.h"
#include "capstan/cli/output.h"
#include "capstan/gap/calibration.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::cli {

namespace {

using gap::Calibration;
using gap::ChannelFit;
using gap::ParameterEstimate;
using nlohmann::ordered_json;

std::string_view said_of(const ParameterEstimate& estimate) {
    if (!estimate.fitted) return "not fitted";
    return estimate.identifiable ? "" : "not identifiable here: ";
}

std::string parameter_rows(const Calibration& calibration) {
    std::string text = fmt::format("  {:<18} {:>8}  {:>10}  {:>10}  {:>24}\n", "parameter", "unit", "nominal",
                                   "fitted", "95% interval");
    for (const ParameterEstimate& estimate : calibration.parameters) {
        const bool known = estimate.fitted && estimate.identifiable;
        text += fmt::format("  {:<18} {:>8}  {:>10.5g}  {:>10}  {:>24}  {}{}\n", estimate.parameter.name,
                            estimate.parameter.unit.empty() ? "-" : estimate.parameter.unit,
                            estimate.parameter.nominal, known ? fmt::format("{:.5g}", estimate.value) : "-",
                            known ? fmt::format("{:.5g} to {:.5g}", estimate.low, estimate.high) : "-",
                            said_of(estimate), estimate.reason);
    }
    return text;
}

std::string channel_rows(const Calibration& calibration) {
    std::string text = fmt::format("  {:>3}  {:<14} {:>5}  {:>9}  {:>10}  {:>10}  {:>10}\n", "run", "channel",
                                   "unit", "noise", "nominal", "fitted", "held out");
    for (const ChannelFit& fit : calibration.channels) {
        text +=
            fmt::format("  {:>3}  {:<14} {:>5}  {:>9}  {:>10.4g}  {:>10.4g}  {:>10}\n", fit.run, fit.channel,
                        fit.unit, fit.noise > 0.0 ? fmt::format("{:.4g}", fit.noise) : "-", fit.nominal_rms,
                        fit.calibrated_rms, fit.held_out ? fmt::format("{:.4g}", fit.held_out_rms) : "-");
    }
    return text;
}

std::string in_words(const Recording& recording, const Calibration& calibration) {
    std::string text = fmt::format("{}: {} runs, {} samples at {:g} Hz{}\n\n", recording.name,
                                   recording.runs.size(), recording.samples(), recording.sample_rate_Hz,
                                   calibration.converged ? "" : "; the fit did NOT converge");
    text +=
        parameter_rows(calibration) + "\nRMS of measured minus model\n" + channel_rows(calibration) + "\n";
    const std::string held_out =
        calibration.channels.empty() || !calibration.channels.front().held_out
            ? "There is one run only, so nothing could be held out."
            : "Held out: each run predicted with parameters fitted to all the others.";
    return text +
           wrapped(held_out +
                       " Intervals take residuals as hanging together within a second, and as wide "
                       "as the runs disagree.",
                   100, "", "") +
           "\n";
}

ordered_json in_json(const Recording& recording, const Calibration& calibration) {
    ordered_json json = {{"case", recording.name},
                         {"converged", calibration.converged},
                         {"unsolved_steps", calibration.unsolved_steps},
                         {"parameters", ordered_json::array()},
                         {"channels", ordered_json::array()}};
    for (const ParameterEstimate& estimate : calibration.parameters) {
        json["parameters"].push_back({{"name", estimate.parameter.name},
                                      {"unit", estimate.parameter.unit},
                                      {"meaning", estimate.parameter.meaning},
                                      {"nominal", estimate.parameter.nominal},
                                      {"value", estimate.value},
                                      {"low", estimate.low},
                                      {"high", estimate.high},
                                      {"fitted", estimate.fitted},
                                      {"identifiable", estimate.identifiable},
                                      {"reason", estimate.reason}});
    }
    for (const ChannelFit& fit : calibration.channels) {
        ordered_json row = {
            {"run", fit.run},     {"channel", fit.channel},         {"unit", fit.unit},
            {"noise", fit.noise}, {"nominal_rms", fit.nominal_rms}, {"calibrated_rms", fit.calibrated_rms}};
        if (fit.held_out) row["held_out_rms"] = fit.held_out_rms;
        json["channels"].push_back(row);
    }
    return json;
}

std::vector<std::string> split_at_commas(const std::string& text) {
    std::vector<std::string> parts;
    for (std::size_t first = 0; first <= text.size();) {
        const std::size_t end = std::min(text.find(',', first), text.size());
        if (end > first) parts.push_back(text.substr(first, end - first));
        first = end + 1;
    }
    return parts;
}

ExitCode run(const Invocation& invocation) {
    const Recording recording = read_recording(invocation.argument("LOG"));
    gap::CalibrationOptions options;
    options.threads = static_cast<int>(invocation.whole("jobs"));
    options.segments = static_cast<int>(invocation.whole("segments"));
    if (invocation.has("fit")) options.fitted = split_at_commas(invocation.text("fit"));
    const Calibration calibration = gap::calibrate(recording, options);
    const std::string json = json_text(in_json(recording, calibration));
    if (invocation.has("save")) write_file(invocation.text("save"), json);
    deliver(invocation, invocation.has("json") ? json : in_words(recording, calibration));
    return ExitCode::success;
}

}  // namespace

Command calibrate_command() {
    return {
        "calibrate",
        "Fit friction, stiffness and pretension to a recording.",
        "Moves the bench's model with the recording's driven channels and fits the model's parameters to the other "
        "channels, all at once. Prints each parameter with a 95% interval, or says that this recording does not "
        "confine it and which other parameter it trades with; then how well the model meets each channel of each run, "
        "with nominal and with fitted parameters, and with parameters fitted to the other runs only. Where the "
        "geometry is not known (mode lumped_drive) the model is a pull-pull pair with all wrap in one friction "
        "exponent.",
        {log_argument},
        {Option{"fit", '\0', OptionKind::text, "NAMES",
                "Fit these parameters only, separated by commas; the others stay nominal."},
         segments_option,
         Option{"save", '\0', OptionKind::text, "FILE",
                "Also write the parameters to FILE, for `capstan simulate LOG --parameters FILE`."},
         jobs_option, output_option, json_option, help_option},
        {"capstan calibrate bench.csv",
         "capstan calibrate bench.csv --fit dynamic_friction,pretension --json"},
        run};
}

}  // namespace capstan::cli
