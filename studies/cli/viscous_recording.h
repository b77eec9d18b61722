#pragma once

#include <filesystem>

#include "capstan/paper/viscous_tunnel.h"

namespace capstan::cli {

/// Writes the simulated bench of Exp. 2 as a laboratory would file it: `csv` with the samples and a sidecar
/// beside it with what is known, the model without viscous friction. Throws std::runtime_error.
void write_viscous_recording(const std::filesystem::path& csv, const paper::CableSetting& setting,
                             const paper::ViscousComparison& comparison);

}  // namespace capstan::cli
