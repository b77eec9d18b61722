#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "capstan/recording/problem_list.h"
#include "capstan/recording/recording.h"

namespace capstan {

/// Reads a recording: a CSV of samples and a JSON sidecar of the same name beside it; either name is taken.
/// The noise of channels for which the sidecar states none is estimated. `problems` gets everything that is
/// wrong. Whoever gets a recording with problems may not use it.
Recording read_recording(const std::filesystem::path& path, ProblemList& problems);

/// The same.
/// Throws InvalidInput with everything that is wrong: file, line or key, what it is and what to try. Besides
/// broken lines and keys that is: a time that does not increase or has a gap, a run without samples, a driven
/// channel that is constant in every run, a channel in other units than it says.
Recording read_recording(const std::filesystem::path& path);

/// The two files of a recording; `name` is either, or NAME without an ending.
struct RecordingPaths {
    std::filesystem::path samples;
    std::filesystem::path sidecar;
};
RecordingPaths recording_paths(const std::filesystem::path& name);

/// A run of fewer samples has no motion in it.
inline constexpr std::size_t min_run_samples = 20;

// The steps of reading.

/// What the table of samples shows before anything is known of it, for what a sidecar leaves out.
struct SampleTable {
    std::vector<std::string> columns;
    std::vector<int> run_numbers;  ///< in the order of the file; 1 where there is no column run
    double period_s = 0.0;         ///< median distance of the times; 0: there are none
};

/// Reads what the JSON sidecar `path` says of a recording: everything but the samples. What a sidecar leaves
/// out and has a sensible default is taken and said in `assumptions`. What is missing or wrong goes into
/// `problems` with the key it belongs to.
Recording read_sidecar(const nlohmann::json& json, const std::filesystem::path& path,
                       const SampleTable& samples, ProblemList& problems);

/// Notes a time that does not follow the run's last sample at about the stated sample rate.
void check_next_time(const RecordedRun& run, double time_s, double sample_rate_Hz, const std::string& place,
                     ProblemList& problems);

/// Notes what no single line shows: runs without samples, inputs that never change, channels that never
/// change although others say they should, angles or torques in other units than stated.
void check_recording(const Recording& recording, const std::string& place, ProblemList& problems);

}  // namespace capstan
