#pragma once

#include "capstan/solver/pull_pull.h"

namespace capstan {

/// The pulleys as they are. Throws InvalidInput with each radius that is not a positive length.
Pulleys checked(const Pulleys& pulleys);

}  // namespace capstan
