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
    std::vector<double> visibility;  ///< of each cause: how much it changes the clearest channel, rms in
                                     ///< units of noise and floor
    double evidence = 0.0;           ///< logarithm, up to a constant
};

/// An explanation and how probable it is; its best fit where several variants were tried.
struct WeighedHypothesis {
    std::vector<std::string> effects;  ///< sorted; `unknown` alone for what nobody has thought of
    double probability = 0.0;
    double evidence = 0.0;
    const ScoredFit* fit = nullptr;  ///< none of `unknown`
};

/// Weighs what is left of residuals that hang together in time.
///
/// A hypothesis is nothing, one cause, two causes, or one that nobody has thought of. Its evidence is the
/// profile likelihood of the mean square that it leaves, over the independent samples; a price for each open
/// number, for how far the nominal numbers had to go and for numbers of its own that are not usual; and what
/// is known beforehand: a cause that makes a gap can be seen, two at once are rarer than one, and the model's
/// own floor looks like a faulty sensor.
class Evidence {
  public:
    /// `independent_samples`: instants that tell something new.
    explicit Evidence(double independent_samples) : samples_(independent_samples) {}

    double of(const ScoredFit& fit) const;
    /// Of a cause that nobody has thought of, granted to leave some of a gap that the nominal model leaves.
    double of_unknown(double nominal_misfit) const;

    /// Every explanation that was tried, and `unknown`, best first. `fits` must outlive the result.
    std::vector<WeighedHypothesis> weigh(const std::vector<ScoredFit>& fits, double nominal_misfit) const;

    /// Effects of all hypotheses, best first; each of two causes has half of what both together have.
    /// Probabilities sum to 1.
    static std::vector<RankedEffect> rank(const std::vector<CandidateCause>& causes,
                                          const std::vector<WeighedHypothesis>& weighed);

    /// Evidence is taken for this many times less than it says: what is left is not quite as independent as
    /// assumed.
    static constexpr double overstated = 1.3;

  private:
    double of(double misfit, std::size_t open_numbers) const;

    double samples_;
};

/// Numbers that a fit was free to choose beyond the nominal ones' uncertainty.
std::size_t open_numbers(const CauseFit& fit);

/// Whether a single cause leaves enough, by itself and of the whole gap, to look for a second.
bool worth_a_second_cause(double misfit, double nominal_misfit);

}  // namespace capstan::gap
