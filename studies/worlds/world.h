#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "capstan/ensemble/ensemble_filter.h"
#include "capstan/plan/study_plan.h"

namespace capstan {

/// What all worlds of a plan have in common: the nominal cable, what is believed of it, what can be bought.
struct WorldQuestion {
    UncertainCable cable;
    ModelRules rules;
    TrueMotion motion;
    Uncertainty uncertainty;
    CableBelief belief;               ///< the plan's uncertainty, as the estimator is told
    std::vector<SensorOffer> offers;  ///< sensors with places, in the order of the configuration
    TrueCable truth;  ///< what the worlds lie about; the nominal cable unless [truth] says else
    std::uint64_t seed = 1;
};

/// Throws InvalidInput with problems_of(plan). `pieces`: into how many each of the plan's segments is cut.
WorldQuestion world_question(const StudyPlan& plan, int pieces = 1);

/// One cable, or one pull-pull pair, that the sensors could be fitted to, with everything that happened to
/// it.
struct World {
    std::array<CableFactors, 2> factors;       // of cable A and of cable B, which only a pair has
    /// Logarithms of the ratios of [truth], which come on top of the factors where the world is as it says.
    double log_friction_ratio = 0.0;
    double log_stiffness_ratio = 0.0;
    double log_pretension_ratio = 0.0;
    std::vector<double> proximal_increment_m;  // samples
    std::vector<double> tension_N;             // samples x (cables x nodes)
    std::vector<double> sensed;                // samples x offers: without any error, N or m
    std::vector<double> fault;                 // offers x 2: zero and gain, standard normal
    std::vector<double> noise;                 // samples x offers x 2: multiplicative, additive
    bool has_effects = false;
    int unsolved_steps = 0;  ///< of the true cable: no pattern verified, or the effects had no solution
    int nodes = 0;           ///< of all cables

    int samples() const { return static_cast<int>(proximal_increment_m.size()); }
    std::span<const double> tensions_N(int sample) const {  // cables x nodes
        return std::span(tension_N).subspan(static_cast<std::size_t>(sample) * nodes, nodes);
    }
    /// What these sensors read in a sample [N or m]. The draws are those of a sensor's rank in its set, so
    /// that sets that differ in one place share their noise.
    void read(int sample, std::span<const SensorOffer> offers, std::span<const int> sensors,
              std::vector<double>& readings) const;
};

/// World number `index` of the question: its draws are addressed by (seed, index), common to all sensors.
World draw_world(const WorldQuestion& question, std::uint32_t index);

}  // namespace capstan
