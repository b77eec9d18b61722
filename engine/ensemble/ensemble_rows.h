#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace capstan {

/// Rows of numbers, one for each member of an ensemble, in SIMD lanes (Highway, chosen at run time). All rows
/// of a call have as many members, a multiple of 8.
struct RowMoments {
    double mean = 0.0;
    double deviation = 0.0;  ///< standard deviation, members - 1
};
RowMoments moments_of_row(std::span<const double> row);

/// Which fraction of a correlation of so many members is to be expected in truth: a correlation is none, or
/// any between -1 and 1, each as likely (E58). `chance` is the variance of a correlation by chance, in that
/// of so many independent members.
double expected_fraction(double correlation, double members, double chance);

/// The same from a table over the square of the correlation, within 1e-4.
class ExpectedFraction {
  public:
    ExpectedFraction(int members, double chance);

    double of_squared(double squared_correlation) const {
        const double at = (squared_correlation < 1.0 ? squared_correlation : 1.0) * intervals_;
        const auto below = static_cast<std::size_t>(at);
        const double fraction = at - static_cast<double>(below);
        return table_[below] + fraction * (table_[below + 1] - table_[below]);
    }

  private:
    double intervals_;
    std::vector<double> table_;  // the intervals' ends, the last of them twice
};

/// What a reading says to every row (E58).
struct RowCorrection {
    std::span<const double> sensed;  ///< members: what each would read, less their mean
    std::span<const double> moves;   ///< members: 1, or 0 for those that are left alone
    double off = 0.0;                ///< the reading less the mean of what the members would read
    double sensed_squares = 0.0;     ///< sum of the squares of `sensed`
    double total_squares = 0.0;      ///< the same with the reading's noise
    const ExpectedFraction& expected;
};

/// Moves the mean of each row by the correlation with what is sensed, as far as it is to be expected in
/// truth, and draws its members together by as much as that explains.
void correct_rows(const RowCorrection& correction, std::span<double* const> rows);

/// result = exp(row)
void exp_row(std::span<const double> row, std::span<double> result);

}  // namespace capstan
