#include "capstan/recording/recording.h"

#include <algorithm>

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
