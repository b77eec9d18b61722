#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace capstan::residual_law {

/// What a model leaves of one channel in one run, with the channels that drive the run.
struct ResidualRun {
    std::vector<double> motion;    // samples: an angle or a displacement, or what else moves the bench
    std::vector<double> load;      // samples; empty where none is recorded
    std::vector<double> residual;  // samples: measured minus model; empty in a run to be predicted
    double sample_period_s = 0.0;
    std::size_t first_scored = 0;  ///< samples before it do not count, because the earlier motion is unknown
    double session_start_s = 0.0;
};

/// What residuals may depend on. Names in files.
enum class FeatureKind {
    constant,
    position,   ///< power `parameter` of the motion about the middle of its range
    wave_sine,  ///< of the motion, with the period `parameter`
    wave_cosine,
    speed,
    speed_magnitude,
    friction,    ///< stop operator (E50) with the limit `parameter`
    relaxation,  ///< the direction of motion, fading with the time constant `parameter` after a reversal
    session_time,
};

std::string name_of(FeatureKind kind);
/// Throws InvalidInput for a name that is none.
FeatureKind feature_kind_of(const std::string& name);

struct Feature {
    FeatureKind kind = FeatureKind::constant;
    double parameter = 0.0;  ///< of its kind, in SI units; 0: it has none
    bool times_load = false;
};

/// The scales of the runs that a law was fitted to: they make every feature about 1.
struct FeatureScales {
    double motion_middle = 0.0;
    double motion_half_range = 1.0;
    double speed = 1.0;      ///< the largest, per second
    double load = 0.0;       ///< that of the largest magnitude, with its sign; 0: no load is recorded
    double session_s = 0.0;  ///< to the end of the last run; 0: where runs lie in the session is not stated
};

FeatureScales scales_of(const std::vector<ResidualRun>& runs);

/// The feature at every sample of a run.
Eigen::VectorXd column_of(const Feature& feature, const FeatureScales& scales, const ResidualRun& run);

/// A part of a sparse law: the features that are added or left out together.
using Term = std::vector<Feature>;

/// Every term that a sparse law may have.
std::vector<Term> possible_terms(const FeatureScales& scales);
/// A zero, a gain on the load, and friction with and without the load, for every path.
std::vector<Term> terms_that_belong_together(const FeatureScales& scales);
/// Motion, load, and stop operators with and without the load (as Prandtl-Ishlinskii times load).
std::vector<Feature> history_features(const FeatureScales& scales);

}  // namespace capstan::residual_law
