#pragma once

#include <span>

namespace capstan {

/// Sums over the members of the recursive estimator, node by node: where it spends its time. Whatever SIMD
/// the processor has (Highway, chosen at run time) works on nodes side by side and on members in order, so
/// every processor gives the same bits. `tension_N` is one pointer for each member, to as many numbers as
/// there are nodes.
using MemberRows = std::span<double* const>;  // members

/// Mean and standard deviation [N] over the members.
void member_moments(MemberRows tension_N, std::span<double> mean_N,  // nodes
                    std::span<double> deviation_N);                  // nodes

/// Sum over the members of `weight` times tension.
void weighted_member_sums(MemberRows tension_N, std::span<const double> weight,  // members
                          std::span<double> sum);                                // nodes

/// What one reading does to the nodes (E37).
struct GainTerms {
    double members = 0.0;
    double variance = 0.0;  ///< of the sensed tension over the members [N2]
    double total = 0.0;     ///< with the reading's noise [N2]
    double fraction = 0.0;  ///< of the gain by which members move towards their mean
    double chance_variances = 0.0;
};

/// Sums of weighted_member_sums() become gains, and the members' deviations what they are after the reading.
void gains_of_sums(const GainTerms& terms, std::span<double> gain,  // nodes
                   std::span<double> deviation_N);                  // nodes

/// Of every member, each node's value += gain * pull.
void add_pulls(std::span<const double> gain,  // nodes
               std::span<const double> pull,  // members
               MemberRows value);

}  // namespace capstan
