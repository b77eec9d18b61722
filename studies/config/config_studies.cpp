
#include "capstan/config/plan_checks.h"
#include "capstan/plan/study_plan.h"

namespace capstan::config {

std::vector<StudyPlan> runnable_studies(const ReadConfig& config) {
    if (!config.plan.sweep.is_there()) {
        require_runnable(config);
        return {config.plan};
    }
    std::vector<StudyPlan> studies = studies_in_sweep(config.plan);
    for (const StudyPlan& study : studies) {
        std::vector<std::string> problems;
        for (const KeyProblem& problem : problems_of(study))
            problems.push_back(config.file + ": study '" + study.name + "' of the sweep: " + problem.text());
        if (!problems.empty()) throw InvalidInput(problems);  // those of the next would say the same again
    }
    return studies;
}

}  // namespace capstan::config
