#pragma once
// Options that mean the same wherever they appear.

#include "capstan/cli/command.h"

namespace capstan::cli {

extern const Option help_option;
extern const Option database_option;
extern const Option output_option;
extern const Option jobs_option;
extern const Option seed_option;
extern const Option repetitions_option;
extern const Option json_option;
extern const Option progress_option;
extern const Option stats_option;
extern const Option segments_option;
extern const Option page_option;

extern const Argument config_argument;
extern const Argument study_argument;  ///< latest where left out

}  // namespace capstan::cli
