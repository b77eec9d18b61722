#include "capstan/gap_trial/true_effects.h"

namespace capstan::gap_trial {

double ConditionedNumber::change(const std::map<std::string, double>& conditions) const {
    const auto found = conditions.find(condition);
    if (found == conditions.end()) return 0.0;
    const double x = found->second / scale;
    return amount * (squared ? x * x : x);
}

TrueEffects TrueEffects::under(const std::map<std::string, double>& conditions) const {
    TrueEffects now = *this;
    for (const ConditionedNumber& number : conditioned) {
        const double change = number.change(conditions);
        switch (number.which) {
            case ConditionedNumber::Which::friction:
                now.friction_ratio *= std::exp(change);
                break;
            case ConditionedNumber::Which::pretension:
                now.pretension_ratio *= std::exp(change);
                break;
            case ConditionedNumber::Which::zero:
                now.sensors[number.channel].offset += change;
                break;
        }
    }
    now.conditioned.clear();
    return now;
}

}  // namespace capstan::gap_trial
