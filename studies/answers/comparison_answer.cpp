// The model of a bench beside models that know nothing of it.
#include <fmt/format.h>

#include <algorithm>

#include "capstan/answers/recording_answers.h"
#include "capstan/rig/channel_names.h"

namespace capstan::answers {

namespace {

using model_comparison::ModelComparison;
using model_comparison::ModelErrors;
using model_comparison::OutputComparison;
using model_comparison::RunError;
using reports::Data;

std::string split_sentence(const ModelComparison& comparison) {
    const model_comparison::RunSplit& first = comparison.splits.front();
    const auto runs = [](const std::vector<int>& numbers) {
        return fmt::format("{} {}", numbers.size() == 1 ? "run" : "runs", fmt::join(numbers, ", "));
    };
    if (first.hold.empty())
        return fmt::format("Every model is fitted to {}; nothing is held out.", runs(first.fit));
    std::string text =
        fmt::format("Every model is fitted to {} and judged on {}", runs(first.fit), runs(first.hold));
    return text + (comparison.splits.size() > 1 ? ", then the other way round." : ".");
}

// The errors that count: of runs held out, where there are any.
std::optional<double> judged_error(const ModelErrors& model) {
    const auto held_out = rms_over_runs(model.held_out);
    return held_out ? held_out : rms_over_runs(model.fitted);
}

std::string best_sentence(const OutputComparison& output) {
    const auto error = [](const ModelErrors& model) {
        return judged_error(model).value_or(std::numeric_limits<double>::infinity());
    };
    const auto best = std::min_element(
        output.models.begin(), output.models.end(),
        [&](const ModelErrors& one, const ModelErrors& other) { return error(one) < error(other); });
    if (best == output.models.end()) return "";
    return fmt::format("The smallest error in the {} is that of \"{}\" ({:.3g} {}).",
                       channel_words(output.channel), best->title, error(*best), output.unit);
}

Data run_errors(const std::vector<RunError>& errors) {
    Data list = Data::list();
    for (const RunError& each : errors) list.push_back({{"run", each.run}, {"rms", each.rms}});
    return list;
}

Data comparison_data(const ModelComparison& comparison) {
    Data data = {{"splits", Data::list()}, {"models", Data::list()}};
    for (const model_comparison::RunSplit& split : comparison.splits)
        data["splits"].push_back({{"fit", split.fit}, {"hold", split.hold}});
    for (const OutputComparison& output : comparison.outputs) {
        for (const ModelErrors& model : output.models)
            data["models"].push_back({{"channel", output.channel},
                                      {"unit", output.unit},
                                      {"model", model.name},
                                      {"title", model.title},
                                      {"formula", model.formula},
                                      {"rms_fitted", rms_over_runs(model.fitted)},
                                      {"rms_held_out", rms_over_runs(model.held_out)},
                                      {"runs_fitted", run_errors(model.fitted)},
                                      {"runs_held_out", run_errors(model.held_out)}});
    }
    return data;
}

// One row for each run, one column for each model.
reports::AnswerTable run_error_table(const OutputComparison& output) {
    const bool held_out = !output.models.front().held_out.empty();
    reports::AnswerTable table{
        .id = "model_runs_" + output.channel,
        .caption = fmt::format("RMS of each {}run, {} [{}]", held_out ? "held-out " : "",
                               channel_words(output.channel), output.unit),
        .columns = {{"run", "run"}},
        .rows = Data::list()};
    for (const ModelErrors& model : output.models) {
        table.columns.push_back({model.name, model.heading, "", ".4g"});
        const std::vector<RunError>& errors = held_out ? model.held_out : model.fitted;
        for (std::size_t run = 0; run < errors.size(); ++run) {
            if (table.rows.items().size() == run) table.rows.push_back({{"run", errors[run].run}});
        }
    }
    Data rows = Data::list();
    for (std::size_t run = 0; run < table.rows.items().size(); ++run) {
        Data row = table.rows.items()[run];
        for (const ModelErrors& model : output.models)
            row[model.name] = (held_out ? model.held_out : model.fitted)[run].rms;
        rows.push_back(row);
    }
    table.rows = rows;
    return table;
}

reports::Table error_table(const ModelComparison& comparison) {
    reports::Table table{"model_error", "RMS of each model", {"channel", "model", "runs", "rms"}, {}};
    for (const OutputComparison& output : comparison.outputs) {
        const std::string channel = fmt::format("{} [{}]", channel_words(output.channel), output.unit);
        for (const ModelErrors& model : output.models) {
            if (const auto fitted = rms_over_runs(model.fitted))
                table.rows.push_back({channel, model.title, "fitted", *fitted});
            if (const auto held_out = rms_over_runs(model.held_out))
                table.rows.push_back({channel, model.title, "held out", *held_out});
        }
    }
    return table;
}

}  // namespace

void add_comparison(reports::Answer& answer, const ModelComparison& comparison) {
    if (comparison.outputs.empty()) return;
    answer.values["comparison"] = comparison_data(comparison);
    reports::AnswerSection section{
        .id = "models",
        .heading = "Compared with other models",
        .prose = split_sentence(comparison),
        .tables = {{"models",
                    "RMS of measured minus modelled, from one second into each run; every run counts alike",
                    {worded_column("channel"),
                     {"title", "model"},
                     {"rms_fitted", "fitted", "", ".4g"},
                     {"rms_held_out", "held out", "", ".4g"},
                     {"unit", "unit"}},
                    *answer.values.find("comparison.models")}},
        .note =
            "The models above the bench's know nothing of a bench: Prandtl-Ishlinskii is a sum of nine stop "
            "operators with and without the load, the elastic-plastic elements are six springs in series with "
            "sliders. Corrected: with the causes that the diagnosis of the fitted runs found. Law: what the "
            "corrected model left of the fitted runs."};
    for (const OutputComparison& output : comparison.outputs) {
        section.prose += " " + best_sentence(output);
        section.tables.push_back(run_error_table(output));
    }
    add_before_curves(answer, std::move(section));
    answer.drawn.push_back(error_table(comparison));
}

reports::Answer diagnosed_runs_answer(const model_comparison::DiagnosedRuns& diagnosed) {
    const gap::Diagnosis& diagnosis = diagnosed.split.diagnosis;
    reports::Answer answer = diagnosis_answer(diagnosed.split.diagnosed, diagnosis);
    add_left_over(answer, diagnosed.left_over, diagnosed.split.recorded);
    add_comparison(answer, diagnosed.comparison);
    if (diagnosis.cut_short) answer.values["cut_short"] = true;
    return answer;
}

}  // namespace capstan::answers
