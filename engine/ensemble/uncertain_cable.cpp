#include "capstan/ensemble/uncertain_cable.h"

#include <cmath>

namespace capstan {

UncertainCable::UncertainCable(const CableSpecification& nominal) : nominal_(nominal) {
    const Cable checked(nominal);
    for (std::size_t bend = 0; bend < nominal.curvature.size(); ++bend) {
        if (std::isinf(nominal.curvature[bend].bend_radius_m)) continue;
        CableSpecification alone = nominal;
        for (std::size_t piece = 0; piece < alone.curvature.size(); ++piece) {
            if (piece != bend) alone.curvature[piece].bend_radius_m = straight;
        }
        const Cable cable(alone);
        wrap_of_bend_rad_.emplace_back(cable.wrap_angle_rad().begin(), cable.wrap_angle_rad().end());
    }
}

CableSpecification UncertainCable::with(const CableFactors& factors) const {
    CableSpecification cable = nominal_;
    const double friction = std::exp(factors.log_friction);
    cable.dynamic_friction *= friction;
    cable.static_friction *= friction;
    cable.axial_stiffness_N *= std::exp(factors.log_stiffness);
    cable.pretension_N *= std::exp(factors.log_pretension);
    std::size_t bend = 0;
    for (CurvaturePiece& piece : cable.curvature) {
        if (std::isinf(piece.bend_radius_m)) continue;
        if (bend < factors.log_wrap.size()) piece.bend_radius_m *= std::exp(-factors.log_wrap[bend]);
        ++bend;
    }
    return cable;
}

}  // namespace capstan
