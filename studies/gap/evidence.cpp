#include "capstan/gap/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace capstan::gap {

namespace {

// All constants below: README, "How sure a diagnosis is".
//
// Mean square residuals below this are as good as one another: the floor is not known better. What goes on
// below still tells two causes apart, but counts for less.
constexpr double as_good_as_noise = 0.95;
constexpr double below_noise_weight = 0.3;
// Of an open number, in half logarithms of the independent samples.
constexpr double number_penalty = 0.5;
// A cause that changes no channel by this much, rms in units of noise and floor, is hardly what makes a gap.
constexpr double visible = 2.0;
constexpr double invisible_penalty = 8.0;
// Known beforehand, as logarithms.
constexpr double nothing_bonus = 1.0;
constexpr double faulty_sensor_penalty = 2.0;
constexpr double second_cause_penalty = 8.0;
constexpr double unknown_penalty = 4.0;
// Two causes of one gap are about as visible; a faint second one mends what the first one's model lacks.
constexpr double faint = 0.25;
constexpr double faint_penalty = 60.0;
// A cause nobody has thought of is granted to leave this fraction of the gap, at the price of as many
// numbers.
constexpr double fraction_left_by_unknown = 0.1;
constexpr std::size_t numbers_of_unknown = 4;
// Something else may always be the matter.
constexpr double anything_fraction = 0.02;

using Effects = std::vector<std::string>;  // of a hypothesis, sorted

Effects effects_of(const CauseFit& fit) {
    Effects effects;
    for (const CandidateCause* cause : fit.causes) effects.push_back(cause->effect);
    std::sort(effects.begin(), effects.end());
    return effects;
}

}  // namespace

double Evidence::of(double misfit, std::size_t open_numbers) const {
    return -0.5 * samples_ *
               (std::log(std::max(misfit, as_good_as_noise)) + below_noise_weight * std::log(misfit)) -
           0.5 * number_penalty * static_cast<double>(open_numbers) * std::log(samples_);
}

double Evidence::of(const ScoredFit& fit) const {
    double evidence = of(fit.misfit, open_numbers(fit.fit)) - fit.nominal_penalty - fit.shape_penalty;
    for (std::size_t k = 0; k < fit.fit.causes.size(); ++k) {
        const CandidateCause& cause = *fit.fit.causes[k];
        if (cause.effect == "none") {
            evidence += nothing_bonus;
            continue;
        }
        evidence -= invisible_penalty * std::max(0.0, 1.0 - fit.visibility[k] / visible);
        if (cause.family == "sensor") evidence -= faulty_sensor_penalty;
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
    // Of two effects with hardly any, the one with the better hypothesis goes first.
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
        constexpr double the_same = 1e-9;
        if (std::abs(a.probability - b.probability) > the_same) return a.probability > b.probability;
        return evidence_of(a) > evidence_of(b);
    });
    return ranked;
}

bool worth_a_second_cause(double misfit, double nominal_misfit) {
    constexpr double nothing_left = 1.15;
    constexpr double min_fraction = 0.01;
    return misfit > nothing_left && misfit - 1.0 > min_fraction * (nominal_misfit - 1.0);
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
