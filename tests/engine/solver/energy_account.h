#pragma once

#include "capstan/cable/cable_state.h"

namespace capstan::test {

/// Where the work goes that both ends do on a cable in one step, with tensions taken at the middle of the
/// step. Exactly ends_J = stored_J + friction_J + untaken_slack_J, by summation by parts, as long as every
/// taut segment stretches by one rule, dx / EA times the mean of its nodes' tensions (E2 and E3 with
/// ElongationRule::mean_tension).
struct EnergyAccount {
    double ends_J = 0.0;        ///< T du at the distal end less T du at the proximal one
    double throughput_J = 0.0;  ///< the same without signs: what rounding is measured by
    double stored_J = 0.0;      ///< rise of the elastic energy of all segments
    double friction_J = 0.0;    ///< tension difference times sliding of all segments
    /// A slack segment is shorter than its tension of 0 explains, by a gap. In the step in which a cable goes
    /// slack, or taut again, the middle tension is half that of its taut end, and the account uses it for
    /// the complete step although the gap opened at zero tension: too much by middle tension times gap.
    double untaken_slack_J = 0.0;
    double worst_sliding_J = 0.0;  ///< the least that a segment lost that slid on the way it slid before

    EnergyAccount& operator+=(const EnergyAccount& step);
    double imbalance_J() const { return ends_J - stored_J - friction_J - untaken_slack_J; }
};

EnergyAccount account(const Cable& cable, const CableState& before, const CableState& after);

}  // namespace capstan::test
