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
    double nominal_price = 0.0;
    std::vector<double> visibility;  ///< of each cause: how much it changes the clearest channel, rms in
                                     ///< units of noise and floor
    double evidence = 0.0;           ///< logarithm, up to a constant
};

/// Weighs what is left of residuals that hang together in time.
class Evidence {
  public:
    /// `independent_samples`: instants that tell something new.
    explicit Evidence(double independent_samples) : samples_(independent_samples) {}

    /// Of a model that leaves a mean square of this, with a price for each open number and for how far the
    /// nominal ones had to go.
    double of(double misfit, std::size_t open_numbers, double nominal_price) const;
    /// Of a cause that nobody has thought of, granted to leave some of a gap that the nominal model leaves.
    double of_unknown(double nominal_misfit) const;
    /// Whether a second cause earns its place: by evidence and by a share of the gap.
    bool second_is_earned(const ScoredFit& single, const ScoredFit& pair, double nominal_misfit) const;

    /// Of every effect that any cause has; `singles` and `leading` (one or two causes) as fitted.
    std::vector<RankedEffect> rank(const std::vector<CandidateCause>& causes,
                                   const std::vector<ScoredFit>& singles, const ScoredFit& leading,
                                   double nominal_misfit) const;

  private:
    double samples_;
};

/// Numbers that a fit was free to choose beyond the nominal ones' uncertainty.
std::size_t open_numbers(const CauseFit& fit);

/// Only what a single cause leaves above this is looked at for a second.
inline constexpr double worth_a_second_cause = 1.15;

}  // namespace capstan::gap
