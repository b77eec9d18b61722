#include "capstan/gap/cause_search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "capstan/effects/known_causes.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

// How many causes get a full fit after the screening.
constexpr std::size_t max_fitted = 8;
// How many of the best single causes are fitted with a second, and with how many others each.
constexpr std::size_t max_first_causes = 2;
constexpr std::size_t max_second_causes = 3;
constexpr int max_exchanges = 2;
// A search is pruned if its linear model promises more than this many times the best misfit so far.
constexpr double pruned_factor = 2.5;
// The screening uses fewer segments and samples.
constexpr int screening_segments = 24;
constexpr int screening_stride_factor = 2;

double min_sum(const std::vector<ScoredFit>& fits) {
    double least = std::numeric_limits<double>::infinity();
    for (const ScoredFit& each : fits) least = std::min(least, each.fit.sum_of_squares);
    return least;
}

std::string in_words(const CandidateCause& cause) {
    const std::string title = cause_title(cause.effect);
    return cause.variant.empty() ? title : title + " (" + channel_words(cause.variant) + ")";
}

// A wrong nominal number beside a cause that lets the same number go far already.
bool is_part_of(const CandidateCause& cause, const CandidateCause& first) {
    const auto goes_far = [](double std) { return std > nominal_log_std; };
    return cause.numbers.empty() && ((goes_far(cause.friction_std) && goes_far(first.friction_std)) ||
                                     (goes_far(cause.stiffness_std) && goes_far(first.stiffness_std)) ||
                                     (goes_far(cause.pretension_std) && goes_far(first.pretension_std)));
}

}  // namespace

void sort_by_evidence(std::vector<ScoredFit>& fits) {
    std::stable_sort(fits.begin(), fits.end(),
                     [](const ScoredFit& a, const ScoredFit& b) { return a.evidence > b.evidence; });
}

CauseSearch::CauseSearch(const Recording& recording, const CauseSearchOptions& options)
    : options_(options),
      fitter_(recording, {options.segments, options.stride}, options.threads),
      screener_(recording, {screening_segments, screening_stride_factor * options.stride}, options.threads),
      evidence_(fitter_.independent_samples()),
      causes_(candidate_causes(recording)) {}

FoundCauses CauseSearch::run() {
    report("nominal model", 0.0);
    nominal_ = {{}, Eigen::VectorXd::Zero(nominal_coordinates)};
    nominal_misfit_ = fitter_.residuals(nominal_.causes, nominal_.coordinates).squaredNorm() /
                      static_cast<double>(fitter_.data_rows());
    FoundCauses found;
    found.singles = {scored(fitter_.fit({{&causes_.front()}, nominal_.coordinates}, {}))};
    report("screening all causes", 0.02);
    const std::vector<Screened> screened = screen(screener_, causes_, nominal_);
    fit_best(screened, found.singles);
    sort_by_evidence(found.singles);
    found.pairs = pairs_with(found.singles);
    if (found.pairs.empty() || found.pairs.front().evidence < found.singles.front().evidence)
        fit_confusable(screened, found.singles);
    found.nominal_misfit = nominal_misfit_;
    found.evaluations = evaluations_;
    return found;
}

ScoredFit CauseSearch::scored(CauseFit fit) {
    evaluations_ += fit.evaluations;
    ScoredFit scored;
    scored.fit = std::move(fit);
    scored.misfit = fitter_.misfit(scored.fit);
    scored.nominal_penalty = fitter_.nominal_penalty(scored.fit);
    scored.shape_penalty = fitter_.shape_penalty(scored.fit);
    scored.visibility = fitter_.visibility({&scored.fit, 1}).front();
    scored.evidence = evidence_.of(scored);
    return scored;
}

