#include "capstan/gap/evidence.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace capstan::gap {

namespace {

// Mean square residuals below this are as good as one: the floor is not known better.
constexpr double as_good_as_noise = 1.06;
// What goes on below that still tells two causes apart, but counts for less.
constexpr double below_noise_weight = 0.2;
// A cause nobody has thought of is granted to leave this share of the gap, at the price of as many numbers.
constexpr double share_left_by_unknown = 0.12;
constexpr std::size_t numbers_of_unknown = 4;
// A second cause must raise the evidence by this much, and explain this share of the gap.
constexpr double second_cause_evidence = 12.0;
constexpr double second_cause_share = 0.05;
// Causes that were not worth a fit.
constexpr double not_fitted = -60.0;

}  // namespace

double Evidence::of(double misfit, std::size_t open_numbers, double nominal_price) const {
    return -0.5 * samples_ *
               (std::log(std::max(misfit, as_good_as_noise)) + below_noise_weight * std::log(misfit)) -
           0.5 * static_cast<double>(open_numbers) * std::log(samples_) - nominal_price;
}

double Evidence::of_unknown(double nominal_misfit) const {
    return of(1.0 + share_left_by_unknown * std::max(0.0, nominal_misfit - 1.0), numbers_of_unknown, 0.0);
}

bool Evidence::second_is_earned(const ScoredFit& single, const ScoredFit& pair, double nominal_misfit) const {
    return pair.evidence > single.evidence + second_cause_evidence &&
           single.misfit - pair.misfit > second_cause_share * (nominal_misfit - 1.0);
}

std::vector<RankedEffect> Evidence::rank(const std::vector<CandidateCause>& causes,
                                         const std::vector<ScoredFit>& singles, const ScoredFit& leading,
                                         double nominal_misfit) const {
    std::map<std::string, double> evidence = {{"unknown", of_unknown(nominal_misfit)}};
    const auto raise = [&](const std::string& effect, double value) {
        const auto [known, added] = evidence.emplace(effect, value);
        if (!added) known->second = std::max(known->second, value);
    };
    for (const ScoredFit& each : singles) raise(each.fit.causes.front()->effect, each.evidence);
    for (const CandidateCause* cause : leading.fit.causes) raise(cause->effect, leading.evidence);
    for (const CandidateCause& cause : causes) raise(cause.effect, leading.evidence + not_fitted);
    double most = evidence.at("unknown");
    for (const auto& [effect, value] : evidence) most = std::max(most, value);
    double sum = 0.0;
    for (const auto& [effect, value] : evidence) sum += std::exp(value - most);
    std::vector<RankedEffect> ranked;
    for (const auto& [effect, value] : evidence) ranked.push_back({effect, std::exp(value - most) / sum});
    std::stable_sort(ranked.begin(), ranked.end(), [](const RankedEffect& a, const RankedEffect& b) {
        return a.probability > b.probability;
    });
    return ranked;
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
