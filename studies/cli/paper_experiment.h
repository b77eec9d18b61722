#pragma once

#include <string>
#include <vector>

#include "capstan/cli/command.h"
#include "capstan/cli/exit_code.h"
#include "capstan/paper/pretension_ramps.h"
#include "capstan/reports/answer.h"

namespace capstan::cli {

/// Where an experiment's trajectories go; see deliver_experiment.
extern const Option trajectories_option;

/// The trajectories as CSV to where the option says; then the answer on standard output, unless they went
/// there.
ExitCode deliver_experiment(const Invocation& invocation, const std::string& trajectories_csv,
                            const reports::Answer& answer);

/// `run(setting, pretension_N)` for each cable setting of the paper's bench: settings x pretensions.
template <typename Run>
auto run_every_setting(const Run& run) {
    using Result = decltype(run(paper::cable_settings().front(), 0.0));
    std::vector<std::vector<Result>> runs;
    for (const paper::CableSetting& setting : paper::cable_settings()) {
        runs.emplace_back();
        for (const double pretension_N : setting.pretensions_N)
            runs.back().push_back(run(setting, pretension_N));
    }
    return runs;
}

}  // namespace capstan::cli
