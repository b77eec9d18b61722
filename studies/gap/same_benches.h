#pragma once

#include <span>
#include <vector>

#include "capstan/gap/cause_fit.h"

namespace capstan::gap {

/// Hypotheses that differ in sensor faults only: one bench is moved for all of them.
struct SameBench {
    Hypothesis mechanical;
    BenchNumbers numbers;
    std::vector<std::size_t> hypotheses;
};

std::vector<SameBench> by_bench(std::span<const Hypothesis> hypotheses);

/// At most bench_lanes; those that ring apart from those that do not.
using BenchGroup = std::vector<SameBench>;
std::vector<BenchGroup> to_be_moved_at_once(const std::vector<SameBench>& benches);

}  // namespace capstan::gap
