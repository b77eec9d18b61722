#pragma once

#include <set>
#include <string>
#include <vector>

#include "capstan/blind_trial/fraction.h"
#include "capstan/blind_trial/trial_answer.h"
#include "capstan/gap_trial/trial_case.h"

namespace capstan::gap_trial {

/// An effect is named where its `present` is at least this.
inline constexpr double named_from = 0.3;
/// Less likely effects are no statements whose calibration could be judged.
inline constexpr double stated_from = 0.05;

/// What is there in a case, and what every rig has of it.
struct CaseTruth {
    std::set<std::string> causes;  ///< effects
    std::set<std::string>
        nuisances;  ///< effects that are not causes; to name them is neither right nor wrong
};
CaseTruth truth_of(const CaseLabel& label);

/// The ranked effects without those that are neither right nor wrong. A nuisance that is said to follow a
/// condition is a statement, and stays. The probabilities are those of the others alone: they sum to 1 again.
std::vector<AnsweredEffect> judged(const CaseAnswer& answer, const CaseTruth& truth);

/// Stated probabilities of one bin against how often they were right, with Wilson's interval.
struct ReliabilityBin {
    double from = 0.0;
    double to = 0.0;
    double mean_probability = 0.0;
    Fraction right;
};

/// Collects statements in ten bins.
class Reliability {
  public:
    void add(double stated, bool is_right);
    /// Those that hold a statement.
    std::vector<ReliabilityBin> bins() const;
    /// Mean gap between stated and found, weighted by statements.
    double calibration_error() const;
    /// Its mean if every probability is right: few statements of a bin are seldom right as often as stated.
    double calibration_error_by_chance() const;

  private:
    std::vector<ReliabilityBin> sums_ = std::vector<ReliabilityBin>(10);
};

/// How a group of cases or of causes fares.
struct CauseGroup {
    std::string by;  ///< "all", "causes" (their number), "bench"; of causes also "effect", "visibility"
    std::string name;
    Fraction recall;       ///< causes that are named
    Fraction all_named;    ///< cases with causes of which each is named
    Fraction first;        ///< cases whose first effect is a cause, or `none` where there is none
    Fraction false_names;  ///< cases in which something is named that is not there
};

/// Several causes by name. `unknown` is not a name: it is counted apart.
struct CausesScore {
    std::vector<CauseGroup> groups;  ///< the first is of all cases
    Fraction unknown;                ///< cases with causes of the catalogue in which `unknown` is named
    Fraction varies;                 ///< named causes that vary: the right condition is stated
    Fraction false_varies;           ///< named effects that do not vary: a condition is stated all the same
    std::vector<ReliabilityBin> reliability;  ///< of every effect with `present` of at least 0.05
    double calibration_error = 0.0;
    double calibration_error_by_chance = 0.0;
};

struct NamedCase {
    const CaseLabel* label;
    const CaseAnswer* answer;
};
CausesScore score_causes(const std::vector<NamedCase>& cases);

}  // namespace capstan::gap_trial
