#pragma once

#include "capstan/cli/estimate_words.h"
#include "capstan/reports/experiment_page.h"

namespace capstan::cli {

/// Channels that the estimator was not shown: readings over prediction and band.
reports::ExperimentPage left_out_page(const Recording& recording, const std::vector<LeftOutCable>& results,
                                      const estimate::TrackingOptions& options);

/// All channels used: readings over the estimate and its band at each sensor.
reports::ExperimentPage whole_page(const Recording& recording,
                                   const std::vector<estimate::SensedCable>& cables,
                                   const std::vector<estimate::WholeEstimate>& wholes,
                                   const estimate::TrackingOptions& options);

}  // namespace capstan::cli
