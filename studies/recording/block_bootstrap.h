#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "capstan/recording/recording.h"

namespace capstan {

/// Samples of a block of one second: samples that are correlated in time are drawn together.
inline int bootstrap_block_samples(const Recording& recording) {
    constexpr double block_s = 1.0;
    return std::max(1, static_cast<int>(block_s * recording.sample_rate_Hz));
}

/// Calls `show` with 400 draws of `blocks` blocks with replacement, each a span of block indices. A seed's
/// draws are the same on every machine.
template <class Show>
void for_each_bootstrap_draw(std::size_t blocks, std::uint64_t seed, const Show& show) {
    constexpr int draws = 400;
    std::mt19937_64 random(seed);
    std::vector<std::size_t> drawn(blocks);
    for (int draw = 0; draw < draws; ++draw) {
        for (std::size_t& block : drawn) block = random() % blocks;
        show(std::span<const std::size_t>(drawn));
    }
}

struct BootstrapInterval {
    double low = 0.0;
    double high = 0.0;
};

/// The middle 95% of at least one number.
inline BootstrapInterval middle_95(std::vector<double> drawn) {
    std::sort(drawn.begin(), drawn.end());
    const std::size_t beyond = drawn.size() / 40;
    return {drawn[beyond], drawn[drawn.size() - 1 - beyond]};
}

}  // namespace capstan
