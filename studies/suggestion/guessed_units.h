#pragma once

#include <string>
#include <vector>

#include "capstan/suggestion/column_roles.h"
#include "capstan/suggestion/suggestion.h"

namespace capstan::imports {

/// How far another angle of the same log turns.
struct KnownAngle {
    std::string name{};
    double turns = 0.0;  ///< 0: there is none whose unit is known
};

/// Gives a channel the unit that its column states; or else one that the lattice of an encoder, the range of
/// a counter, or the size of the numbers shows, with the reason and the doubt of the guess. `other`: for an
/// encoder of unknown counts.
void guess_unit(ChannelMapping& channel, const SeenColumn& column, const KnownAngle& other,
                std::vector<Guess>& guesses);

}  // namespace capstan::imports
