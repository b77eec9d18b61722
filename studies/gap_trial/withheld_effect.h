#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capstan/gap_trial/trial_bench.h"
#include "capstan/gap_trial/trial_motion.h"
#include "capstan/gap_trial/trial_stream.h"
#include "capstan/gap_trial/true_effects.h"

namespace capstan::gap_trial {

/// An effect that a bench gets. Everything but its size is drawn.
struct WithheldEffect {
    std::string effect;     ///< canonical name, as a diagnosis should answer; `unknown` outside the catalogue
    std::string kind;       ///< which one exactly
    std::string component;  ///< empty: none can be named
    std::string end;
    std::optional<Stretch> where;
    std::map<std::string, double> shape;  ///< what was drawn beside the size, for the label
    std::string size_name;                ///< with its unit
    double first_size = 1.0;              ///< where the search for a size begins
    double largest_size = 1.0;            ///< the bench cannot have more
    std::function<void(TrueEffects&, double size)> apply;
    bool only_sensors = false;  ///< the motion stays as it is
    std::string varies;         ///< the run condition that the number follows; empty: none
};

/// The bench and session that an effect is drawn for.
struct EffectSetting {
    const TrialBench& bench;
    const std::vector<TrialRun>& runs;
    const std::map<std::string, double>& spans;  ///< by channel, without the effect
};

/// One entry of the list of effects that a trial can withhold.
struct EffectMaker {
    std::string effect;
    std::string kind;
    bool needs_pair = false;    ///< not on a single cable
    bool needs_motion = false;  ///< invisible in locked runs
    WithheldEffect (*draw)(const EffectSetting&, TrialStream&);
};

/// Effects that a diagnosis's catalogue has, wrong parameters, and causes outside of it.
const std::vector<EffectMaker>& catalogue_effects();
/// The same, where an effect has a form that neither the engine nor the first recordings of benches had: with
/// that.
std::vector<EffectMaker> with_own_forms(std::vector<EffectMaker> makers);
const std::vector<EffectMaker>& wrong_parameters();
const std::vector<EffectMaker>& foreign_causes();

}  // namespace capstan::gap_trial
