#pragma once

namespace capstan {

/// How many benches of one geometry move side by side, a bench in each SIMD lane.
inline constexpr int bench_lanes = 4;

/// One number of each bench.
struct alignas(32) LaneValues {
    double of[bench_lanes] = {};
};

/// Of which benches something is true.
struct LaneFlags {
    bool of[bench_lanes] = {};
};

}  // namespace capstan
