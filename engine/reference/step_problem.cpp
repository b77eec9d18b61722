#include "capstan/reference/step_problem.h"

#include <cmath>

namespace capstan::reference {

CableConstants::CableConstants(const Cable& cable)
    : half_compliance_m_per_N(0.5 * cable.segment_compliance_m_per_N()) {
    for (const double angle_rad : cable.wrap_angle_rad()) {
        sliding_exponent.push_back(cable.dynamic_friction() * angle_rad);
        breakaway_exponent.push_back(cable.static_friction() * angle_rad);
        sliding_ratio.push_back(std::exp(sliding_exponent.back()));
        breakaway_ratio.push_back(std::exp(breakaway_exponent.back()));
    }
}

}  // namespace capstan::reference
