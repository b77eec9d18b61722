#pragma once

#include "capstan/gap/diagnosis.h"
#include "capstan/recording/recording.h"
#include "capstan/reports/experiment_page.h"

namespace capstan::cli {

/// A diagnosis as a page: the verdict and its probabilities, where the gap is, measured, nominal and
/// corrected channels, residuals before and after, loops.
reports::ExperimentPage diagnosis_page(const Recording& recording, const gap::Diagnosis& diagnosis);

}  // namespace capstan::cli
