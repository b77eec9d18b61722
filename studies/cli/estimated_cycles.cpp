#include "capstan/cli/estimated_cycles.h"

#include <fmt/format.h>

#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/usage_error.h"
#include "capstan/config/config_reader.h"
#include "capstan/estimate/cycle_trial.h"
#include "capstan/platform/wrapped_text.h"

namespace capstan::cli {

namespace {

using estimate::CycleScore;
using nlohmann::ordered_json;

std::string in_words(const StudyPlan& plan, const std::vector<CycleScore>& scores, int repetitions) {
    std::string text = fmt::format("{}: {} samples at {:g} Hz, {} repetitions, noise \"{}\"\n\n", plan.name,
                                   plan.motion.samples, plan.motion.sample_rate_Hz, repetitions,
                                   plan.noise_levels.front().label);
    text += fmt::format("  {:<10} {:<26} {:>9} {:>8} {:>9} {:>9} {:>9}\n", "family", "nodes", "error",
                        "in band", "band +-", "Mean", "Mean-R");
    for (const CycleScore& score : scores) {
        text += fmt::format("  {:<10} {:<26} {:>9.3f} {:>7.1f}% {:>9.3f} {:>9.3f} {:>9.3f}\n",
                            score.layout.family, nodes_as_people_count(score.layout.nodes), score.error_N,
                            1e2 * score.coverage, score.band_N, score.paper_mean_N, score.paper_mean_r_N);
    }
    const std::string explained =
        "In newtons. error: mean size of the recursive estimator's error over samples, nodes and repetitions. in band: "
        "fraction of tensions within its 95% band, whose mean half width is band. Mean, Mean-R: the paper's methods, each "
        "step from their own last estimate.";
    return text + "\n" + wrapped(explained, 100, "", "") + "\n";
}

std::string in_json(const StudyPlan& plan, const std::vector<CycleScore>& scores, int repetitions) {
    ordered_json json = {{"study", plan.name},
                         {"repetitions", repetitions},
                         {"noise", plan.noise_levels.front().label},
                         {"layouts", ordered_json::array()}};
    for (const CycleScore& score : scores) {
        std::vector<int> nodes;
        for (const int node : score.layout.nodes) nodes.push_back(node + 1);
        json["layouts"].push_back({{"family", score.layout.family},
                                   {"nodes", nodes},
                                   {"error_N", score.error_N},
                                   {"coverage", score.coverage},
                                   {"mean_band_N", score.band_N},
                                   {"wander_m", score.wander_m},
                                   {"paper_mean_error_N", score.paper_mean_N},
                                   {"paper_mean_r_error_N", score.paper_mean_r_N}});
    }
    return json_text(json);
}

}  // namespace

ExitCode estimate_cycles(const Invocation& invocation) {
    for (const char* option : {"leave-out", "html"}) {
        if (invocation.has(option))
            throw UsageError(
                fmt::format("capstan estimate: --{} is for recordings; a study's layouts are "
                            "scored as a table or with --json",
                            option));
    }
    StudyPlan plan = config::read_config(invocation.argument("LOG")).plan;
    if (invocation.has("seed")) plan.seed = static_cast<std::uint64_t>(invocation.whole("seed"));
    estimate::CycleOptions options;
    options.members = static_cast<int>(invocation.whole("members"));
    options.jobs = static_cast<int>(invocation.whole("jobs"));
    if (invocation.has("repetitions"))
        options.repetitions = static_cast<int>(invocation.whole("repetitions"));
    const std::vector<CycleScore> scores = score_cycles(plan, options);
    deliver(invocation, invocation.has("json") ? in_json(plan, scores, options.repetitions)
                                               : in_words(plan, scores, options.repetitions));
    return ExitCode::success;
}

}  // namespace capstan::cli
