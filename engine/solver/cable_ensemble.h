#pragma once

#include <span>
#include <vector>

#include "capstan/cable/cable_state.h"
#include "capstan/solver/end_condition.h"
#include "capstan/solver/model_rules.h"
#include "capstan/solver/prefix_tables.h"

namespace capstan {

/// How one step of all members went.
struct EnsembleReport {
    int searched = 0;    ///< members whose first pattern did not verify, so that the search had to run
    int unverified = 0;  ///< members for which no pattern verified; the likely one was written
};

/// Many cables cut alike, each with its own friction, wrap, stiffness and state, stepped side by side in SIMD
/// lanes under ModelRules::consistent(). Each member takes the step that QuasiStaticStep would take, within
/// rounding. Arrays are rows of members: `tension_N(node)[member]`.
class CableEnsemble {
    template <class Rows>
    auto row(Rows& rows, int index) const {
        return std::span(rows).subspan(static_cast<std::size_t>(index) * members_, members_);
    }

  public:
    /// All members begin as `cable`, pretensioned. `members` is a multiple of 8; throws InvalidInput.
    CableEnsemble(const Cable& cable, int members);

    int members() const { return members_; }
    int nodes() const { return nodes_; }
    int segments() const { return nodes_ - 1; }

    std::span<double> tension_N(int node) { return row(tension_N_, node); }              ///< members
    std::span<const double> tension_N(int node) const { return row(tension_N_, node); }  ///< members
    std::span<double> displacement_m(int node) { return row(displacement_m_, node); }    ///< members
    std::span<const double> displacement_m(int node) const { return row(displacement_m_, node); }

    /// mu_d times wrap angle of a segment; retune() makes a change count.
    std::span<double> sliding_exponent(int segment) { return row(sliding_exponent_, segment); }  ///< members
    /// Elongation of a segment of mean length per newton of mean tension [m/N].
    std::span<double> compliance_m_per_N() { return compliance_m_per_N_; }              ///< members
    std::span<const double> compliance_m_per_N() const { return compliance_m_per_N_; }  ///< members
    std::span<const double> relative_length() const { return relative_length_; }        ///< segments
    void retune();

    std::span<const double> slack() const { return slack_; }  ///< members: 1 where slack, else 0
    bool is_slack(int member) const { return slack_[member] != 0.0; }
    /// The member carries nothing from now on.
    void make_slack(int member);
    CableState state_of(int member) const;

    /// What the distal end obeys: E6 with these factors, and a value for each member.
    struct DistalEnd {
        double displacement_factor = 1.0;
        double tension_factor = 0.0;
        std::span<const double> value;  // members
    };
    /// One quasi-static step: the proximal end moves by `proximal_increment_m` in every member. Throws
    /// InvalidInput where an input is not a finite number; the members are then unchanged.
    EnsembleReport advance(double proximal_increment_m, const DistalEnd& distal);

  private:
    friend struct EnsembleLanes;

    bool search(int member, const EndConditions& ends);
    MotionPattern pattern_of(int member) const;

    int members_;
    int nodes_;
    double static_to_dynamic_;             // mu_s / mu_d
    NodeTable tension_N_;                  // nodes x members
    NodeTable displacement_m_;             // nodes x members
    NodeTable sliding_exponent_;           // segments x members
    NodeTable sliding_ratio_;              // segments x members
    NodeTable inverse_ratio_;              // segments x members: 1 / sliding ratio
    NodeTable breakaway_ratio_;            // segments x members
    NodeTable compliance_m_per_N_;         // members
    std::vector<double> relative_length_;  // segments
    NodeTable next_tension_N_;             // nodes x members: what a step would write
    NodeTable next_displacement_m_;        // nodes x members
    NodeTable motion_;  // 4 x members: direction and count of the proximal side, of the distal side
    NodeTable slack_;   // members: 1 where slack
    NodeTable left_;    // members: 1 for those that the search has to solve
    CableState scratch_;
    PrefixTables scratch_tables_;
};

}  // namespace capstan
