#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "capstan/storage/records.h"

namespace capstan {

/// Half the width of a 95% interval in standard errors.
inline constexpr double normal_95 = 1.959963984540054;

/// Quantile by linear interpolation between order statistics (type 7). Reorders `values`.
double quantile(std::span<double> values, double fraction);

/// Errors of one cell over one block of repetitions.
struct BlockSums {
    double error_N = 0.0;           ///< of the error averaged over nodes
    double squared_error_N2 = 0.0;  ///< of the node errors squared, averaged over nodes
    int unverified = 0;             ///< single-sensor estimates that were fused
    int ambiguous = 0;
    std::vector<double> node_abs_error_N;     // nodes
    std::vector<double> node_signed_error_N;  // nodes
};

/// The errors that a cell summarises.
struct CellErrors {
    int set_index = 0;
    std::string_view method;
    int sensor_count = 0;
    std::span<const BlockSums> blocks;     // blocks, in order
    std::span<const int> block_sizes;      // blocks
    std::span<double> repetition_error_N;  // repetitions; reordered
};

storage::CellRecord summarise_cell(const CellErrors& errors);

}  // namespace capstan
