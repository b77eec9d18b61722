#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capstan/residual_law/residual_features.h"

namespace capstan::residual_law {

/// How the channels are called in sentences, and their units.
struct ResidualNames {
    std::string channel = "motor torque";
    std::string output = "torque";  ///< what it is: "torque", "angle", "tension"
    std::string output_unit = "N m";
    std::string motion = "motor angle";
    std::string motion_unit = "rad";
    std::string load = "load";
    std::string load_unit = "N m";
};

/// A term of a sparse law.
struct LawTerm {
    Term features;
    double size = 0.0;        ///< of the output where the feature is 1, or the amplitude of a wave
    double half_width = 0.0;  ///< of its 95% interval (jackknife over runs); 0: too few runs for one
    std::string words;        ///< "a torque of 12 +- 2 mN m that follows the direction of motion ..."
};

struct WeightedFeature {
    Feature feature;
    double weight = 0.0;
};

/// The structure of what a corrected model leaves: a sparse law in a few terms, a ridge regression on the
/// motion's history, both, or nothing. A plain value.
struct ResidualLaw {
    FeatureScales scales;
    std::vector<WeightedFeature> weights;  ///< all that a prediction needs; empty: nothing holds
    std::vector<LawTerm> terms;            ///< of the sparse law, the most useful first
    bool has_history_model = false;        ///< a ridge regression adds to the terms
    double residual_rms = 0.0;             ///< of the runs it was fitted to, each run counts alike
    double left_out_rms = 0.0;             ///< what is left of that on runs that were left out
    /// Fraction of the squares that is removed on runs left out, which from four runs on had no part in the
    /// choice of terms; with its 95% interval (jackknife over runs). No interval from fewer than three parts.
    double removed_fraction = 0.0;
    std::optional<double> removed_low;
    std::optional<double> removed_high;
    double band = 0.0;  ///< 95% of left-out residuals are within +- this of the law

    bool holds() const { return !weights.empty(); }
    /// What the law adds to the model's output, at every sample of a run with the same channels.
    std::vector<double> predict(const ResidualRun& run) const;
};

/// Looks for structure in residuals. Terms are added one by one, each by its error on runs that are left out
/// in turn (quarters of the only run), as long as the error falls by more than twice its standard error over
/// the runs. A ridge regression on all stop operators, with and without the load, is added on the same
/// condition. What does not remove anything when its choice is repeated without each run is dropped.
ResidualLaw fit_residual_law(std::span<const ResidualRun> runs, const ResidualNames& names);

/// One sentence: "What is left in the motor torque is 8.1 mN m: ..."; empty if nothing holds.
std::string law_sentence(const ResidualLaw& law, const ResidualNames& names);

}  // namespace capstan::residual_law
