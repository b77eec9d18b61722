#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "capstan/recording/recording.h"

namespace capstan::gap {

/// Samples of a block of one second: what hangs together in time is drawn together.
int bootstrap_block_samples(const Recording& recording);

/// Shows 400 draws of `blocks` blocks with replacement, as their indices. A seed's draws are the same
/// everywhere.
void for_each_bootstrap_draw(std::size_t blocks, std::uint64_t seed,
                             const std::function<void(std::span<const std::size_t> drawn)>& show);

struct BootstrapInterval {
    double low = 0.0;
    double high = 0.0;
};

/// The middle 95% of at least one number.
BootstrapInterval middle_95(std::vector<double> drawn);

}  // namespace capstan::gap
