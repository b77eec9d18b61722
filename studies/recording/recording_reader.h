#pragma once

#include <filesystem>

#include "capstan/recording/problem_list.h"
#include "capstan/recording/recording.h"

namespace capstan {

/// Reads a recording: a CSV of samples and a JSON sidecar of the same name beside it; either name is taken.
/// Throws InvalidInput with everything that is wrong: file, line or key, what it is and what to try. Besides
/// broken lines and keys that is: a time that does not increase or has a gap, a run without samples, a driven
/// channel that is constant in every run, a channel in other units than it says.
Recording read_recording(const std::filesystem::path& path);

// The steps of reading.

/// Reads what the JSON sidecar says of a recording: everything but the samples. What is missing or wrong goes
/// into `problems` with the key it belongs to. Throws InvalidInput if the file cannot be read or is no JSON.
Recording read_sidecar(const std::filesystem::path& path, ProblemList& problems);

/// Notes a time that does not follow the run's last sample at about the stated sample rate.
void check_next_time(const RecordedRun& run, double time_s, double sample_rate_Hz, const std::string& place,
                     ProblemList& problems);

/// Notes what no single line shows: runs without samples, inputs that never change, channels that never
/// change although others say they should, angles or torques in other units than stated.
void check_recording(const Recording& recording, const std::string& place, ProblemList& problems);

}  // namespace capstan
