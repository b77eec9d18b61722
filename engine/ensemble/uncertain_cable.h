#pragma once

#include <vector>

#include "capstan/cable/cable.h"

namespace capstan {

/// How one cable differs from the nominal one, as logarithms of factors.
struct CableFactors {
    double log_friction = 0.0;  ///< on both friction coefficients
    double log_stiffness = 0.0;
    double log_pretension = 0.0;
    std::vector<double> log_wrap;  ///< bends: on the wrap angle of each curved piece
};

/// Standard deviations of the same: what is not known of a cable.
struct CableUncertainty {
    double friction = 0.0;
    double stiffness = 0.0;
    double pretension = 0.0;
    double wrap = 0.0;  ///< of every bend on its own
};

/// A nominal cable, and which bend turns which segment.
class UncertainCable {
  public:
    /// Throws InvalidInput with every problem of the specification.
    explicit UncertainCable(const CableSpecification& nominal);

    const CableSpecification& nominal() const { return nominal_; }
    int bends() const { return static_cast<int>(wrap_of_bend_rad_.size()); }
    int segments() const { return nominal_.segments; }
    const std::vector<double>& wrap_of_bend_rad(int bend) const {
        return wrap_of_bend_rad_[bend];
    }  // segments
    /// The cable with these factors.
    CableSpecification with(const CableFactors& factors) const;

  private:
    CableSpecification nominal_;
    std::vector<std::vector<double>> wrap_of_bend_rad_;  // bends x segments
};

}  // namespace capstan
