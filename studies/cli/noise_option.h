#pragma once

#include "capstan/cli/command.h"
#include "capstan/plan/study_plan.h"

namespace capstan::cli {

extern const Option noise_option;

/// Which of the plan's noise levels --noise names; the first if it is not given. Throws UsageError with the
/// nearest label.
int noise_index_of(const StudyPlan& plan, const Invocation& invocation);

}  // namespace capstan::cli
