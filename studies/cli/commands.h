#pragma once

#include "capstan/cli/command.h"

// The list of commands, in the order of `capstan --help`. A line `COMMAND(study_run)` takes its command from
// `Command study_run_command()` in one of the files command_*.cpp; such a function without its line here does
// not compile.
#define CAPSTAN_COMMANDS(COMMAND) \
    COMMAND(study_run)            \
    COMMAND(study_resume)         \
    COMMAND(study_extend)         \
    COMMAND(study_list)           \
    COMMAND(study_show)           \
    COMMAND(study_replay)         \
    COMMAND(study_delete)         \
    COMMAND(study_restore)        \
    COMMAND(study_note)           \
    COMMAND(study_merge)          \
    COMMAND(study_verify)         \
    COMMAND(study_plan)           \
    COMMAND(study_submit)         \
    COMMAND(study_status)         \
    COMMAND(study_work)           \
    COMMAND(batch)                \
    COMMAND(recommend)            \
    COMMAND(place)                \
    COMMAND(budget)               \
    COMMAND(bands)                \
    COMMAND(sensitivity)          \
    COMMAND(duty)                 \
    COMMAND(estimate)             \
    COMMAND(query)                \
    COMMAND(report)               \
    COMMAND(export)               \
    COMMAND(serve)                \
    COMMAND(import)               \
    COMMAND(recording_check)      \
    COMMAND(recording_template)   \
    COMMAND(recording_keys)       \
    COMMAND(recording_schema)     \
    COMMAND(simulate)             \
    COMMAND(calibrate)            \
    COMMAND(diagnose)             \
    COMMAND(gap_trial)            \
    COMMAND(config_default)       \
    COMMAND(config_check)         \
    COMMAND(config_catalogue)     \
    COMMAND(paper_exp1)           \
    COMMAND(paper_exp2)           \
    COMMAND(paper_solver)         \
    COMMAND(paper_estimation)     \
    COMMAND(doctor)               \
    COMMAND(completion)           \
    COMMAND(man)

namespace capstan::cli {

#define CAPSTAN_DECLARE(name) Command name##_command();
CAPSTAN_COMMANDS(CAPSTAN_DECLARE)
#undef CAPSTAN_DECLARE

const std::vector<Command>& commands();
const Command* find_command(std::string_view name);

}  // namespace capstan::cli
