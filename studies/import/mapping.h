#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "capstan/import/units.h"
#include "capstan/logs/text_format.h"

namespace capstan::imports {

/// A column of a log: in which file, table and column it stands.
struct ColumnPlace {
    std::string file;    ///< a pattern of the file's name, "*motor*"; empty: the only file of the run
    std::string table;   ///< a topic, a variable or a sheet; empty: the only one with such a column
    std::string column;  ///< name, or its number from 1 where the file has no names
};

/// Where the times of a table stand.
struct TimeMapping {
    std::string column;           ///< empty: found (log_time, header.stamp, t, time)
    std::string unit;             ///< "s", "ms", "us", "ns", "min"; empty: of the column's head, else s
    double sample_rate_Hz = 0.0;  ///< above 0: the file has no times, and this is its rate
};

/// Which column is a channel of the recording, and how its numbers become SI units:
/// value = sign * scale * (number - zero).
struct ChannelMapping {
    std::string name;  ///< of the recording: "motor_angle", "tension_1"
    ColumnPlace from;
    std::string unit;                       ///< of the column
    std::optional<double> scale;            ///< SI units in one `unit`; else from the unit
    std::optional<double> counts_per_turn;  ///< of an encoder, with unit = "counts"
    std::optional<double> torque_constant;  ///< N m per A, for a torque that was read as a current
    double sign = 1.0;
    double zero = 0.0;                     ///< the reading of the unloaded sensor, in `unit`
    std::optional<double> clock_offset_s;  ///< added to the channel's times; nothing: 0 within a table
    std::optional<double> wraps_at;        ///< the counter's range, in `unit`
    std::optional<double> noise_std;       ///< of one reading, in SI units
    std::optional<double> step;            ///< of the converter, in SI units; else from the counts

    /// SI units in one unit of the column, with its sign. The mapping must have been checked.
    double factor() const;
};

/// A run of the recording: which files, which part of them, and what is known of it.
struct RunMapping {
    std::vector<std::string> files;  ///< names without folders; empty: the files as they are given
    std::optional<double> from_s;    ///< from the start of the log
    std::optional<double> to_s;
    std::vector<std::pair<std::string, double>> zero;  ///< of a channel in this run, in the column's unit
    nlohmann::ordered_json conditions;                 ///< keys of the sidecar's run: T0, output, driven, ...
};

enum class Thinning { pick, mean };

/// How logs become a recording: the file import.toml.
struct Mapping {
    std::string file;  ///< where it was read, for messages
    TimeMapping time;
    logs::TextFormat text;
    std::optional<double> sample_rate_Hz;  ///< of the recording; nothing: that of the log
    Thinning thinning = Thinning::pick;
    std::optional<std::string> run_column;  ///< a new run begins where its number changes
    std::vector<ChannelMapping> channels;
    std::vector<RunMapping> runs;      ///< empty: each file is a run
    nlohmann::ordered_json recording;  ///< keys of the sidecar, as they are
};

/// Reads a mapping. Throws InvalidInput with every problem: file, line, key, what is wrong and what to try.
Mapping read_mapping(const std::filesystem::path& path);
Mapping parse_mapping(const std::string& toml, const std::string& file);

/// The mapping as a file for people. `reasons`: comments for a channel (by name), for "time", for
/// "recording".
std::string mapping_text(const Mapping& mapping,
                         const std::vector<std::pair<std::string, std::string>>& reasons = {});

}  // namespace capstan::imports
