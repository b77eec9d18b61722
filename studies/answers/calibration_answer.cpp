#include <fmt/format.h>

#include "capstan/answers/recording_answers.h"

namespace capstan::answers {

namespace {

using gap::Calibration;
using gap::ParameterEstimate;
using reports::Data;

Data parameter_data(const ParameterEstimate& estimate) {
    const bool known = estimate.fitted && estimate.identifiable;
    std::string remark = estimate.reason;
    if (!estimate.fitted)
        remark = "not fitted";
    else if (!estimate.identifiable)
        remark = "not identifiable from this recording: " + estimate.reason;
    return {{"name", estimate.parameter.name},
            {"unit", estimate.parameter.unit},
            {"meaning", estimate.parameter.meaning},
            {"nominal", estimate.parameter.nominal},
            {"value", estimate.value},
            {"low", estimate.low},
            {"high", estimate.high},
            {"known_value", known ? Data(estimate.value) : Data()},
            {"interval_95", known ? Data::list({estimate.low, estimate.high}) : Data()},
            {"fitted", estimate.fitted},
            {"identifiable", estimate.identifiable},
            {"reason", estimate.reason},
            {"remark", remark}};
}

Data channel_data(const gap::ChannelFit& fit) {
    return {{"run", fit.run},
            {"channel", fit.channel},
            {"unit", fit.unit},
            {"noise", fit.noise > 0.0 ? Data(fit.noise) : Data()},
            {"nominal_rms", fit.nominal_rms},
            {"calibrated_rms", fit.calibrated_rms},
            {"held_out_rms", fit.held_out ? Data(fit.held_out_rms) : Data()}};
}

std::string headline_of(const Recording& recording, const Calibration& calibration) {
    int identified = 0;
    for (const ParameterEstimate& estimate : calibration.parameters)
        identified += estimate.fitted && estimate.identifiable ? 1 : 0;
    return fmt::format("{} of {} parameters are identified by {} {} ({} samples at {:g} Hz).{}", identified,
                       calibration.parameters.size(), recording.runs.size(),
                       recording.runs.size() == 1 ? "run" : "runs", recording.samples(),
                       recording.sample_rate_Hz, calibration.converged ? "" : " The fit did not converge.");
}

}  // namespace

reports::Answer calibration_answer(const Recording& recording, const Calibration& calibration) {
    reports::Answer answer{.id = "calibration",
                           .kind = "Parameters fitted to a recording",
                           .title = recording.name,
                           .headline = headline_of(recording, calibration)};
    answer.values = {{"case", recording.name},
                     {"converged", calibration.converged},
                     {"unsolved_steps", calibration.unsolved_steps},
                     {"parameters", Data::list()},
                     {"channels", Data::list()}};
    for (const ParameterEstimate& estimate : calibration.parameters)
        answer.values["parameters"].push_back(parameter_data(estimate));
    for (const gap::ChannelFit& fit : calibration.channels)
        answer.values["channels"].push_back(channel_data(fit));
    const bool held_out = !calibration.channels.empty() && calibration.channels.front().held_out;
    answer.sections = {
        {.id = "parameters",
         .heading = "Parameters",
         .tables = {{"parameters",
                     "",
                     {{"name", "parameter"},
                      {"unit", "unit"},
                      {"nominal", "nominal", "", ".5g"},
                      {"known_value", "fitted", "", ".5g"},
                      {"interval_95", "95% interval", "", ".5g"},
                      {"remark", "remark"}},
                     answer.values["parameters"]}}},
        {.id = "channels",
         .heading = "RMS of measured minus modelled",
         .tables = {{"channels",
                     "",
                     {{"run", "run"},
                      {"channel", "channel"},
                      {"unit", "unit"},
                      {"noise", "noise"},
                      {"nominal_rms", "nominal"},
                      {"calibrated_rms", "fitted"},
                      {"held_out_rms", "held out"}},
                     answer.values["channels"]}},
         .note =
             (held_out ? std::string("Held out: each run predicted with parameters fitted to all other runs.")
                       : std::string("There is only one run, so that nothing could be held out.")) +
             " The intervals treat residuals within a second as dependent, and are at least as wide as the "
             "runs disagree."}};
    return answer;
}

}  // namespace capstan::answers