// Fits the most promising causes.
void CauseSearch::fit_best(const std::vector<Screened>& screened, std::vector<ScoredFit>& fits) {
    std::size_t fitted = 0;
    for (const Screened& each : screened) {
        // A wrong nominal number is always fitted, because the screening lets every cause vary the nominal
        // numbers.
        const bool nominal_number = each.cause->numbers.empty();
        if (fitted == max_fitted && !nominal_number) continue;
        if (!nominal_number) ++fitted;
        report("fitting " + in_words(*each.cause),
               0.2 + 0.4 * static_cast<double>(fits.size()) / (max_fitted + nominal_coordinates));
        CauseFitter::FitOptions options;
        options.pruned_sum_of_squares = pruned_factor * min_sum(fits);
        fits.push_back(scored(fitter_.fit(with_cause(nominal_, each.cause, each.start), options)));
    }
}

// The screening is linear. Causes that are easily confused with the best one are fitted whatever it says.
void CauseSearch::fit_confusable(const std::vector<Screened>& screened, std::vector<ScoredFit>& singles) {
    const std::string best = singles.front().fit.causes.front()->effect;
    const auto is_fitted = [&](const std::string& effect) {
        return std::any_of(singles.begin(), singles.end(), [&](const ScoredFit& single) {
            return single.fit.causes.front()->effect == effect;
        });
    };
    for (const std::string& rival : confusable_causes(best)) {
        if (is_fitted(rival)) continue;
        const auto found = std::find_if(screened.begin(), screened.end(),
                                        [&](const Screened& each) { return each.cause->effect == rival; });
        if (found == screened.end()) continue;
        CauseFitter::FitOptions options;
        options.pruned_sum_of_squares = pruned_factor * min_sum(singles);
        singles.push_back(scored(fitter_.fit(with_cause(nominal_, found->cause, found->start), options)));
    }
    sort_by_evidence(singles);
}

// Fits the best single causes with the most promising others, then exchanges one cause of the best pair for
// as long as that improves it.
std::vector<ScoredFit> CauseSearch::pairs_with(const std::vector<ScoredFit>& singles) {
    std::vector<ScoredFit> pairs;
    if (!worth_a_second_cause(singles.front().misfit, nominal_misfit_)) return pairs;
    std::vector<std::string> firsts;
    for (const ScoredFit& single : singles) {
        const std::string& first = single.fit.causes.front()->effect;
        if (first == "none" || firsts.size() == max_first_causes ||
            std::find(firsts.begin(), firsts.end(), first) != firsts.end())
            continue;
        firsts.push_back(first);
        add_pairs(single.fit.hypothesis(), pairs);
    }
    sort_by_evidence(pairs);
    for (int round = 0; round < max_exchanges && !pairs.empty(); ++round) {
        if (!worth_a_second_cause(pairs.front().misfit, nominal_misfit_)) break;
        const CauseFit best = pairs.front().fit;
        for (const CandidateCause* kept : best.causes) {
            add_pairs(
                only_causes(best.hypothesis(), [&](const CandidateCause& cause) { return &cause == kept; }),
                pairs);
        }
        sort_by_evidence(pairs);
        if (pairs.front().fit.causes == best.causes) break;
    }
    return pairs;
}

void CauseSearch::add_pairs(const Hypothesis& present, std::vector<ScoredFit>& pairs) {
    const CandidateCause* first = present.causes.front();
    std::size_t seconds = 0;
    for (const Screened& each : screen(screener_, causes_, present)) {
        if (seconds == max_second_causes) break;
        if (each.cause->effect == first->effect || is_part_of(*each.cause, *first)) continue;
        ++seconds;
        const auto same = [&](const ScoredFit& pair) {
            return std::is_permutation(pair.fit.causes.begin(), pair.fit.causes.end(),
                                       std::array{first, each.cause}.begin());
        };
        if (std::any_of(pairs.begin(), pairs.end(), same)) continue;
        report("fitting " + in_words(*first) + " with " + in_words(*each.cause),
               std::min(0.9, 0.6 + 0.03 * static_cast<double>(pairs.size())));
        CauseFitter::FitOptions options;
        options.pruned_sum_of_squares = pruned_factor * min_sum(pairs);
        pairs.push_back(scored(fitter_.fit(with_cause(present, each.cause, each.start), options)));
    }
}

}  // namespace capstan::gap
