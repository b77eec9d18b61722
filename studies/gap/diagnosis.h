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

/// A 95% interval.
struct FittedInterval {
    double low = 0.0;
    double high = 0.0;
};

struct FittedNumber {
    std::string name;
    std::string unit;
    double value = 0.0;
    std::optional<FittedInterval> interval{};  ///< none: the recording itself gave the number
    bool is_at_bound = false;                  ///< of its search: the true number may lie beyond it
};

/// A cause that the verdict names, with its fitted numbers.
struct FittedCause {
    std::string effect;
    std::string variant;
    std::string component;
    std::string end;
    std::vector<FittedNumber> numbers;
    std::optional<double> position_m;
};

/// The fit of a set of causes.
struct CandidateScore {
    std::vector<std::string> effects{};
    std::vector<std::string> variants{};
    std::size_t open_numbers = 0;
    double misfit = 0.0;
    double nominal_penalty = 0.0;
    std::vector<double> visibility{};  ///< see ScoredFit
    double evidence = 0.0;
    bool is_only_the_bench = false;  ///< no cause beyond the zeros and bearings' friction of every bench
};

struct Diagnosis {
    std::vector<RankedEffect> ranked;  ///< best first; sums to 1
    std::vector<FittedCause> causes;   ///< that act together, the clearest first; then numbers of the bench
    double friction_ratio = 1.0;       ///< nominal numbers as fitted with the causes
    double stiffness_ratio = 1.0;
    double pretension_ratio = 1.0;
    /// Further numbers of the bench that floated: zeros of sensors, friction of bearings. None where a bench
    /// with measured numbers explains the recording.
    std::vector<FittedNumber> bench;
    std::vector<std::string> at_bounds;  ///< of friction, stiffness and pretension those at a search's bound
    BenchNumbers corrected;              ///< the bench with all of that
    FittedInterval
        friction_interval;  ///< of the ratios; no narrower than their priors where nothing is learned
    FittedInterval stiffness_interval;
    FittedInterval pretension_interval;
    std::string component;
    std::string end;
    std::optional<double> position_m;
    GapMeasure gap;
    double misfit_before = 0.0;  ///< mean square residual in units of noise and floor; 1: nothing to explain
    double misfit_after = 0.0;
    double independent_samples = 0.0;
    std::vector<CandidateScore> candidates;  ///< that were fitted, best first
    NonIdentifiable non_identifiable;  ///< the explanations that compete, and experiments that would decide
    int evaluations = 0;               ///< simulations of the complete recording
    bool cut_short = false;            ///< by the time limit: further causes were not tried
};

/// Finds the unmodelled effect, if any, that explains the difference between a recording and its bench's
/// model.
///
/// Every promising cause is fitted together with the bench's numbers, and further causes beside the best. The
/// fits are compared by their evidence: the likelihood of the residuals over the independent samples, with a
/// penalty for each fitted number. `none` leads where only noise and the model's floor are left; `unknown`
/// where what is left is a function of the motion that no known cause gives.
Diagnosis diagnose(const Recording& recording, const DiagnosisOptions& options);

}  // namespace capstan::gap
