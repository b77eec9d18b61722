#pragma once
// A study with made-up but plausible numbers, in the shape of the paper's: 10 segments, 2 instants per
// regime, layouts Even, Distal and Both, seven methods.

#include <cstdint>
#include <filesystem>
#include <string>

namespace capstan::sample {

struct SampleOptions {
    std::string name = "Sensor placement, the paper's cable";
    bool with_partial_regime = true;
    bool with_paper_comparison = true;
    bool with_node_errors = true;
    int noise_levels = 1;      // of '10 %', '5 %', '0.2 N'
    bool mixed_bends = false;  // bends of several radii and straight runs, not one long bend
};

// Creates the database file if need be and adds one complete study.
std::int64_t add_sample_study(const std::filesystem::path& database, const SampleOptions& options = {});

}  // namespace capstan::sample
