#pragma once

#include <string>
#include <vector>

#include "capstan/estimate/left_out.h"
#include "capstan/estimate/sensed_cable.h"
#include "capstan/export/series.h"

namespace capstan::estimate {

/// The tension at every node of every cable and the half-width of its 95% band, in newtons: a series for each
/// run of each cable, with the channels of a node side by side. `tuned`: cables.
std::vector<exports::Series> estimated_series(const std::vector<SensedCable>& cables,
                                              const std::vector<EstimatorTuning>& tuned,
                                              const TrackingOptions& options);

/// Those series of `cables` as CSV: a line for each sample of a run of a cable.
std::string estimated_csv(const std::vector<SensedCable>& cables, const std::vector<exports::Series>& series);

}  // namespace capstan::estimate
