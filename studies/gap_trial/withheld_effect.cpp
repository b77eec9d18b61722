#include "capstan/gap_trial/withheld_effect.h"

#include <algorithm>

#include "capstan/effects/known_causes.h"

namespace capstan::gap_trial {

bool fits(const EffectMaker& maker, const TrialBench& bench, const std::vector<TrialRun>& runs) {
    if (maker.needs_pair && !bench.is_pair()) return false;
    if (!maker.needs_motion) return true;
    return std::any_of(runs.begin(), runs.end(),
                       [](const TrialRun& run) { return run.output == OutputKind::handle; });
}

std::string effect_family(const std::string& effect) {
    const KnownCause* known = find_cause(effect);
    return known != nullptr ? known->family : effect;
}

}  // namespace capstan::gap_trial
