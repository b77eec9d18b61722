#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capstan/recording/recording.h"

namespace capstan::exports {

/// One quantity over the times of its series.
struct SeriesChannel {
    std::string name;  ///< "motor_torque", "tension_at_0.1m"
    std::string unit;
    std::vector<double> values;  // times
};

/// Channels with one clock: a run, or a cable of a run.
struct Series {
    std::string name;            ///< "run_1", "run_1/cable_A"
    std::vector<double> time_s;  // increasing
    std::vector<SeriesChannel> channels;
};

/// Each run of a recording as a series.
std::vector<Series> series_of(const Recording& recording);

/// Whether a file's name asks for one of the forms below: .mat or .mcap.
bool is_series_file(const std::filesystem::path& path);

/// Writes series where the ending of the name says in which form. Throws std::runtime_error if the file
/// cannot be written; then there is none.
void write_series(const std::filesystem::path& path, const std::vector<Series>& series);

/// MATLAB 5: one struct for each series, with `t`, a column vector for each channel, and the struct `units`
/// with the unit of each. What no name of a variable can have becomes an underscore. The same series give the
/// same bytes.
void write_mat_file(const std::filesystem::path& path, const std::vector<Series>& series);

/// MCAP (mcap.dev/spec): the topic /series/channel for each channel, std_msgs/msg/Float64 in CDR, with the
/// unit in the metadata of the topic ("unit"). A dot in a name becomes an underscore: viewers plot "/topic.data".
/// Times are nanoseconds from the start of the clock; those of a series that begins before 0 are counted from
/// its first. In chunks, with an index and statistics.
void write_mcap_file(const std::filesystem::path& path, const std::vector<Series>& series);

}  // namespace capstan::exports
