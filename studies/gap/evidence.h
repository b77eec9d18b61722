#pragma once

#include <string>
#include <vector>

#include "capstan/gap/cause_fit.h"

namespace capstan::gap {

/// An effect, `none` or `unknown`, and how probable it is.
struct RankedEffect {
    std::string effect;
    double probability = 0.0;
};

/// How well one or two causes explain a recording.
struct ScoredFit {
    CauseFit fit;
    double misfit = 0.0;  ///< mean square residual, in units of noise and floor
    double nominal_penalty = 0.0;
    double shape_penalty = 0.0;
    std::vector<double> visibility;  ///< of each cause: its rms change of the clearest channel, in units of
                                     ///< noise and floor
    double evidence = 0.0;           ///< logarithm, up to a constant
};

/// An explanation and how probable it is; its best fit where several variants were tried.
struct WeighedHypothesis {
    std::vector<std::string> effects;  ///< sorted; `unknown` alone stands for a cause outside the list
    double probability = 0.0;
    double evidence = 0.0;
    const ScoredFit* fit = nullptr;  ///< null for `unknown`
};

/// Compares explanations of a recording by the residuals that they leave.
///
/// A hypothesis has no cause, one cause, two causes, or a cause outside the list. Its evidence is a Bayesian
/// information criterion (G. Schwarz, Estimating the dimension of a model, Annals of Statistics 6, 1978,
/// 461-464): the log-likelihood of the mean square residual over the independent samples, minus a penalty for
/// each fitted number. Residuals are correlated in time, so only independent samples count. Three terms go
/// beyond the criterion: the distance of the nominal numbers and of a cause's own numbers from their usual
/// values, in units of their uncertainty, and the prior probability of each kind of hypothesis. The constants
/// stand in evidence.cpp, each with its reason.
class Evidence {
  public:
    /// `independent_samples`: the number of instants with independent residuals.
    explicit Evidence(double independent_samples) : samples_(independent_samples) {}

    double of(const ScoredFit& fit) const;
    /// The evidence of a cause outside the list, which is assumed to leave a part of the nominal model's gap.
    double of_unknown(double nominal_misfit) const;

    /// Every explanation that was tried, and `unknown`, best first. `fits` must outlive the result.
    std::vector<WeighedHypothesis> weigh(const std::vector<ScoredFit>& fits, double nominal_misfit) const;

    /// The effects of all hypotheses, most probable first. A pair of causes gives half of its probability to
    /// each. Probabilities sum to 1.
    static std::vector<RankedEffect> rank(const std::vector<CandidateCause>& causes,
                                          const std::vector<WeighedHypothesis>& weighed);

    /// The evidence is divided by this factor, because residuals are a little more correlated than assumed.
    static constexpr double overstated = 1.3;

  private:
    double of(double misfit, std::size_t open_numbers) const;

    double samples_;
};

/// How many numbers a fit chose freely, beyond the nominal numbers within their uncertainty.
std::size_t open_numbers(const CauseFit& fit);

/// True if a single cause leaves enough to look for a second: beyond noise, and as a fraction of the gap.
bool worth_a_second_cause(double misfit, double nominal_misfit);

}  // namespace capstan::gap
