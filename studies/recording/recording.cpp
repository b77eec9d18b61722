#include "capstan/recording/recording.h"

#include <algorithm>

namespace capstan {

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

}  // namespace capstan
