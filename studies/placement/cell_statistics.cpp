#include "capstan/placement/cell_statistics.h"

#include <algorithm>
#include <cmath>

#include "capstan/placement/intervals.h"

namespace capstan {

double quantile(std::span<double> values, double fraction) {
    const double place = fraction * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    std::nth_element(values.begin(), values.begin() + below, values.end());
    const double low = values[below];
    if (below + 1 == values.size()) return low;
    const double high = *std::min_element(values.begin() + below + 1, values.end());
    return low + (place - static_cast<double>(below)) * (high - low);
}

storage::CellRecord summarise_cell(const CellErrors& errors) {
    const int repetitions = static_cast<int>(errors.repetition_error_N.size());
    const std::size_t nodes = errors.blocks.front().node_abs_error_N.size();
    storage::CellRecord cell;
    cell.set_index = errors.set_index;
    cell.method = errors.method;
    cell.repetitions = repetitions;

    const MeanAndError mean = mean_and_error(errors.repetition_error_N);
    cell.mean_abs_error_N = mean.mean;
    cell.standard_error_N = mean.standard_error;
    cell.interval_low_N = mean.mean - normal_95 * mean.standard_error;
    cell.interval_high_N = mean.mean + normal_95 * mean.standard_error;

    double squares = 0.0;
    long unverified = 0;
    long ambiguous = 0;
    cell.nodes.resize(nodes);
    for (std::size_t b = 0; b < errors.blocks.size(); ++b) {
        const BlockSums& block = errors.blocks[b];
        squares += block.squared_error_N2;
        unverified += block.unverified;
        ambiguous += block.ambiguous;
        cell.block_mean_abs_error_N.push_back(block.error_N / errors.block_sizes[b]);
        for (std::size_t node = 0; node < nodes; ++node) {
            cell.nodes[node].mean_abs_error_N += block.node_abs_error_N[node] / repetitions;
            cell.nodes[node].bias_N += block.node_signed_error_N[node] / repetitions;
        }
    }
    cell.rms_error_N = std::sqrt(squares / repetitions);
    const double estimates = static_cast<double>(repetitions) * errors.sensor_count;
    cell.unverified_fraction = static_cast<double>(unverified) / estimates;
    cell.ambiguous_fraction = static_cast<double>(ambiguous) / estimates;

    for (std::size_t node = 0; node < nodes; ++node) {
        cell.nodes[node].node = static_cast<int>(node) + 1;
        cell.bias_N += cell.nodes[node].bias_N / static_cast<double>(nodes);
        if (cell.nodes[node].mean_abs_error_N > cell.worst_node_error_N) {
            cell.worst_node = static_cast<int>(node) + 1;
            cell.worst_node_error_N = cell.nodes[node].mean_abs_error_N;
        }
    }
    if (cell.worst_node == 0) cell.worst_node = 1;  // no error anywhere
    cell.error_q05_N = quantile(errors.repetition_error_N, 0.05);
    cell.error_q50_N = quantile(errors.repetition_error_N, 0.50);
    cell.error_q95_N = quantile(errors.repetition_error_N, 0.95);
    return cell;
}

}  // namespace capstan
