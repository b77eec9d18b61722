// What a diagnosis would cost, before it starts.
#include <fmt/format.h>

#include "capstan/answers/recording_answers.h"
#include "capstan/platform/progress.h"

namespace capstan::answers {

reports::Answer diagnosis_cost_answer(const std::string& recording,
                                      const model_comparison::DiagnosisCost& cost) {
    reports::Answer answer{
        .id = "diagnosis_cost",
        .kind = "Estimated cost of a diagnosis",
        .title = recording,
        .headline = fmt::format("a diagnosis takes {} on this machine, depending on what it finds.",
                                duration_range_words(cost.min_seconds, cost.max_seconds))};
    answer.values = {{"recording", recording},
                     {"runs", cost.runs},
                     {"samples", cost.samples},
                     {"causes", cost.causes},
                     {"simulation_s", cost.simulation_s},
                     {"min_seconds", cost.min_seconds},
                     {"max_seconds", cost.max_seconds}};
    return answer;
}

}  // namespace capstan::answers
