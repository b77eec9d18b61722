#pragma once

#include <span>
#include <vector>

#include "capstan/effects/rate_exponents.h"
#include "capstan/solver/cable_ensemble.h"

namespace capstan {

/// Steps an ensemble whose friction depends on speed (E41), each member by its own speed.
class RateFrictionStep {
  public:
    RateFrictionStep(const RateFriction& friction, const CableEnsemble& members, double segment_m,
                     double interval_s);

    /// One step as CableEnsemble::advance. `wrap_rad`: segments x members. The members' sliding exponents are
    /// as before afterwards.
    EnsembleReport advance(CableEnsemble& members, std::span<const double> wrap_rad,
                           double proximal_increment_m, const CableEnsemble::DistalEnd& distal);

  private:
    void set_exponents(CableEnsemble& members, std::span<const double> wrap_rad) const;
    void observe(const CableEnsemble& members);

    std::size_t count_;             // members
    CableEnsemble before_;          // as the step found them
    RateExponents rates_;           // segments x members
    std::vector<double> exponent_;  // segments x members: without what depends on speed
};

}  // namespace capstan
