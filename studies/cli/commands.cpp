#include "capstan/cli/commands.h"

#include <algorithm>

namespace capstan::cli {

const std::vector<Command>& commands() {
    static const std::vector<Command> all = {
        study_run_command(),      study_resume_command(), study_extend_command(),
        study_list_command(),     study_show_command(),   study_replay_command(),
        study_delete_command(),   study_merge_command(),  study_plan_command(),
        study_submit_command(),   study_status_command(), recommend_command(),
        place_command(),          sensitivity_command(),  duty_command(),
        estimate_command(),       query_command(),        report_command(),
        export_command(),         serve_command(),        simulate_command(),
        calibrate_command(),      diagnose_command(),     gap_trial_command(),
        config_default_command(), config_check_command(), paper_exp1_command(),
        paper_exp2_command(),     paper_solver_command(), paper_estimation_command(),
        doctor_command(),         completion_command(),   man_command(),
    };
    return all;
}

std::vector<ExitCodeMeaning> exit_codes_of(const Command& command) {
    const bool uses_database = std::any_of(command.options.begin(), command.options.end(),
                                           [](const Option& option) { return option.name == "db"; });
    std::vector<ExitCodeMeaning> codes;
    for (const ExitCodeMeaning& each : exit_code_meanings) {
        if (each.code == ExitCode::database_problem && !uses_database) continue;
        if (each.code == ExitCode::stopped && !command.can_be_stopped) continue;
        codes.push_back(each);
    }
    return codes;
}

const Command* find_command(std::string_view name) {
    for (const Command& command : commands()) {
        if (command.name == name) return &command;
    }
    return nullptr;
}

}  // namespace capstan::cli
