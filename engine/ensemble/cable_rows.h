#pragma once

#include <cstddef>

namespace capstan {

/// The members of an ensemble of cables as the loops over their nodes see them. Members that are slack keep
/// their tensions and displacements.
struct CableRows {
    std::size_t members;
    int nodes;
    double* tension_N;                 ///< nodes x members
    double* displacement_m;            ///< nodes x members
    const double* compliance_m_per_N;  ///< members: of a segment of mean length
    const double* relative_length;     ///< segments
    const double* slack;               ///< members: 1 where slack, else 0
};

/// No tension stays below 0, also of slack members; `highest_N` (members) becomes the largest of each.
void clip_tensions(const CableRows& rows, double* highest_N);

/// E2 with the mean of both nodes' tensions, back from the distal end at `distal_m` (members).
void place_nodes(const CableRows& rows, const double* distal_m);

/// Moves what holds the distal end, with the compliance `spring_m_per_N`, and the proximal end by these
/// (members), under a tension that changes by as much everywhere along the cable.
void stretch_rows(const CableRows& rows, const double* far_end_by_m, const double* proximal_by_m,
                  double spring_m_per_N);

}  // namespace capstan
