#pragma once

#include "capstan/gap/evidence.h"

namespace capstan::gap {

/// A probability that leaves no doubt but the one that every verdict has.
inline constexpr double nearly_certain =
    0.95 * (1.0 - mistaken_cause_fraction) * (1.0 - mistaken_beside_a_clearer_one);

}  // namespace capstan::gap
