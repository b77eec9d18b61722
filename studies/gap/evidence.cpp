#include "capstan/gap/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace capstan::gap {

namespace {

// The constants were set on 59 recordings of the blind trial's simulator and scored on others
// (studies/README.md, "How sure a diagnosis is"). Penalties and log priors are natural logarithms.

// The model's floor is known only roughly. Below this mean square residual, a smaller one is therefore weak
// evidence and counts with a reduced weight.
constexpr double as_good_as_noise = 0.95;
constexpr double below_noise_weight = 0.3;
// Schwarz's penalty for a fitted number is half the logarithm of the independent samples. Half of that is
// used here, because the prior on each number already takes its part.
constexpr double schwarz_fraction = 0.5;
// A gap is a visible change. A cause that changes no channel by twice noise and floor (rms) cannot be what
// makes it, and its fit follows noise.
constexpr double visible = 2.0;
constexpr double invisible_penalty = 8.0;
// A bench without any cause is more common than one with a given cause.
constexpr double none_log_prior = 1.0;
// The model's own error resembles a faulty sensor, so a sensor fault has to explain more than that.
constexpr double sensor_fault_penalty = 2.0;
// Two causes at once are rarer than one, and there are hundreds of pairs to choose from.
constexpr double second_cause_penalty = 8.0;
// A cause outside the list is rarer than the causes in it.
constexpr double unknown_penalty = 4.0;
// Two causes of one gap are about equally visible. A second cause that is much fainter than the first only
// corrects an error in the first one's model.
constexpr double faint = 0.25;
constexpr double faint_penalty = 60.0;
// Nothing can be fitted for a cause outside the list. It is assumed to leave this fraction of the gap and to
// have this many numbers of its own.
constexpr double fraction_left_by_unknown = 0.1;
constexpr std::size_t numbers_of_unknown = 4;
// The list of hypotheses is never complete: this probability is shared equally by all effects.
constexpr double anything_fraction = 0.02;

using Effects = std::vector<std::string>;  // of a hypothesis, sorted

Effects effects_of(const CauseFit& fit) {
    Effects effects;
    for (const CandidateCause* cause : fit.causes) effects.push_back(cause->effect);
    std::sort(effects.begin(), effects.end());
    return effects;
}

}  // namespace

// The log-likelihood of Gaussian residuals with a free scale is -n/2 ln(mean square), up to a constant.
double Evidence::of(double misfit, std::size_t open_numbers) const {
    return -0.5 * samples_ *
               (std::log(std::max(misfit, as_good_as_noise)) + below_noise_weight * std::log(misfit)) -
           0.5 * schwarz_fraction * static_cast<double>(open_numbers) * std::log(samples_);
}

double Evidence::of(const ScoredFit& fit) const {
    double evidence = of(fit.misfit, open_numbers(fit.fit)) - fit.nominal_penalty - fit.shape_penalty;
    for (std::size_t k = 0; k < fit.fit.causes.size(); ++k) {
        const CandidateCause& cause = *fit.fit.causes[k];
        if (cause.effect == "none") {
            evidence += none_log_prior;
            continue;
        }
        evidence -= invisible_penalty * std::max(0.0, 1.0 - fit.visibility[k] / visible);
        if (cause.family == "sensor") evidence -= sensor_fault_penalty;
    }
    if (fit.fit.causes.size() < 2) return evidence;
    const auto [least, most] = std::minmax_element(fit.visibility.begin(), fit.visibility.end());
    const double relative = *most > 0.0 ? *least / *most : 0.0;
    return evidence - second_cause_penalty - faint_penalty * std::max(0.0, 1.0 - relative / faint);
}

double Evidence::of_unknown(double nominal_misfit) const {
    return of(1.0 + fraction_left_by_unknown * std::max(0.0, nominal_misfit - 1.0), numbers_of_unknown) -
           unknown_penalty;
}

std::vector<WeighedHypothesis> Evidence::weigh(const std::vector<ScoredFit>& fits,
                                               double nominal_misfit) const {
    std::vector<WeighedHypothesis> weighed = {{{"unknown"}, 0.0, of_unknown(nominal_misfit), nullptr}};
    for (const ScoredFit& each : fits) {
        const Effects effects = effects_of(each.fit);
        const auto same = std::find_if(weighed.begin(), weighed.end(), [&](const WeighedHypothesis& other) {
            return other.effects == effects;
        });
        if (same == weighed.end()) {
            weighed.push_back({effects, 0.0, each.evidence, &each});
        } else if (each.evidence > same->evidence) {
            *same = {effects, 0.0, each.evidence, &each};
        }
    }
    std::stable_sort(weighed.begin(), weighed.end(),
                     [](const WeighedHypothesis& a, const WeighedHypothesis& b) {
                         return a.evidence != b.evidence ? a.evidence > b.evidence : a.effects < b.effects;
                     });
    const double most = weighed.front().evidence;
    double sum = 0.0;
    for (const WeighedHypothesis& each : weighed) sum += std::exp((each.evidence - most) / overstated);
    for (WeighedHypothesis& each : weighed)
        each.probability = std::exp((each.evidence - most) / overstated) / sum;
    return weighed;
}

std::vector<RankedEffect> Evidence::rank(const std::vector<CandidateCause>& causes,
                                         const std::vector<WeighedHypothesis>& weighed) {
    std::map<std::string, double> probability = {{"unknown", 0.0}};
    for (const CandidateCause& cause : causes) probability[cause.effect] = 0.0;
    // Effects with almost no probability are ordered by their best hypothesis.
    std::map<std::string, double> best;
    for (const WeighedHypothesis& each : weighed) {
        for (const std::string& effect : each.effects) {
            probability[effect] += each.probability / static_cast<double>(each.effects.size());
            best.emplace(effect, each.evidence);
        }
    }
    std::vector<RankedEffect> ranked;
    const double anything = anything_fraction / static_cast<double>(probability.size());
    for (const auto& [effect, fraction] : probability)
        ranked.push_back({effect, (1.0 - anything_fraction) * fraction + anything});
    const auto evidence_of = [&](const RankedEffect& each) {
        const auto known = best.find(each.effect);
        return known == best.end() ? -std::numeric_limits<double>::infinity() : known->second;
    };
    std::stable_sort(ranked.begin(), ranked.end(), [&](const RankedEffect& a, const RankedEffect& b) {
        constexpr double equal = 1e-9;
        if (std::abs(a.probability - b.probability) > equal) return a.probability > b.probability;
        return evidence_of(a) > evidence_of(b);
    });
    return ranked;
}

bool worth_a_second_cause(double misfit, double nominal_misfit) {
    constexpr double close_to_noise = 1.15;
    constexpr double min_fraction = 0.01;
    return misfit > close_to_noise && misfit - 1.0 > min_fraction * (nominal_misfit - 1.0);
}

std::size_t open_numbers(const CauseFit& fit) {
    std::size_t count = 0;
    for (const CandidateCause* cause : fit.causes) {
        count += cause->numbers.size();
        for (const double std : {cause->friction_std, cause->stiffness_std, cause->pretension_std})
            count += std > nominal_log_std ? 1 : 0;
    }
    return count;
}

}  // namespace capstan::gap
