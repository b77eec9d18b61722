#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capstan/gap_trial/sensor_chain.h"

namespace capstan::gap_trial {

/// A session as a lab would file it: NAME.csv with the samples and NAME.json with what the lab knows, which
/// is the nominal bench. Throws std::runtime_error if they cannot be written.
void write_recording(const std::filesystem::path& folder, const std::string& name, const TrialBench& bench,
                     const std::vector<TrialRun>& runs, const std::vector<SensedRun>& logged);

}  // namespace capstan::gap_trial
