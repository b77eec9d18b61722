#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/worlds/error_table.h"
#include "capstan/worlds/straight_pieces.h"

namespace capstan {

/// A number that worlds were drawn for, with the 95% interval that the draws leave open (Student's t).
struct Estimated {
    double value_N = 0.0;
    double low_N = 0.0;
    double high_N = 0.0;
};

/// What to expect of a candidate on a rig, from worlds that had no part in choosing it.
struct Expected {
    int candidate = 0;
    Estimated objective;      ///< the plan's objective, over worlds
    double error_95_N = 0.0;  ///< that 95% of the worlds stay below, of the same error
    double rms_N = 0.0;       ///< root of the mean square error over worlds, samples and nodes
    double load_end_N = 0.0;  ///< mean over worlds
    double whole_cable_N = 0.0;
    double worst_place_N = 0.0;
    double covered_fraction = 0.0;  ///< of the true tensions within the 95% band
    double covered_at_most = 0.0;   ///< upper end of its 95% interval over worlds
    /// Richardson's estimate of the objective's error - its exact value, on part of the worlds.
    double discretisation_N = 0.0;
    double error_95_discretisation_N = 0.0;  ///< the same of `error_95_N`
    double load_end_discretisation_N = 0.0;  ///< the same of `load_end_N`
};

/// The best candidate of a price.
struct PriceBest {
    double price = 0.0;
    int candidates = 0;  ///< of this price
    Expected expected;
    double selected_N = 0.0;  ///< the objective on the worlds that chose it
    std::vector<int> alike;   ///< others whose sensors read the same, so that their errors are the same
    std::vector<int> ties;    ///< others that the worlds do not tell from it (paired t, Bonferroni, 5%), or
                              ///< that can be better by no more than the resolution
    bool on_front = false;    ///< better than everything cheaper
};

/// How far the answer of a greedy search can be from the best of all sets. Worlds are drawn from what the
/// estimator believes, so the posterior mean of all usable sensors together has no larger error than that of
/// any set of them: in the mean square always, in the mean absolute error where the posterior is symmetric.
/// The ensemble filter takes it to be normal, and obeyed the first law within 2% wherever it was tested.
struct SearchBound {
    Expected all;  ///< every usable sensor together, allowed or not
    bool is_of_rms =
        false;      ///< the objective has no such law, so that `gap` is of the root mean square error
    Estimated gap;  ///< recommended - all, paired: no allowed set is better by more; at least 0
    std::vector<Estimated> of_prices;  ///< the same of the best set of each price
};

/// By how much knowing something would lower the recommended set's error.
struct KnowledgeGain {
    Condition condition = Condition::friction_known;
    Estimated gain;  ///< of the objective's error, paired
};

/// How the advice fares where the stated widths are wrong.
struct Robustness {
    Condition condition = Condition::half_width;
    Estimated error;  ///< of the recommended set
    int best = 0;     ///< of the sets of that price that were compared
    Estimated loss;   ///< recommended - best, paired
    double covered_fraction = 0.0;
    bool flips = false;  ///< another set of that price is better by more than the resolution (paired t, 5%)
};

/// The mean error over worlds of the recommended set (of no sensor where none is recommended) with more
/// segments, and the order that all sets' errors are extrapolated with.
struct GridError {
    int segments = 0;
    int worlds = 0;
    double coarse_N = 0.0;  ///< the same worlds with these segments, twice and four times as many
    double finer_N = 0.0;
    double finest_N = 0.0;
    double order = 1.0;  ///< measured over all sets whose errors are stated, within 0.5 and 2
};

struct PaperComparison {
    Condition condition = Condition::paper_mean;
    Estimated error;  ///< of the recommended sensors with the paper's estimator
};

struct WorldAnswer {
    std::vector<SensorOffer> offers;
    std::vector<StraightPiece> pieces;  ///< offers: where else each would read the same
    std::vector<Candidate> candidates;  ///< what `candidate` counts everywhere
    int worlds = 0;                     ///< for choosing, and as many others for what is expected
    double resolution_N = 0.0;          ///< differences below this were not followed up
    std::size_t trials = 0;             ///< candidate x world that were run to choose
    std::vector<PriceBest> prices;      ///< rising; without the set that has no sensor
    Expected no_sensor;
    std::vector<Expected> baselines;  ///< the motor's torque; the motor's torque and an encoder at the load
    std::optional<std::size_t> recommended;  ///< of `prices`; none: nothing is better than no sensor
    Estimated gain_over_none;                ///< no sensor - recommended, paired
    std::optional<int> further;              ///< the best candidate with one more sensor
    Estimated further_gain;
    std::vector<KnowledgeGain> knowledge;
    std::vector<Robustness> robustness;
    GridError grid;
    std::vector<PaperComparison> paper;
    std::optional<SearchBound> bound;  ///< of a greedy search; otherwise all sets of the search were compared
    std::optional<std::size_t> cheapest_below_target;  ///< of `prices`

    /// The recommended set, or the cheapest one where none is.
    const PriceBest& best() const { return prices[recommended.value_or(0)]; }
    const Candidate& set(int candidate) const { return candidates[static_cast<std::size_t>(candidate)]; }
    std::string words(int candidate) const { return words_of(set(candidate), offers); }
};

/// The value of the plan's objective in a world.
double objective_of(PlacementObjective objective, const WorldError& error);

/// Compares the candidates on common worlds, in rounds: those that are worse than the best of their price in
/// a paired t test are left out (5% over all looks and candidates), until all worlds are used or every
/// difference left is below the resolution. What is recommended and what is said of it comes from as many
/// other worlds. Throws TableStopped.
WorldAnswer choose_sensors(ErrorTable& table);

}  // namespace capstan
