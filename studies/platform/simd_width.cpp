#include "capstan/platform/simd_width.h"

#include <hwy/targets.h>

#include <cstdint>

namespace capstan {

namespace {

// Of those that the program was built for. The lower bit is the better target.
std::int64_t simd_targets() {
    return hwy::SupportedTargets() & HWY_TARGETS;
}

}  // namespace

std::string simd_width() {
    return hwy::TargetName(simd_targets() & -simd_targets());
}

std::vector<std::string> simd_widths() {
    std::vector<std::string> names;
    for (std::int64_t rest = simd_targets(); rest != 0; rest &= rest - 1)
        names.emplace_back(hwy::TargetName(rest & -rest));
    return names;
}

bool limit_simd_width(std::string_view name) {
    for (std::int64_t rest = simd_targets(); rest != 0; rest &= rest - 1) {
        const std::int64_t target = rest & -rest;
        if (hwy::TargetName(target) != name) continue;
        // Not DisableTargets(): with it, every look at the supported targets gives the kernels all of them back.
        hwy::SetSupportedTargetsForTest(simd_targets() & ~(target - 1));
        return true;
    }
    return false;
}

}  // namespace capstan
