#include "capstan/recording/recording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "capstan/cable/invalid_input.h"

namespace capstan {

CableSpecification cable_specification(const std::vector<CurvaturePiece>& routing,
                                       const CableNumbers& numbers, int segments) {
    CableSpecification cable;
    cable.curvature = routing;
    cable.segments = segments;
    cable.axial_stiffness_N = numbers.axial_stiffness_N;
    cable.dynamic_friction = numbers.dynamic_friction;
    cable.static_friction = std::max(numbers.static_friction, numbers.dynamic_friction);
    cable.pretension_N = numbers.pretension_N;
    return cable;
}

void require_stated_numbers(const Recording& recording, const std::string& instead) {
    if (!recording.nominal) return;
    const NominalSpread& spread = recording.nominal->spread;
    std::vector<std::string> open;
    if (spread.friction > 0.0) open.emplace_back("nominal.mu_d");
    if (spread.stiffness > 0.0) open.emplace_back("nominal.K or nominal.EA");
    if (spread.pretension > 0.0) open.emplace_back("T0 of its runs");
    if (open.empty()) return;
    throw InvalidInput({fmt::format("{}: the sidecar gives no value of {}; state values, or {}",
                                    recording.name, fmt::join(open, ", "), instead)});
}

Recording with_values(Recording recording, std::vector<std::vector<std::vector<double>>> values) {
    for (std::size_t channel = recording.channels.size(); channel-- > 0;) {
        const auto at = static_cast<std::ptrdiff_t>(channel);
        recording.channels[channel].noise_std.reset();
        recording.channels[channel].step.reset();
        if (std::ranges::none_of(values, [&](const auto& run) { return run[channel].empty(); })) continue;
        recording.channels.erase(recording.channels.begin() + at);
        for (auto& run : values) run.erase(run.begin() + at);
    }
    for (std::size_t run = 0; run < values.size(); ++run) recording.runs[run].values = std::move(values[run]);
    return recording;
}

bool RecordedRun::drives(std::string_view channel) const {
    return std::find(driven.begin(), driven.end(), channel) != driven.end();
}

std::optional<int> Recording::channel(std::string_view channel_name) const {
    for (std::size_t index = 0; index < channels.size(); ++index) {
        if (channels[index].name == channel_name) return static_cast<int>(index);
    }
    return std::nullopt;
}

int Recording::samples() const {
    int sum = 0;
    for (const RecordedRun& run : runs) sum += run.samples();
    return sum;
}

bool Recording::is_predicted(std::string_view channel_name) const {
    return std::any_of(runs.begin(), runs.end(),
                       [&](const RecordedRun& run) { return !run.drives(channel_name); });
}

}  // namespace capstan
