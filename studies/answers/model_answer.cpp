// What a model of a bench says of a recording.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/answers/recording_answers.h"
#include "capstan/recording/channel_range.h"
#include "capstan/rig/channel_names.h"
#include "capstan/simple_models/modelled_output.h"

namespace capstan::answers {

namespace {

using bench_model::BenchModel;
using bench_model::ChannelError;
using bench_model::ModelPrediction;
using model_comparison::Predictions;
using reports::Data;
using reports::Table;

// Of all curves together: each takes about 60 bytes a sample, and the page stays below 3 MB.
constexpr std::size_t drawn_model_samples = 6000;
constexpr const char* before_series = "model without the diagnosis";
constexpr const char* after_series = "model";

std::string run_words(const std::vector<int>& runs) {
    return fmt::format("{} {}", runs.size() == 1 ? "run" : "runs", fmt::join(runs, ", "));
}

// The errors of one channel in the runs that the model was fitted to, or in the others. Runs count alike.
struct ErrorGroup {
    std::size_t channel = 0;
    bool was_fitted = false;
    std::vector<int> runs{};
    double span = 0.0;  ///< the largest of a run
    std::vector<model_comparison::RunError> nominal{};
    std::vector<model_comparison::RunError> model{};
    std::vector<model_comparison::RunError> with_law{};

    Data row(const Recording& recording) const {
        const Channel& described = recording.channels[channel];
        const auto rms = model_comparison::rms_over_runs(model);
        return {{"channel", described.name},
                {"unit", described.unit},
                {"fitted", was_fitted},
                {"fitted_words", was_fitted ? "fitted" : "not fitted"},
                {"runs", runs},
                {"rms_nominal", model_comparison::rms_over_runs(nominal)},
                {"rms_model", rms},
                {"rms_with_law", model_comparison::rms_over_runs(with_law)},
                {"span", span},
                {"fraction_of_span", span > 0.0 ? Data(*rms / span) : Data()}};
    }
};

std::vector<ErrorGroup> groups_of(const ModelPrediction& prediction, const Recording& recording) {
    std::vector<ErrorGroup> groups;
    for (const ChannelError& error : prediction.errors) {
        auto group = std::find_if(groups.begin(), groups.end(), [&](const ErrorGroup& each) {
            return each.channel == error.channel && each.was_fitted == error.was_fitted;
        });
        if (group == groups.end()) group = groups.insert(groups.end(), {error.channel, error.was_fitted});
        const int run = recording.runs[error.run].number;
        group->runs.push_back(run);
        group->span = std::max(group->span, error.span);
        group->nominal.push_back({run, error.nominal_rms});
        group->model.push_back({run, error.model_rms});
        if (error.with_law_rms) group->with_law.push_back({run, *error.with_law_rms});
    }
    std::stable_sort(groups.begin(), groups.end(), [](const ErrorGroup& one, const ErrorGroup& other) {
        return one.was_fitted < other.was_fitted;
    });
    return groups;
}

std::string headline_of(const BenchModel& model, const std::vector<ErrorGroup>& groups,
                        const Recording& recording) {
    if (groups.empty())
        return "The model predicts no channel of these runs, or all are shorter than a second.";
    // A force or a torque says more of a bench than an angle, most of which is the driven motion.
    const auto force = std::find_if(groups.begin(), groups.end(), [&](const ErrorGroup& each) {
        return each.was_fitted == groups.front().was_fitted && recording.channels[each.channel].unit != "rad";
    });
    const ErrorGroup& first = force != groups.end() ? *force : groups.front();
    const Channel& channel = recording.channels[first.channel];
    const double after = *model_comparison::rms_over_runs(first.model);
    const double before = *model_comparison::rms_over_runs(first.nominal);
    std::string text = fmt::format("The model of {} predicts the {} with an RMS error of {:.3g} {}",
                                   model.origin.recording, channel_words(channel.name), after, channel.unit);
    if (first.span > 0.0) text += fmt::format(" ({:.2g}% of its span)", 100.0 * after / first.span);
    text += fmt::format(" in {} that it was {}fitted to; without the diagnosis the error is {:.3g} {}.",
                        run_words(first.runs), first.was_fitted ? "" : "not ", before, channel.unit);
    return text;
}

Data run_rows(const ModelPrediction& prediction, const Recording& recording) {
    Data rows = Data::list();
    for (const ChannelError& error : prediction.errors) {
        const Channel& described = recording.channels[error.channel];
        rows.push_back(
            {{"run", recording.runs[error.run].number},
             {"channel", described.name},
             {"unit", described.unit},
             {"fitted", error.was_fitted},
             {"fitted_words", error.was_fitted ? "fitted" : "not fitted"},
             {"span", error.span},
             {"rms_nominal", error.nominal_rms},
             {"rms_model", error.model_rms},
             {"rms_with_law", error.with_law_rms},
             {"fraction_of_span", error.span > 0.0 ? Data(error.model_rms / error.span) : Data()}});
    }
    return rows;
}

struct ModelCurves {
    Table channel{
        "channel", "Measured and modelled channels", {"run", "channel", "time_s", "series", "value"}, {}};
    Table residual{
        "channel_residual", "Measured less modelled", {"run", "channel", "time_s", "series", "value"}, {}};
    Table loop{"loop",
               "Predicted channels over a driven one",
               {"run", "channel", "time_s", "series", "driven", "value"},
               {}};
};

// The driven channel over which a channel is drawn: the motion, if it moves in this run.
std::optional<std::size_t> driven_channel(const Recording& recording, const RecordedRun& run) {
    std::optional<std::size_t> found;
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const Channel& described = recording.channels[channel];
        if (!run.drives(described.name) || !(range_of(run.values[channel]).span() > 0.0)) continue;
        const bool is_motion = described.unit == "rad" || described.unit == "m";
        if (!found || is_motion) found = channel;
        if (is_motion && run.output != OutputKind::locked) break;
    }
    return found;
}

void add_curves(ModelCurves& curves, const ModelPrediction& prediction, const Recording& recording,
                const ChannelError& error, std::size_t limit) {
    const RecordedRun& run = recording.runs[error.run];
    const Channel& described = recording.channels[error.channel];
    const std::string name = drawn_name(described);
    const auto number = std::int64_t{run.number};
    const auto driven = driven_channel(recording, run);
    const std::vector<double>& measured = run.values[error.channel];
    const std::size_t every = reports::drawn_every(measured.size(), limit);
    const auto of = [&](const Predictions& predictions) -> const std::vector<double>& {
        return predictions.values[error.run][error.channel];
    };
    for (const auto& [series, values] : {std::pair{"measured", &measured},
                                         {before_series, &of(prediction.nominal)},
                                         {after_series, &of(prediction.model)}}) {
        for (std::size_t k = 0; k < values->size(); k += every) {
            curves.channel.rows.push_back({number, name, run.time_s[k], series, (*values)[k]});
            if (values != &measured)
                curves.residual.rows.push_back(
                    {number, name, run.time_s[k], series, measured[k] - (*values)[k]});
            if (driven)
                curves.loop.rows.push_back(
                    {number, fmt::format("{} over {}", name, drawn_name(recording.channels[*driven])),
                     run.time_s[k], series, run.values[*driven][k], (*values)[k]});
        }
    }
}

ModelCurves curves_of(const ModelPrediction& prediction, const Recording& recording) {
    ModelCurves curves;
    const std::size_t limit = drawn_model_samples / std::max<std::size_t>(1, prediction.errors.size());
    for (const ChannelError& error : prediction.errors)
        add_curves(curves, prediction, recording, error, limit);
    return curves;
}

}  // namespace

