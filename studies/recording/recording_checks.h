#pragma once

#include <string>

#include "capstan/recording/problem_list.h"
#include "capstan/recording/recording.h"

namespace capstan {

/// Notes a time that does not follow the run's last sample at about the stated sample rate.
void check_next_time(const RecordedRun& run, double time_s, double sample_rate_Hz, const std::string& place,
                     ProblemList& problems);

/// Notes what no single line shows: runs without samples, inputs that never change, channels that never
/// change although others say they should, angles or torques in other units than stated.
void check_recording(const Recording& recording, const std::string& place, ProblemList& problems);

}  // namespace capstan
