#pragma once
// The one list of commands, and where each is defined.

#include "capstan/cli/command.h"

namespace capstan::cli {

// One file each: command_<name>.cpp.
Command study_run_command();
Command study_resume_command();
Command study_extend_command();
Command study_list_command();
Command study_show_command();
Command study_replay_command();
Command study_delete_command();
Command study_merge_command();
Command study_plan_command();
Command study_submit_command();
Command study_status_command();
Command recommend_command();
Command place_command();
Command sensitivity_command();
Command duty_command();
Command estimate_command();
Command query_command();
Command report_command();
Command export_command();
Command serve_command();
Command doctor_command();
Command completion_command();
Command man_command();
Command simulate_command();
Command calibrate_command();
Command diagnose_command();
Command gap_trial_command();
Command config_default_command();
Command config_check_command();
Command paper_solver_command();
Command paper_estimation_command();
Command paper_exp1_command();
Command paper_exp2_command();

const std::vector<Command>& commands();
const Command* find_command(std::string_view name);

}  // namespace capstan::cli