reports::Answer model_answer(const Recording& recording, const BenchModel& model,
                             const ModelPrediction& prediction) {
    const std::vector<ErrorGroup> groups = groups_of(prediction, recording);
    Data rows = Data::list();
    for (const ErrorGroup& group : groups) rows.push_back(group.row(recording));
    reports::Answer answer{.id = "model",
                           .kind = "A model of a bench, judged on a recording",
                           .title = recording.name,
                           .headline = headline_of(model, groups, recording)};
    const Data each_run = run_rows(prediction, recording);
    answer.values = {{"case", recording.name},
                     {"model",
                      {{"recording", model.origin.recording},
                       {"runs", model.origin.runs},
                       {"program_version", model.origin.program_version},
                       {"verdict", model.origin.verdict}}},
                     {"channels", rows},
                     {"runs", each_run},
                     {"notes", prediction.notes}};
    const std::string before = model.is_of_unknown_geometry() ? "calibrated" : "nominal";
    const std::vector<reports::Column> errors = {{"rms_nominal", before, "", ".4g"},
                                                 {"rms_model", "model", "", ".4g"},
                                                 {"rms_with_law", "with law", "", ".4g"},
                                                 {"unit", "unit"},
                                                 {"fraction_of_span", "of the span", "", ".2%"}};
    const auto table = [&](const char* id, const char* caption, std::vector<reports::Column> columns,
                           const Data& its_rows) {
        columns.insert(columns.end(), errors.begin(), errors.end());
        return reports::AnswerTable{id, caption, std::move(columns), its_rows};
    };
    std::string prose = fmt::format("The model was fitted to {} of {}. {}", run_words(model.origin.runs),
                                    model.origin.recording, model.origin.verdict);
    for (const std::string& note : prediction.notes) prose += " " + note;
    answer.sections = {
        {.id = "errors",
         .heading = "Errors",
         .prose = prose,
         .tables =
             {table("channels",
                    "RMS of measured minus predicted, from one second into each run; every run counts alike",
                    {worded_column("channel"), {"fitted_words", "runs"}, {"runs", "numbers"}}, rows),
              table("runs", "The same for each run",
                    {{"run", "run"}, worded_column("channel"), {"fitted_words", "runs"}}, each_run)},
         .note = fmt::format(
             "{}. With law: the model with the law of what the diagnosis left. The fraction of the span is that "
             "of the model, without a law; the span is the largest in a run.",
             model.is_of_unknown_geometry() ? "Calibrated: the equivalent bench before the diagnosis"
                                            : "Nominal: the bench as the recording's sidecar states it")},
        {.id = "runs", .heading = "Measured and predicted"},
        {.id = "loops", .heading = "Loops"}};
    ModelCurves curves = curves_of(prediction, recording);
    answer.drawn = {run_table(recording), std::move(curves.channel), std::move(curves.residual),
                    std::move(curves.loop)};
    return answer;
}

}  // namespace capstan::answers
