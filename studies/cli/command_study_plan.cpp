#include <fmt/format.h>

#include <algorithm>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/config/config_studies.h"
#include "capstan/placement/study_cost.h"
#include "capstan/placement/study_shard.h"

namespace capstan::cli {

namespace {

std::string duration(double seconds) {
    if (seconds < 120.0) return fmt::format("{:.3g} s", seconds);
    if (seconds < 7200.0) return fmt::format("{:.1f} min", seconds / 60.0);
    return fmt::format("{:.1f} h", seconds / 3600.0);
}

// A shard of a few minutes: short enough to lose, long enough to start.
int sensible_shards(const StudyCost& cost) {
    constexpr double shard_s = 300.0;
    return std::clamp(static_cast<int>(cost.processor_s / shard_s), 1, cost.parts);
}

std::string in_words(const std::string& name, const StudyCost& cost, const std::vector<StudyPlan>& plans,
                     int shards) {
    const double sharded_s = cost.processor_s_with(plans, shards);
    std::string text =
        fmt::format("{}: {} {}\n\n", name, cost.studies, cost.studies == 1 ? "study" : "studies");
    text += fmt::format("Parts:          {} (instants x noise levels; the most shards there can be)\n",
                        cost.parts);
    text += fmt::format("Cells:          {} of {} repetitions\n", cost.cells, cost.repetitions);
    text += fmt::format("Readings:       {}\n", cost.readings);
    text += fmt::format("One run:        {:.3g} core-hours ({} on one processor of this machine)\n",
                        cost.processor_s / 3600.0, duration(cost.processor_s));
    text += fmt::format("{:<15} {:.3g} core-hours, about {} each ({} of it preparation)\n",
                        fmt::format("{} {}:", shards, shards == 1 ? "shard" : "shards"), sharded_s / 3600.0,
                        duration(sharded_s / shards), duration(cost.shard_preparation_s));
    text += fmt::format(
        "95% intervals:  the mean error of a cell to +- {:.2g} N in the median, +- {:.2g} N at worst\n\n",
        cost.median_half_width_N, cost.largest_half_width_N);
    text += fmt::format("Predicted from {} parts, timed with {} repetitions each.\n", cost.pilot_parts,
                        cost.pilot_repetitions);
    return text;
}

nlohmann::ordered_json in_json(const std::string& name, const StudyCost& cost,
                               const std::vector<StudyPlan>& plans, int shards) {
    const double sharded_s = cost.processor_s_with(plans, shards);
    return {{"name", name},
            {"studies", cost.studies},
            {"parts", cost.parts},
            {"cells", cost.cells},
            {"repetitions", cost.repetitions},
            {"readings", cost.readings},
            {"one_run_core_hours", cost.processor_s / 3600.0},
            {"shards", shards},
            {"core_hours", sharded_s / 3600.0},
            {"shard_s", sharded_s / shards},
            {"shard_preparation_s", cost.shard_preparation_s},
            {"parts_solved_again", parts_solved_again(plans, shards)},
            {"median_half_width_N", cost.median_half_width_N},
            {"largest_half_width_N", cost.largest_half_width_N},
            {"pilot_parts", cost.pilot_parts},
            {"pilot_repetitions", cost.pilot_repetitions}};
}

ExitCode run(const Invocation& invocation) {
    const config::ReadConfig config = read_config_of(invocation);
    const std::vector<StudyPlan> plans = config::runnable_studies(config);
    if (invocation.has("shards")) require_useful(plans, {1, static_cast<int>(invocation.whole("shards"))});
    const StudyCost cost = predict_cost(plans, {invocation.real("seconds")});
    const int shards =
        invocation.has("shards") ? static_cast<int>(invocation.whole("shards")) : sensible_shards(cost);
    deliver(invocation, invocation.has("json") ? json_text(in_json(config.plan.name, cost, plans, shards))
                                               : in_words(config.plan.name, cost, plans, shards));
    return ExitCode::success;
}

}  // namespace

Command study_plan_command() {
    return {
        "study plan",
        "Say what a study will cost before it is run.",
        "Counts the work of CONFIG and predicts its processor time on this machine, alone and in shards, and how wide "
        "its intervals will be, from a pilot: some of its parts on one processor with few repetitions. Storing is "
        "not counted. Nothing is written.",
        {config_argument},
        {{"shards",
          '\0',
          OptionKind::whole_number,
          "N",
          "Shards to predict for; left out, as many as take about five minutes each.",
          "",
          {},
          1,
          1e6},
         {"seconds",
          '\0',
          OptionKind::real_number,
          "S",
          "Processor time of the pilot; more makes it surer. At least one part of each cable length is timed.",
          "5",
          {},
          0,
          1e5},
         seed_option,
         repetitions_option,
         output_option,
         json_option,
         help_option},
        {"capstan study plan configs/atlas.toml",
         "capstan study plan configs/atlas.toml --shards 100 --json"},
        run};
}

}  // namespace capstan::cli
