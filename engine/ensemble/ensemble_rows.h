#pragma once

#include <span>

namespace capstan {

/// Rows of numbers, one for each member of an ensemble, in SIMD lanes (Highway, chosen at run time). All rows
/// of a call have as many members, a multiple of 8.
struct RowMoments {
    double mean = 0.0;
    double deviation = 0.0;  ///< standard deviation, members - 1
};
RowMoments moments_of_row(std::span<const double> row);

/// What a reading says to every row (E37).
struct RowCorrection {
    std::span<const double> sensed;  ///< members: what each would read, less their mean
    std::span<const double> pull;    ///< members: by how much each is off, in the reading's unit
    double sensed_squares = 0.0;     ///< sum of the squares of `sensed`
    double total_squares = 0.0;      ///< the same with the reading's noise
    double chance_variances = 0.0;
};
/// Each row += s c / total pull, c the row's covariance with what is sensed, s its screening against chance.
void correct_rows(const RowCorrection& correction, std::span<double* const> rows);

/// result = exp(row)
void exp_row(std::span<const double> row, std::span<double> result);

}  // namespace capstan
