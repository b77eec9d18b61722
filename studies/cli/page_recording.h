#pragma once

#include <vector>

#include "capstan/gap/twin.h"
#include "capstan/recording/recording.h"
#include "capstan/reports/experiment_page.h"

namespace capstan::cli {

/// A recording and its model as a page: measured and modelled channels of each run, and what is left between.
/// `modelled`: runs of the recording.
reports::ExperimentPage recording_page(const Recording& recording, const std::vector<gap::TwinRun>& modelled);

}  // namespace capstan::cli
