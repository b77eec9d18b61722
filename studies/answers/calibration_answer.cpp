#include <fmt/format.h>

#include <algorithm>

#include "capstan/answers/recording_answers.h"
#include "capstan/bench_model/calibration_numbers.h"
#include "capstan/effects/known_causes.h"

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

void add_model_of_calibration(reports::Answer& answer, const bench_model::BenchModel& model) {
    Data rows = Data::list();
    const std::vector<gap::FittedNumber> numbers = calibration_numbers(model);
    for (const Data& fitted : answer.values["parameters"].items()) {
        for (const gap::FittedNumber& number : numbers) {
            if (*fitted.find("name")->text() != number.name) continue;
            Data agree;  // nothing where one of the two has no interval
            if (number.interval && !fitted.find("interval_95")->is_nothing())
                agree = number.interval->low <= *fitted.find("high")->number() &&
                        *fitted.find("low")->number() <= number.interval->high;
            rows.push_back(
                {{"name", number.name},
                 {"unit", number.unit},
                 {"known_value", *fitted.find("known_value")},
                 {"interval_95", *fitted.find("interval_95")},
                 {"model", number.value},
                 {"model_interval_95",
                  number.interval ? Data::list({number.interval->low, number.interval->high}) : Data()},
                 {"agree", agree},
                 {"agree_words", agree.is_nothing() ? Data() : Data(*agree.boolean() ? "yes" : "no")}});
        }
    }
    std::vector<std::string> effects;
    for (const bench_model::ModelEffect& effect : model.effects) {
        const std::string title = cause_title(effect.name);
        if (std::find(effects.begin(), effects.end(), title) == effects.end()) effects.push_back(title);
    }
    answer.values["model"] = {{"recording", model.origin.recording},
                              {"runs", model.origin.runs},
                              {"parameters", rows},
                              {"effects", effects}};
    std::string note = "The search started at the model's numbers. They agree where the intervals overlap.";
    if (!effects.empty())
        note += fmt::format(
            " The calibrated bench has none of the model's effects ({}), and its numbers may stand in for them.",
            fmt::join(effects, ", "));
    answer.sections.insert(answer.sections.begin() + 1,
                           {.id = "model",
                            .heading = fmt::format("Beside the model of {}", model.origin.recording),
                            .tables = {{"model",
                                        "",
                                        {{"name", "parameter"},
                                         {"unit", "unit"},
                                         {"known_value", "fitted", "", ".5g"},
                                         {"interval_95", "95% interval", "", ".5g"},
                                         {"model", "model", "", ".5g"},
                                         {"model_interval_95", "95% interval", "", ".5g"},
                                         {"agree_words", "agree"}},
                                        rows}},
                            .note = note});
}

}  // namespace capstan::answers
