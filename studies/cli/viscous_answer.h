#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "capstan/paper/viscous_tunnel.h"

namespace capstan::cli {

// The paper's Fig. 6 beside ours: in words, and for programs.

std::string viscous_in_words(const paper::ViscousComparison& comparison);
nlohmann::ordered_json viscous_in_json(const paper::ViscousComparison& comparison);

/// What the comparison is and is not, in one paragraph: the bench is simulated.
std::string viscous_caveat(const paper::ViscousComparison& comparison);

}  // namespace capstan::cli
