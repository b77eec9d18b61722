#pragma once

#include <span>
#include <vector>

#include "capstan/search/sensor_subsets.h"

namespace capstan {

/// Weighted sums of single-sensor profiles over every sensor set, and the errors of their averages.
struct SubsetSums {
    int stride = 0;                  ///< padded nodes
    std::vector<double> factor;      // places: weight of each sensor
    std::vector<double> weight;      // subsets: sum of factors
    std::vector<double> tension_N;   // subsets x stride: sum of factor times profile
    std::vector<double> average_N;   // subsets x stride: tension_N / weight; empty where nobody asks for it
    std::vector<double> mean_abs_N;  // subsets: of average - truth, weighted by the fraction of the nodes

    const double* sum_N(int subset) const {
        return tension_N.data() + static_cast<std::ptrdiff_t>(subset) * stride;
    }
    const double* average_of(int subset) const {
        return average_N.data() + static_cast<std::ptrdiff_t>(subset) * stride;
    }
};

enum class Averages { keep, leave_out };

/// Room for all sets; `factor` is one positive number for each place.
SubsetSums make_subset_sums(const SensorSubsets& subsets, std::vector<double> factor, int nodes,
                            Averages averages);

/// Fills the sums. `profile_N` is one pointer for each place, to `stride` numbers; truth and fraction are
/// `stride` long, zero in the padding.
void fill_subset_sums(const SensorSubsets& subsets, std::span<const double* const> profile_N,
                      std::span<const double> truth_N, std::span<const double> fraction, SubsetSums& sums);

}  // namespace capstan
