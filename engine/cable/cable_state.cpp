#include "capstan/cable/cable_state.h"

namespace capstan {

CableState pretensioned(const Cable& cable) {
    CableState state;
    state.tension_N.assign(cable.nodes(), cable.pretension_N());
    state.displacement_m.resize(cable.nodes());
    const double strain = cable.pretension_N() / cable.axial_stiffness_N();
    for (int node = 0; node < cable.nodes(); ++node) {
        state.displacement_m[node] = -strain * cable.segment_length_m() * (cable.segments() - node);
    }
    return state;
}

}  // namespace capstan
