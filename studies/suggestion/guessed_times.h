#pragma once

#include <set>
#include <vector>

#include "capstan/suggestion/column_roles.h"
#include "capstan/suggestion/suggestion.h"

namespace capstan::imports {

/// Which columns are the times of their tables, by name, else because they rise with every row; the mapping
/// gets the first of them with its unit, or a rate where there is none. Gives all of them.
std::set<const logs::LogColumn*> guess_times(TimeMapping& time, const std::vector<SeenColumn>& columns,
                                             std::vector<Guess>& guesses);

}  // namespace capstan::imports
