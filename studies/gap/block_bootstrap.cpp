#include "capstan/gap/block_bootstrap.h"

#include <algorithm>
#include <random>

namespace capstan::gap {

int bootstrap_block_samples(const Recording& recording) {
    constexpr double block_s = 1.0;
    return std::max(1, static_cast<int>(block_s * recording.sample_rate_Hz));
}

void for_each_bootstrap_draw(std::size_t blocks, std::uint64_t seed,
                             const std::function<void(std::span<const std::size_t> drawn)>& show) {
    constexpr int draws = 400;
    std::mt19937_64 random(seed);
    std::vector<std::size_t> drawn(blocks);
    for (int draw = 0; draw < draws; ++draw) {
        for (std::size_t& block : drawn) block = random() % blocks;
        show(drawn);
    }
}

BootstrapInterval middle_95(std::vector<double> drawn) {
    std::sort(drawn.begin(), drawn.end());
    const std::size_t beyond = drawn.size() / 40;
    return {drawn[beyond], drawn[drawn.size() - 1 - beyond]};
}

}  // namespace capstan::gap
