#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "capstan/recording/recording.h"

namespace capstan {

/// One key of a recording's sidecar: all that documentation, template and schema need.
struct RecordingKey {
    std::string_view section;  ///< "", "nominal", "nominal.R_profile", "tension_sensors", "runs"
    std::string_view name;
    std::string_view type;  ///< of JSON: "number", "string", "object", "array of strings", ...
    std::string_view unit;  ///< empty: none
    std::string_view meaning;
    std::string_view default_words;  ///< what holds where the key is missing; empty: it is required
    std::string_view example;        ///< JSON
    unsigned modes;                  ///< bits 1 << BenchMode: for which kinds of bench it has a meaning

    bool is_required() const { return default_words.empty(); }
    bool concerns(BenchMode mode) const { return (modes >> static_cast<unsigned>(mode) & 1u) != 0; }
};

/// The one list of keys, section by section.
const std::vector<RecordingKey>& recording_keys();

/// The name of a mode in a sidecar, and back; nothing if no mode has the name. "band" is capstan_band.
std::string_view mode_name(BenchMode mode);
std::optional<BenchMode> mode_named(std::string_view name);

/// The channels of a kind of bench, each with the SI unit of its column; tension sensors come on top.
/// `driven`: the channels that a model of it takes as inputs.
struct KnownChannel {
    std::string_view name;
    std::string_view unit;
    std::string_view meaning;
};
const std::vector<KnownChannel>& known_channels(BenchMode mode);
std::vector<std::string> usual_driven_channels(BenchMode mode);
/// The same where only these channels were recorded.
std::vector<std::string> usual_driven_channels(BenchMode mode, const std::vector<Channel>& recorded);

/// The SI unit that a channel's column has; empty for a channel that the models do not know.
std::string_view channel_unit(std::string_view channel);

/// A sidecar with every key of the kind of bench at its example. It is a valid one.
std::string recording_template(BenchMode mode);

/// The keys as a JSON schema (draft 2020-12).
std::string recording_schema();

}  // namespace capstan
