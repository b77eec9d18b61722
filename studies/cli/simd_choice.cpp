#include <fmt/format.h>
#include <hwy/targets.h>

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "capstan/cli/command.h"
#include "capstan/cli/program.h"

namespace capstan::cli {

namespace {

// Of those that the program was built for. The lower bit is the better target.
std::int64_t targets_here() {
    return hwy::SupportedTargets() & HWY_TARGETS;
}

std::string names(std::int64_t targets) {
    std::string list;
    for (; targets != 0; targets &= targets - 1)
        list += fmt::format("{}{}", list.empty() ? "" : ", ", hwy::TargetName(targets & -targets));
    return list;
}

}  // namespace

std::string simd_in_use() {
    return hwy::TargetName(targets_here() & -targets_here());
}

void limit_simd_from_environment() {
    const char* const wanted = std::getenv("CAPSTAN_SIMD");
    if (wanted == nullptr || std::string_view(wanted).empty()) return;
    const std::int64_t there = targets_here();
    for (std::int64_t rest = there; rest != 0; rest &= rest - 1) {
        const std::int64_t target = rest & -rest;
        if (std::string_view(hwy::TargetName(target)) != wanted) continue;
        hwy::DisableTargets(target - 1);
        return;
    }
    throw UsageError(
        fmt::format("CAPSTAN_SIMD={}: this program on this processor has {}", wanted, names(there)));
}

}  // namespace capstan::cli
