#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "capstan/cable/cable.h"
#include "capstan/cable/conduit.h"
#include "capstan/estimation/single_sensor.h"
#include "capstan/plan/placement_plan.h"
#include "capstan/plan/sensitivity_plan.h"
#include "capstan/plan/true_cable.h"
#include "capstan/plan/uncertainty.h"
#include "capstan/sensing/layout.h"
#include "capstan/sensing/noise.h"
#include "capstan/solver/model_rules.h"

namespace capstan {

/// What is prescribed at one end of the cable over time: a sine `amplitude * sin(2 pi f t + phase)` that
/// moves from `start_s` to `stop_s` and holds still before and after, added to the value at rest of the
/// pretensioned cable (its displacement, its tension, the wall where it stands) so that it begins there.
enum class EndKind { position, tension, spring };

struct EndMotion {
    EndKind kind = EndKind::position;
    double amplitude = 0.0;  ///< position, spring (of its wall): m; tension: N
    double frequency_Hz = 0.0;
    double phase_rad = 0.0;
    double start_s = 0.0;
    double stop_s = 1e9;                    ///< longer than any motion
    double spring_stiffness_N_per_m = 0.0;  ///< spring only
};

/// Where the nodes of the cable lie.
enum class CableCut {
    even,      ///< all segments are equal
    at_bends,  ///< at both ends of every bend and at the places of the tension sensors, the others between
    in_bends,  ///< as at_bends, but the others where the cable turns most between two nodes
};

/// Another way to state a conduit than its pieces. A configuration is read into this and then made into
/// pieces; a plan that runs has none.
struct ConduitCourse {
    double length_m = 0.0;  ///< with bends; 0: not stated
    std::vector<Bend> bends{};
    std::string centre_line;           ///< a CSV file of points; empty: not stated
    double centre_line_noise_m = 0.0;  ///< standard deviation of each coordinate of its points
};

struct Transmission {
    CableSpecification cable;  ///< of a pull-pull pair each of the two
    CableArrangement arrangement = CableArrangement::single;
    ConduitCourse course{};
    std::string conduit_note{};     ///< where the pieces come from, for the reader
    CableCut cut = CableCut::even;  ///< place_nodes() does it
    ModelRules rules = ModelRules::consistent();
};

/// The true motion, sampled at a fixed rate; sample 0 is the pretensioned cable at rest.
struct TrueMotion {
    EndMotion proximal;
    EndMotion distal;
    double sample_rate_Hz = 0.0;
    int samples = 0;
};

enum class Regime { mass, partial_proximal, partial_distal, partial_both };

std::string_view name_of(Regime regime);
inline constexpr Regime all_regimes[] = {Regime::mass, Regime::partial_proximal, Regime::partial_distal,
                                         Regime::partial_both};

/// The instants at which a regime is judged, and its fraction of the working time.
struct RegimeInstants {
    Regime regime = Regime::mass;
    std::vector<int> samples;
    double duty_fraction = 0.0;
};

struct NamedNoise {
    std::string label;
    NoiseLevel level;
};

/// Where the weights of the W methods come from.
enum class WeightSource {
    mass_motion,  ///< from the single-sensor errors in mass motion, for every regime, as in the paper. Needs
                  ///< that regime.
    same_regime,  ///< from the single-sensor errors of the regime that is fused
};

/// A plan for many studies: one for every combination of these values. An empty list keeps the value of the
/// plan. Ratios multiply: both friction coefficients, the curvature of every bend, the axial
/// stiffness.
struct Sweep {
    std::vector<double> friction_ratio;
    std::vector<double> curvature_ratio;
    std::vector<double> stiffness_ratio;
    std::vector<int> segments;
    /// The samples of a regime change with the transmission: use this many, spread evenly over all samples in
    /// the regime. 0: the plan's samples.
    int instants_per_regime = 0;

    bool is_there() const {
        return !friction_ratio.empty() || !curvature_ratio.empty() || !stiffness_ratio.empty() ||
               !segments.empty() || instants_per_regime > 0;
    }
};

/// Points along the curve of feasible states. The error of the grid itself is inverse to this number; it is
/// below 0.01 N with 128 points in the paper's cable.
inline constexpr int default_curve_points = 128;

/// A fifth of the error of about 0.1 N that the paper's cable reaches with its best layouts [N].
inline constexpr double default_worthwhile_gain_N = 0.02;

/// Everything a study is: plain values, checked by problems_of(). What a configuration file describes.
struct StudyPlan {
    std::string name;
    std::uint64_t seed = 1;
    int repetitions = 0;

    Transmission transmission;
    TrueMotion motion;
    TrueCable truth;
    Uncertainty uncertainty;           ///< where it is stated, the study is over worlds drawn from it
    std::vector<SensorRow> sensors{};  ///< that can be bought; empty: tension sensors at all nodes
    std::vector<RegimeInstants> regimes;
    std::vector<NamedNoise> noise_levels;

    std::vector<std::string> layout_families;        ///< names of layout_families()
    std::vector<int> sensor_counts;                  ///< for each family
    std::vector<std::vector<int>> explicit_layouts;  ///< nodes from 0
    std::vector<std::string> fusion_methods;         ///< names of fusion_methods()

    DistalSide distal_side = DistalSide::excluded;
    PatternOrder pattern_order = PatternOrder::nearest_first;  ///< no key: only to see what the order does
    WeightSource weight_source = WeightSource::mass_motion;
    /// Feasible curve: flat prior of the distal end's motion in a sample.
    double largest_distal_increment_m = 0.0;
    int curve_points = default_curve_points;

    /// One more sensor must lower the error by this to be recommended.
    double worthwhile_gain_N = default_worthwhile_gain_N;
    bool compare_with_paper = false;  ///< the plan holds what the paper's table needs

    PlacementPlan placement;      ///< for the search over all layouts
    SensitivityPlan sensitivity;  ///< for the sensitivity of the recommendation
    Sweep sweep;                  ///< studies_in_sweep() makes the studies; each of them has none
};

/// Puts the nodes of the plan's cable where its cut says. To be called again where bends move or sensors
/// come.
void place_nodes(StudyPlan& plan);

/// How many segments the plan's cable is cut into where the configuration does not say: the fewest, with its
/// cut, whose friction is small enough for the discretisation error. At most max_estimated_segments, or what
/// the nodes of the cut need.
int default_segments(StudyPlan plan);

/// What is wrong with the plan's cable and its cut.
std::vector<KeyProblem> problems_of_cable(const StudyPlan& plan);

/// Everything wrong with the plan's values, each with the key it belongs to and what to try. Simulates
/// nothing.
std::vector<KeyProblem> problems_of_values(const StudyPlan& plan);

/// What problems_of_values() says of a plan that draws worlds, beside what it says of every plan.
std::vector<KeyProblem> problems_of_worlds(const StudyPlan& plan);

/// The same, and each instant that is not in its regime, which takes a simulation of the motion; empty when
/// the plan can run.
std::vector<KeyProblem> problems_of(const StudyPlan& plan);

/// Samples at which the motion is in each regime, ascending. The plan's cable and motion must be valid.
std::map<Regime, std::vector<int>> samples_by_regime(const StudyPlan& plan);

/// The studies of a plan with a sweep, in order: segments, friction, curvature, stiffness, the
/// last changing fastest. Each has a name of its own, no sweep, and the seed of the plan: all share their
/// draws, so that differences between them are paired. Their config_toml is still that of the plan. A plan
/// without a sweep is its only study. Throws InvalidInput if a regime is never reached.
std::vector<StudyPlan> studies_in_sweep(const StudyPlan& plan);

}  // namespace capstan
