#pragma once

namespace capstan {

/// A cable that resists bending presses on its conduit even without tension (E24): a constant drag per length
/// where it slides.
struct BendingStiffness {
    double drag_N_per_m = 0.0;
};

}  // namespace capstan
