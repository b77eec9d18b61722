#pragma once

#include <cstddef>

namespace capstan {

/// What the kernel sees of an ensemble: rows of members.
struct EnsembleView {
    std::size_t members;
    int nodes;
    double static_to_dynamic;
    double* tension_N;
    double* displacement_m;
    const double* exponent;
    double* sliding_ratio;
    double* inverse_ratio;
    double* breakaway_ratio;
    const double* compliance_m_per_N;
    const double* relative_length;
    double* next_tension_N;
    double* next_displacement_m;
    double* proximal_direction;
    double* proximal_count;
    double* distal_direction;
    double* distal_count;
};

struct EnsembleInputs {
    double proximal_increment_m;
    double displacement_factor;
    double tension_factor;
    const double* value;  // members
    double* left;         // members: in: 1 for those to leave out; out: 1 for those not solved
};

/// Sliding and breakaway ratios of all segments from the exponents.
void make_ensemble_ratios(const EnsembleView& view);
/// One step of all members; those that it cannot solve stay as they were.
void step_ensemble(const EnsembleView& view, const EnsembleInputs& inputs);

}  // namespace capstan
