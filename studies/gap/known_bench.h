#pragma once

#include "capstan/gap/twin.h"

namespace capstan::gap {

/// Twins of benches whose geometry is known (E1-E8, E15-E17). Parameters: dynamic_friction, static_friction,
/// axial_stiffness, pretension (one factor on what the sidecar says of each run).
std::unique_ptr<Twin> make_pull_pull_twin(const Recording& recording, int segments);
std::unique_ptr<Twin> make_single_cable_twin(const Recording& recording, int segments);

}  // namespace capstan::gap
