#pragma once

#include "capstan/residual_law/residual_law.h"

namespace capstan::residual_law {

/// "a torque of 12 +- 2 mN m that follows the direction of motion ..."
std::string term_words(const LawTerm& term, const FeatureScales& scales, const ResidualNames& names);

}  // namespace capstan::residual_law
