#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "capstan/answers/placement_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/plan_checks.h"
#include "capstan/duty/duty_cycle.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/search/sensor_placement.h"
#include "capstan/worlds/band_coverage.h"

namespace capstan::cli {

namespace {

// Replaces the configuration's duty fractions by those of a recording.
void take_duty(const Invocation& invocation, StudyPlan& plan) {
    duty::DutyOptions options;
    options.jobs = invocation.count("jobs");
    const duty::DutyCycle duty = duty::measure_duty(read_recording(invocation.text("duty")), options);
    const double elsewhere = duty::use_duty(duty, plan);
    std::string fractions;
    for (const RegimeInstants& regime : plan.regimes) {
        fractions += fmt::format("{}{} {:.1f} %", fractions.empty() ? "" : ", ", name_of(regime.regime),
                                 100.0 * regime.duty_fraction);
    }
    std::string message = fmt::format("duty cycle from {}: {}", invocation.text("duty"), fractions);
    if (elsewhere > 0.0005)
        message +=
            fmt::format("; {:.1f} % of the moving time is in regimes that the configuration does not have",
                        100.0 * elsewhere);
    say(message);
}

// The advice about the nominal cable, and about what a diagnosis found.
ExitCode place_with_diagnosis(const Invocation& invocation, config::ReadConfig& config) {
    config.plan.truth = {};
    config::require_runnable(config);
    const StudyPlan nominal = config.plan;
    take_diagnosis(invocation, config.plan);
    config::require_runnable(config);
    const auto about_nominal = watch_worlds(invocation, nullptr, 0, nominal);
    if (!about_nominal) return ExitCode::stopped;
    const auto about_found = watch_worlds(invocation, nullptr, 0, config.plan);
    if (!about_found) return ExitCode::stopped;
    deliver_answer(invocation, answers::world_truth_answer(config.plan, *about_nominal, *about_found));
    return ExitCode::success;
}

ExitCode run_place(const Invocation& invocation) {
    config::ReadConfig config = read_config_of(invocation);
    if (config.plan.uncertainty.is_stated) {
        for (const char* option : {"noise", "duty", "until-resolved"})
            if (invocation.has(option)) refuse_worlds(config.plan, std::string("--") + option);
        if (invocation.has("from-diagnosis")) return place_with_diagnosis(invocation, config);
        config::require_runnable(config);
        return run_watched_worlds(invocation, nullptr, 0, config.plan);
    }
    if (invocation.has("duty")) take_duty(invocation, config.plan);
    config::require_runnable(config);
    PlacementOptions options;
    options.jobs = invocation.count("jobs");
    options.noise_index = noise_index_of(config.plan, invocation);
    options.runners_up = invocation.count("runners-up");
    invocation.take("until-resolved", options.resolve_to_N);
    options.on_progress = [](const std::string& message) { say(message); };
    ShownWork work(invocation, config.plan.name);
    const PlacementAnswer answer = place_sensors(config.plan, options);
    work.end();
    if (invocation.has("stats")) {
        say(fmt::format(
            "wall time: {:.2f} s to score {} candidates, {:.2f} s on independent draws, {:.2f} s in all",
            answer.times.score_s, answer.candidates, answer.times.independent_s, answer.times.wall_s));
    }
    deliver_answer(invocation, answers::place_answer(config.plan, answer));
    return ExitCode::success;
}

}  // namespace

Command place_command() {
    return {
        .name = "place",
        .summary = "Search all layouts for the best ones, under constraints.",
        .description =
            "Scores every set of nodes with every fusion method of CONFIG on the same draws. For each "
            "number of sensors, prints the best nodes, their expected error, and how much worse the "
            "paper's families, the greedy choice and the D-optimal layout are: in each motion regime, "
            "across all regimes (minimax regret), and over the duty cycle. The draws of the search are "
            "optimistic about the best of many layouts, so its error is re-estimated on independent "
            "draws. The section [placement] of CONFIG gives the constraints and the error to minimise.",
        .arguments = {config_argument},
        .options =
            {noise_option,
             {.name = "runners-up",
              .kind = OptionKind::integer,
              .value = "N",
              .meaning = "How many runners-up --json lists.",
              .default_value = "3",
              .limits = {0, 1000}},
             {.name = "duty",
              .value = "LOG",
              .meaning =
                  "Take the duty cycle from this recording instead of the configuration's duty_fraction."},
             {.name = "until-resolved",
              .kind = OptionKind::number,
              .value = "N",
              .meaning =
                  "Draw more repetitions until, with 95 % certainty, no layout is better than the best of its "
                  "count by more than N newtons.",
              .limits = {1e-6, 1e6}},
             seed_option,
             repetitions_option,
             jobs_option,
             answer_output_option,
             page_option,
             json_option,
             from_diagnosis_option,
             far_end_option,
             database_option,
             progress_option,
             stats_option,
             help_option},
        .examples = {"capstan place configs/paper.toml",
                     "capstan place configs/paper.toml --html place.html -o place.txt",
                     "capstan place my.toml --until-resolved 0.005",
                     "capstan place my.toml --json | jq .scopes[0].counts"},
        .run = run_place,
        .time =
            "10 s for 11 nodes and 1000 repetitions; twice as long for each further node, and in proportion to the "
            "repetitions; a configuration with [uncertainty] takes minutes. Shows progress and the time left.",
        .when_stopped = stores_nothing};
}

namespace {

// So that the errors of the cables can be compared.
void require_comparable(const StudyPlan& plan, const StudyPlan& first) {
    if (plan.uncertainty.is_stated != first.uncertainty.is_stated)
        throw UsageError(fmt::format(
            "capstan budget: of {} and {} only one has [uncertainty]; errors at instants and errors over worlds cannot "
            "be compared",
            first.name, plan.name));
    if (!plan.uncertainty.is_stated && plan.placement.objective != PlacementObjective::all_nodes)
        throw UsageError(
            fmt::format("capstan budget: {}: placement.objective must be all_nodes, so that the errors of "
                        "the cables can be compared",
                        plan.name));
    if (plan.placement.objective != first.placement.objective)
        throw UsageError(
            fmt::format("capstan budget: {} and {} differ in placement.objective", first.name, plan.name));
}

// Nothing: it was stopped.
std::optional<answers::BudgetCable> search_cable(const Invocation& invocation, const StudyPlan& plan,
                                                 int sensors, const std::string& activity) {
    if (plan.uncertainty.is_stated) {
        const auto found = watch_worlds(invocation, nullptr, 0, plan);
        if (!found) return std::nullopt;
        return answers::budget_cable(plan, *found, sensors);
    }
    PlacementOptions options;
    options.jobs = invocation.count("jobs");
    ShownWork work(invocation, activity);
    const PlacementAnswer found = place_sensors(plan, options);
    work.end();
    return answers::budget_cable(plan, found, no_sensor_errors_N(plan).at("duty_cycle"), sensors);
}

ExitCode run_budget(const Invocation& invocation) {
    std::vector<StudyPlan> plans;
    for (const std::string& file : invocation.repeated_argument()) {
        config::ReadConfig config = config::read_config(file);
        invocation.take("repetitions", config.plan.repetitions);
        config::require_runnable(config);
        plans.push_back(std::move(config.plan));
        require_comparable(plans.back(), plans.front());
    }
    const auto sensors = invocation.count("sensors");
    const BudgetObjective objective =
        invocation.text("objective") == "mean" ? BudgetObjective::mean : BudgetObjective::largest;
    std::vector<answers::BudgetCable> cables;
    std::vector<std::vector<double>> errors_N;
    for (const StudyPlan& plan : plans) {
        auto cable =
            search_cable(invocation, plan, sensors,
                         fmt::format("cable {} of {}, {}", cables.size() + 1, plans.size(), plan.name));
        if (!cable) return ExitCode::stopped;
        std::vector<double>& error_N = errors_N.emplace_back();
        for (const answers::BudgetChoice& choice : cable->choices) error_N.push_back(choice.error.value_N);
        cables.push_back(std::move(*cable));
    }
    deliver_answer(invocation,
                   answers::budget_answer(cables, shared_budget(errors_N, sensors, objective), objective));
    return ExitCode::success;
}

}  // namespace

Command budget_command() {
    return {
        .name = "budget",
        .summary = "Share a number of sensors among several cables.",
        .description =
            "Searches the layouts of each CONFIG as `capstan place` does, and distributes at most N sensors over "
            "the cables so that the mean of their expected errors over the duty cycle, or the largest of them, is "
            "as small as possible. Prints the sensors of each cable and what smaller budgets give. A cable may "
            "get none. Where the configurations have [uncertainty], the errors are those over worlds, of the same "
            "objective; all of them have it, or none.",
        .arguments = {{"CONFIG", "A study's configuration for each cable.", ArgumentNeed::one_or_more}},
        .options = {{.name = "sensors",
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning = "The number of sensors for all cables together.",
                     .default_value = "4",
                     .limits = {1, 1000}},
                    {.name = "objective",
                     .meaning =
                         "What is to be small: the mean of the cables' errors, or the largest of them.",
                     .default_value = "mean",
                     .choices = {"mean", "largest"}},
                    repetitions_option,
                    jobs_option,
                    answer_output_option,
                    page_option,
                    json_option,
                    progress_option,
                    help_option},
        .examples = {"capstan budget elbow.toml wrist.toml --sensors 4",
                     "capstan budget a.toml b.toml c.toml --sensors 6 --objective largest --json"},
        .run = run_budget,
        .time = "As long as `place` for each of the cables. Shows progress and the time left of each.",
        .when_stopped = stores_nothing};
}

namespace {

ExitCode run_bands(const Invocation& invocation) {
    std::vector<answers::ConfigurationBands> found;
    for (const std::string& file : invocation.repeated_argument()) {
        config::ReadConfig config = config::read_config(file);
        if (!config.plan.uncertainty.is_stated)
            throw UsageError(fmt::format(
                "capstan bands: {} has no [uncertainty], so that there are no worlds to draw", file));
        invocation.take("repetitions", config.plan.repetitions);
        invocation.take("seed", config.plan.seed);
        config::require_runnable(config);
        found.push_back({.plan = config.plan, .bands = {}, .worlds = config.plan.repetitions});
    }
    for (answers::ConfigurationBands& each : found) {
        const WatchedTable watched =
            watch_table(invocation, each.plan.name, [&](const TableOptions& options) {
                ErrorTable table(each.plan, options);
                each.bands = band_coverage(table, each.worlds);
                for (const Candidate& candidate : table.candidates())
                    each.sets.push_back(words_of(candidate, table.offers()));
            });
        if (!watched.is_complete) return ExitCode::stopped;
    }
    deliver_answer(invocation, answers::band_answer(found));
    return ExitCode::success;
}

}  // namespace

Command bands_command() {
    return {
        .name = "bands",
        .summary = "Measure how often the estimator's 95% band holds the true tension.",
        .description =
            "Draws the worlds of each CONFIG, which has [uncertainty], and prints for every set of sensors that the "
            "configuration compares which fraction of the true tensions lies within the estimator's 95% band: for worlds "
            "drawn from what the estimator is told, and for worlds twice as uncertain.",
        .arguments = {{"CONFIG", "A study's configuration with [uncertainty].", ArgumentNeed::one_or_more}},
        .options = {seed_option, repetitions_option, jobs_option, answer_output_option, page_option,
                    json_option, progress_option, help_option},
        .examples = {"capstan bands configs/wrist-exosuit.toml",
                     "capstan bands a.toml b.toml --repetitions 100 --json"},
        .run = run_bands,
        .time =
            "As long as `place` with all sets on all worlds, twice: minutes. Shows progress and the time left.",
        .when_stopped = stores_nothing};
}

}  // namespace capstan::cli
