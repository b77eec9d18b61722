#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/blind_trial/blind_trial.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/platform/freed_memory.h"
#include "capstan/platform/parsed_number.h"
#include "capstan/platform/progress.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/platform/wrapped_text.h"

namespace capstan::cli {

namespace {

using gap_trial::BlindTrialHooks;
using gap_trial::TrialFolder;
using gap_trial::TrialOptions;

// Relative error of nominal friction, stiffness and pretension with --nominal-error.
constexpr double nominal_error = 0.01;

gap_trial::VisibilityRange visibility_of(const std::string& text) {
    const std::size_t colon = std::min(text.find(':'), text.size() - 1);
    const auto low = parsed_number<double>(text.substr(0, colon));
    const auto high = parsed_number<double>(text.substr(colon + 1));
    if (!low || !high || *low < 0.1 || *high > 100.0 || *low >= *high)
        throw UsageError(fmt::format(
            "--visibility '{}' is not a range; write LOW:HIGH between 0.1 and 100, such as 0.5:10", text));
    return {*low, *high};
}

TrialOptions trial_options_of(const Invocation& invocation) {
    TrialOptions options;
    options.cases = invocation.count("cases");
    options.seed = static_cast<std::uint64_t>(invocation.integer("seed"));
    const std::string& severity = invocation.text("severity");
    options.severity = severity == "mild"     ? gap_trial::SeverityChoice::mild
                       : severity == "strong" ? gap_trial::SeverityChoice::strong
                                              : gap_trial::SeverityChoice::both;
    options.noise_factor = invocation.number("noise");
    options.length = invocation.text("length") == "short" ? gap_trial::RecordingLength::brief
                                                          : gap_trial::RecordingLength::standard;
    options.nominal_error = invocation.has("nominal-error") ? nominal_error : 0.0;
    if (invocation.text("kind") == "rigs") options.kind = gap_trial::TrialKind::rigs;
    options.nuisances = invocation.has("nuisances");
    options.mixtures = invocation.number("mixtures");
    if (invocation.has("visibility")) options.visibility = visibility_of(invocation.text("visibility"));
    if (invocation.has("only")) options.only = gap_trial::truth_group_named(invocation.text("only"));
    const bool needs_rigs = options.only == gap_trial::TruthGroup::three;
    const bool needs_benches =
        options.only == gap_trial::TruthGroup::parameter || options.only == gap_trial::TruthGroup::foreign;
    const bool is_rigs = options.kind == gap_trial::TrialKind::rigs;
    if ((needs_rigs && !is_rigs) || (needs_benches && is_rigs))
        throw UsageError(fmt::format("--only '{}' needs --kind {}", invocation.text("only"),
                                     needs_rigs ? "rigs" : "benches"));
    return options;
}

BlindTrialHooks hooks_of(const Invocation& invocation) {
    BlindTrialHooks hooks;
    const std::string& progress = invocation.text("progress");
    hooks.on_sealed = [progress](const std::string& seal) {
        if (progress == "json") {
            const reports::Data json = {{"event", "sealed"}, {"labels_sha256", seal}};
            say(reports::json_line(json));
        } else {
            say(fmt::format("Labels sealed before any diagnosis: SHA-256 {}", seal));
        }
    };
    const auto display = std::make_shared<ProgressDisplay>(progress_mode(progress));
    hooks.on_progress = [display](const std::string& activity, int done, int total) {
        display->show(counted_progress(activity, done, total, "cases"));
        if (done == total) display->end_line();
    };
    return hooks;
}

ExitCode score_again(const Invocation& invocation) {
    const std::filesystem::path labels = invocation.text("unseal");
    const TrialFolder folder = TrialFolder::of_labels(labels);
    const TrialOptions options = gap_trial::unseal_labels(labels).options;
    const gap_trial::TrialScore score =
        gap_trial::unseal_and_score(folder, folder.seal(), invocation.count("jobs"), hooks_of(invocation));
    if (score.groups.empty())
        throw UsageError(
            fmt::format("{}: there are no answers beside it; `capstan gap-trial --keep {}` computes them",
                        labels.string(), folder.path().string()));
    deliver_answer(invocation, answers::trial_score_answer(options, folder.seal(), score));
    return ExitCode::success;
}

ExitCode answer_one(const Invocation& invocation) {
    if (!invocation.has("keep"))
        throw UsageError("--case needs --keep DIR, a trial whose recordings are there");
    const TrialFolder folder =
        TrialFolder::of_labels(std::filesystem::path(invocation.text("keep")) / "labels.json");
    deliver(invocation, gap_trial::answer_case(folder, invocation.count("case")));
    return ExitCode::success;
}

ExitCode run_gap_trial(const Invocation& invocation) {
    keep_freed_memory();
    if (invocation.has("case")) return answer_one(invocation);
    if (invocation.has("unseal")) return score_again(invocation);
    const bool only_recordings = invocation.has("generate-only");
    if (only_recordings && !invocation.has("keep"))
        throw UsageError("--generate-only needs --keep DIR, the folder for the recordings");
    const TrialOptions options = trial_options_of(invocation);
    const BlindTrialHooks hooks = hooks_of(invocation);
    const int jobs = invocation.count("jobs");
    const TrialFolder folder = invocation.has("keep") ? TrialFolder::kept(invocation.text("keep"), options)
                                                      : TrialFolder::temporary(options);
    const std::string seal = gap_trial::prepare_trial(folder, options, jobs, hooks);
    if (only_recordings) {
        const reports::Data json = {
            {"folder", folder.path().string()}, {"cases", options.cases}, {"labels_sha256", seal}};
        deliver(invocation, invocation.has("json")
                                ? reports::json_text(json)
                                : fmt::format("{} in {}, labels in {}\n",
                                              counted(static_cast<std::size_t>(options.cases), "recording"),
                                              folder.path().string(), folder.labels().string()));
        return ExitCode::success;
    }
    gap_trial::answer_trial(folder, options, seal, jobs, hooks);
    const gap_trial::TrialScore score = gap_trial::unseal_and_score(folder, seal, jobs, hooks);
    deliver_answer(invocation, answers::trial_score_answer(options, seal, score));
    return ExitCode::success;
}

}  // namespace

Command gap_trial_command() {
    return {
        .name = "gap-trial",
        .summary = "Test the diagnosis on simulated recordings with hidden causes, and score it.",
        .description =
            "Simulates benches as chains of masses over time, independently of the engine's own model. "
            "Each bench has an effect, a wrong parameter, a sensor fault, two effects together, a cause "
            "outside the catalogue, or none of these. Seals the labels (their hash is printed before the "
            "first diagnosis), diagnoses each recording from its files, and unseals the labels. Prints "
            "how often the cause was named first, among the first three or in its family, the false "
            "alarms, the refusals, the calibration of the probabilities, the errors of the places, and "
            "how far the gap shrinks compared with the true cause. The same options give the same "
            "recordings. With --keep, a trial that was killed continues where it stopped.",
        .options =
            {Option{.name = "cases",
                    .kind = OptionKind::integer,
                    .value = "N",
                    .meaning = "Number of recordings.",
                    .default_value = "60",
                    .limits = {1, 999}},
             Option{.name = "seed",
                    .kind = OptionKind::integer,
                    .value = "S",
                    .meaning = "Seed of all random numbers.",
                    .default_value = "1",
                    .limits = {0, 9e15}},
             Option{
                 .name = "kind",
                 .meaning =
                     "benches: four benches, one cause as a rule, correct nominal numbers. rigs: benches and "
                     "drives of drawn geometry with sensor zeros, pulley friction and nominal numbers 7 to "
                     "20% off; none to three causes, of which a third shows at 0.5 to 1.4 times noise and "
                     "floor; irregular motion; conditions of runs that a number may follow.",
                 .default_value = "benches",
                 .choices = {"benches", "rigs"}},
             Option{
                 .name = "severity",
                 .meaning =
                     "How far the effects exceed noise and model floor: mild is 1.5 to 3 times, strong is 4 to 10 "
                     "times.",
                 .default_value = "both",
                 .choices = {"mild", "strong", "both"}},
             Option{
                 .name = "visibility",
                 .value = "LOW:HIGH",
                 .meaning =
                     "Draw how far each effect exceeds noise and model floor from this range (log-uniform, "
                     "each effect of a mixture on its own), in place of --severity. Default for rigs: 0.5:10."},
             Option{.name = "mixtures",
                    .kind = OptionKind::number,
                    .value = "F",
                    .meaning = "Fraction of the benches that have two effects.",
                    .default_value = "0.1",
                    .limits = {0, 0.69}},
             Option{.name = "nuisances",
                    .meaning = "Add sensor zeros and pulley friction to every bench, as rigs have them."},
             Option{.name = "noise",
                    .kind = OptionKind::number,
                    .value = "F",
                    .meaning = "Factor on every channel's noise.",
                    .default_value = "1",
                    .limits = {0.01, 100}},
             Option{.name = "length",
                    .meaning = "standard has all protocols of a bench, short has one or two.",
                    .default_value = "standard",
                    .choices = {"standard", "short"}},
             Option{
                 .name = "only",
                 .value = "GROUP",
                 .meaning =
                     "Generate recordings of one kind only: 'none' (no gap, to measure the false-alarm rate), "
                     "'one effect', 'two effects', 'wrong parameter', 'outside the catalogue', or of rigs 'three "
                     "effects'. Default: a mix of all.",
                 .choices = {"none", "one effect", "two effects", "three effects", "wrong parameter",
                             "outside the catalogue"}},
             Option{.name = "nominal-error",
                    .meaning = "Nominal friction, stiffness and pretension are each wrong by about 1%."},
             Option{
                 .name = "keep",
                 .value = "DIR",
                 .meaning =
                     "Keep recordings, labels and answers in DIR, and continue a trial that is already there."},
             Option{
                 .name = "case",
                 .kind = OptionKind::integer,
                 .value = "K",
                 .meaning =
                     "Diagnose only case K of the sealed trial in --keep, with one thread, and print its answer (JSON). "
                     "`capstan batch gap-trial` does so for all cases.",
                 .limits = {1, 999}},
             Option{.name = "generate-only",
                    .meaning = "Stop when the recordings and the sealed labels are in DIR."},
             Option{
                 .name = "unseal",
                 .value = "FILE",
                 .meaning =
                     "Check FILE (a kept labels.json) against its hash and score the stored answers beside it "
                     "again."},
             jobs_option,
             answer_output_option,
             json_option,
             progress_option,
             help_option},
        .examples =
            {"capstan gap-trial --cases 200",
             "capstan gap-trial --length short --nominal-error --seed 2 --keep trial",
             "capstan gap-trial --cases 400 --only none --length short",
             "capstan gap-trial --kind rigs --cases 40 --keep rigs --generate-only",
             "capstan gap-trial --cases 100 --visibility 0.5:10 --mixtures 0.4 --nuisances --nominal-error",
             "capstan gap-trial --unseal trial/labels.json"},
        .run = run_gap_trial,
        .time =
            "Seconds to minutes for each case; --generate-only takes seconds. Shows progress and the time left."};
}

}  // namespace capstan::cli
