#pragma once

#include <string>
#include <utility>
#include <vector>

#include "capstan/suggestion/column_roles.h"
#include "capstan/suggestion/suggestion.h"

namespace capstan::imports {

/// Which column was chosen for which channel.
using ChosenColumns = std::vector<std::pair<std::string, const SeenColumn*>>;

/// Sets the signs of a mapping's channels: motor and load turn the same way when cable A pulls, both torques
/// have one direction, and friction takes work from both ends together. Every chosen channel must be in the
/// mapping.
void guess_signs(Mapping& mapping, const ChosenColumns& chosen, std::vector<Guess>& guesses);

}  // namespace capstan::imports
