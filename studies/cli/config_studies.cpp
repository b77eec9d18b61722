#include "capstan/cli/config_studies.h"

#include "capstan/cable/invalid_input.h"
#include "capstan/cli/command.h"
#include "capstan/cli/config_truth.h"
#include "capstan/cli/config_writer.h"
#include "capstan/cli/runnable_config.h"
#include "capstan/placement/study_sweep.h"

namespace capstan::cli {

std::vector<StudyPlan> runnable_studies(const ReadConfig& config) {
    if (!config.plan.sweep.is_there()) {
        require_runnable(config);
        return {config.plan};
    }
    std::vector<StudyPlan> studies = studies_in_sweep(config.plan);
    for (StudyPlan& study : studies) {
        study.config_toml = config_text(study, Comments::none);
        std::vector<std::string> problems;
        for (const std::string& problem : problems_of(study)) {
            problems.push_back(config.file + ": study '" + study.name + "' of the sweep: " + problem);
        }
        if (!problems.empty()) throw InvalidInput(problems);  // those of the next would say the same again
    }
    return studies;
}

// The stored configuration is that of the study as it ran, options of the command line included.
ReadConfig read_config_of(const Invocation& invocation) {
    ReadConfig config = read_config(invocation.argument("CONFIG"));
    StudyPlan& plan = config.plan;
    if (invocation.has("seed")) plan.seed = static_cast<std::uint64_t>(invocation.whole("seed"));
    if (invocation.has("repetitions")) plan.repetitions = static_cast<int>(invocation.whole("repetitions"));
    if (invocation.has("truth")) plan.truth = read_truth(invocation.text("truth"));
    plan.config_toml = config_text(plan, Comments::none);
    return config;
}

}  // namespace capstan::cli
