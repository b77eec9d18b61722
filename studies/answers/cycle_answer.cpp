#include <fmt/format.h>

#include "capstan/answers/placement_answers.h"
#include "capstan/config/config_writer.h"

namespace capstan::answers {

using reports::Data;

reports::Answer cycle_answer(const StudyPlan& plan, const std::vector<estimate::CycleScore>& scores,
                             int repetitions) {
    reports::Answer answer{
        .id = "cycle",
        .kind = "Layouts scored over the complete motion",
        .title = plan.name,
        .headline = fmt::format(
            "{} scored over {} samples at {:g} Hz, {}, noise {}.", counted(scores.size(), "layout"),
            plan.motion.samples, plan.motion.sample_rate_Hz,
            counted(static_cast<std::size_t>(repetitions), "repetition"), plan.noise_levels.front().label)};
    answer.values = {{"study", plan.name},
                     {"repetitions", repetitions},
                     {"noise", plan.noise_levels.front().label},
                     {"layouts", Data::list()}};
    for (const estimate::CycleScore& score : scores) {
        answer.values["layouts"].push_back({{"family", score.layout.family},
                                            {"nodes", from_one(score.layout.nodes)},
                                            {"error_N", score.error_N},
                                            {"coverage", score.coverage},
                                            {"mean_band_N", score.band_N},
                                            {"wander_m", score.wander_m},
                                            {"paper_mean_error_N", score.paper_mean_N},
                                            {"paper_mean_r_error_N", score.paper_mean_r_N}});
    }
    answer.sections = {
        {.id = "layouts",
         .heading = "Error of each layout",
         .tables = {{"layouts",
                     "",
                     {{"family", "family"},
                      {"nodes", "nodes"},
                      {"error_N", "error", "N", ".3f"},
                      {"coverage", "in band", "", ".1%"},
                      {"mean_band_N", "half width", "N", ".3f"},
                      {"paper_mean_error_N", "Mean", "N", ".3f"},
                      {"paper_mean_r_error_N", "Mean-R", "N", ".3f"}},
                     answer.values["layouts"]}},
         .note =
             "Error: mean absolute error of the recursive estimator over samples, nodes and repetitions. In band: "
             "fraction of tensions within its 95% band, whose mean half width follows. Mean, Mean-R: the paper's "
             "methods, each step from their own last estimate."}};
    answer.config_text = config::config_text(plan, config::Comments::none);
    return answer;
}

}  // namespace capstan::answers
