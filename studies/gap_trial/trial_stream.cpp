#include "capstan/gap_trial/trial_stream.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace capstan::gap_trial {

TrialStream::TrialStream(std::uint64_t seed, int case_index, DrawTopic topic)
    : address_{seed, RandomPurpose::reading_noise, static_cast<std::uint32_t>(case_index),
               static_cast<std::uint32_t>(topic), 0} {}

double TrialStream::normal() {
    if (has_spare_) {
        has_spare_ = false;
        return spare_;
    }
    const auto pair = standard_normals(address_);
    ++address_.node;
    spare_ = pair[1];
    has_spare_ = true;
    return pair[0];
}

double TrialStream::uniform(double low, double high) {
    const double fraction = 0.5 * std::erfc(-normal() / std::numbers::sqrt2);
    return low + (high - low) * fraction;
}

double TrialStream::log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
}

int TrialStream::integer_below(int count) {
    return std::min(count - 1, static_cast<int>(uniform(0.0, count)));
}

double TrialStream::sign() {
    return normal() < 0.0 ? -1.0 : 1.0;
}

}  // namespace capstan::gap_trial
