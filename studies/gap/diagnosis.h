#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/gap/cause_search.h"
#include "capstan/gap/gap_measure.h"
#include "capstan/gap/next_experiment.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

using DiagnosisOptions = CauseSearchOptions;

struct FittedNumber {
    std::string name;
    std::string unit;
    double value = 0.0;
};

/// A cause that the verdict names, as it was fitted.
struct FittedCause {
    std::string effect;
    std::string variant;
    std::string component;
    std::string end;
    std::vector<FittedNumber> numbers;
    std::optional<double> position_m;
};

/// How one cause, or two together, did.
struct CandidateScore {
    std::vector<std::string> effects;
    std::vector<std::string> variants;
    std::size_t open_numbers = 0;
    double misfit = 0.0;
    double nominal_penalty = 0.0;
    std::vector<double> visibility;  ///< see ScoredFit
    double evidence = 0.0;
};

struct Diagnosis {
    std::vector<RankedEffect> ranked;  ///< best first; sums to 1
    std::vector<FittedCause> causes;   ///< none, one, or two that act together
    double friction_ratio = 1.0;       ///< nominal numbers as fitted with the causes
    double stiffness_ratio = 1.0;
    double pretension_ratio = 1.0;
    std::string component;
    std::string end;
    std::optional<double> position_m;
    GapMeasure gap;
    double misfit_before = 0.0;  ///< mean square residual in units of noise and floor; 1: nothing to explain
    double misfit_after = 0.0;
    double independent_samples = 0.0;
    std::vector<CandidateScore> candidates;  ///< that were fitted, best first
    NonIdentifiable non_identifiable;        ///< what it cannot decide, and the experiment that would
    int evaluations = 0;                     ///< simulations of the whole recording
};

/// Which unmodelled effect, if any, is behind the difference between a recording and its bench's model.
///
/// Every candidate cause is fitted with the nominal numbers floating; what it leaves is weighed on the scale
/// of the residual's own independent samples, with a price for each number. `none` wins where nothing beyond
/// noise and the model's floor is left, `unknown` where the best known cause leaves much of the gap.
Diagnosis diagnose(const Recording& recording, const DiagnosisOptions& options);

}  // namespace capstan::gap
