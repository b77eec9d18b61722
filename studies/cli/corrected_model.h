#pragma once

#include <string>

#include "capstan/gap/diagnosis.h"

namespace capstan::cli {

/// The [truth] that a diagnosis found, as a file for `capstan study run --truth`: nominal numbers as fitted
/// and the effects that belong to a cable; its comments name what it cannot hold, as pulleys and sensors.
std::string corrected_model_text(const Recording& recording, const gap::Diagnosis& diagnosis,
                                 const std::string& verdict);

}  // namespace capstan::cli
