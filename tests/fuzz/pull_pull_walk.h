#pragma once

#include <iosfwd>

#include "capstan/cable/cable.h"
#include "choices.h"
#include "walk.h"

namespace capstan::fuzz {

/// A pair of `cable` and another one, driven by any two inputs.
void pull_pull_walk(const Cable& cable, Choices& choices, Tally& tally, std::ostream* trace);

}  // namespace capstan::fuzz
