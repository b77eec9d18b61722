// What becomes of a set of causes that was built up one by one: it is refined, and judged on runs that its
// fit did not see.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "capstan/gap/cause_search.h"

namespace capstan::gap {

namespace {

// A refinement that gains less evidence than this ends.
constexpr double clear_gain = 1.0;

// Those of the bench's own numbers beyond the first three that are far from usual are as usual again: they
// may have stood for a cause that is still to be found.
Hypothesis with_usual_numbers(Hypothesis hypothesis) {
    for (Eigen::Index k = nominal_coordinates; k < hypothesis.bench->size(); ++k) {
        const FloatingNumber& number = hypothesis.bench->numbers[static_cast<std::size_t>(k)];
        if (std::abs(hypothesis.coordinates[k]) > number.prior_std) hypothesis.coordinates[k] = 0.0;
    }
    return hypothesis;
}

}  // namespace

// On a bench of unknown geometry a set that was built up cause by cause may hold one that stands for
// another, and so may a number of the bench.
void CauseSearch::refine(const Level& level, Fits& all) {
    constexpr int max_rounds = 2;
    for (int round = 0; round < max_rounds && !is_out_of_time(); ++round) {
        const double before = all.front().evidence;
        try_usual_numbers(level, all);
        try_swapping(level, all);
        if (all.front().evidence < before + clear_gain) return;
    }
}

// Further causes beside the best set, beside usual numbers of the bench.
void CauseSearch::try_usual_numbers(const Level& level, Fits& all) {
    const CauseFit best = all.front().fit;
    const Hypothesis usual = with_usual_numbers(best.hypothesis());
    if (best.causes.front()->effect == "none" || usual.coordinates == best.coordinates) return;
    Fits sets;
    add_sets(level, usual, best.weights, max_fitted_further, sets);
    std::move(sets.begin(), sets.end(), std::back_inserter(all));
    sort_by_evidence(all);
}

// The best set with one cause more than the best of all, without each of its causes in turn: the one that was
// added may do what another one stood for.
void CauseSearch::try_swapping(const Level& level, Fits& all) {
    for (;;) {
        const double before = all.front().evidence;
        const std::size_t more = all.front().fit.causes.size() + 1;
        const auto larger = std::find_if(all.begin(), all.end(), [&](const ScoredFit& each) {
            return each.fit.bench == &level.bench && each.fit.causes.size() == more;
        });
        if (larger == all.end() || more == 2 || more > max_causes) return;
        const Hypothesis set = larger->fit.hypothesis();
        for (const CandidateCause* dropped : set.causes) {
            if (is_out_of_time()) break;
            report("trying fewer causes");
            add_fit(level, only_causes(set, [&](const CandidateCause& each) { return &each != dropped; }),
                    false, all);
        }
        sort_by_evidence(all);
        if (all.front().evidence < before + clear_gain) return;
        const Fits best = {all.front()};
        Fits sets = larger_sets(level, best);
        std::move(sets.begin(), sets.end(), std::back_inserter(all));
        sort_by_evidence(all);
    }
}

// A ripple was screened beside numbers of the bench that had made up for it. With them free, another number
// of periods may be better: of the best set that has a ripple, the most promising numbers are fitted, and
// then their neighbours.
void CauseSearch::try_periods(const Level& level, Fits& sets) {
    constexpr std::size_t max_fitted_periods = 3;
    const auto ripple_of = [](const Hypothesis& set) {
        Eigen::Index at = set.bench->size();
        for (const CandidateCause* cause : set.causes) {
            for (const OpenNumber& number : cause->numbers) {
                if (number.kind == OpenNumber::Kind::periods) return std::pair{&number, at};
                ++at;
            }
        }
        return std::pair<const OpenNumber*, Eigen::Index>{nullptr, 0};
    };
    const auto found = std::find_if(sets.begin(), sets.end(), [&](const ScoredFit& each) {
        return ripple_of(each.fit.hypothesis()).first != nullptr;
    });
    if (found == sets.end()) return;
    ScoredFit best = *found;
    const auto [number, at] = ripple_of(best.fit.hypothesis());
    std::vector<double> tried = {number->value(best.fit.coordinates[at])};
    report("trying other numbers of periods");
    const auto with_periods = [&, at = at](double periods) {
        Hypothesis other = best.fit.hypothesis();
        other.coordinates[at] = periods;
        return other;
    };
    const auto fit_with_periods = [&](const Hypothesis& start) {
        add_fit(level, start, false, sets);
        if (sets.back().evidence > best.evidence) best = sets.back();
    };
    std::vector<std::pair<double, Hypothesis>> promising;  // by the sum of squares
    for (const double periods : number->starts()) {
        if (periods == tried.front() || is_out_of_time()) continue;
        const Hypothesis other = with_periods(periods);
        const CauseFit rough = coarse_.fitter.rough_fit({&other, 1}, best.fit.weights);
        evaluations_ += rough.evaluations;
        promising.emplace_back(rough.sum_of_squares, rough.hypothesis());
    }
    std::stable_sort(promising.begin(), promising.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t k = 0; k < std::min(max_fitted_periods, promising.size()); ++k) {
        tried.push_back(promising[k].second.coordinates[at]);
        fit_with_periods(promising[k].second);
    }
    for (bool climbs = true; climbs && !is_out_of_time();) {
        const double middle = number->value(best.fit.coordinates[at]);
        for (const double periods : {middle - 1.0, middle + 1.0}) {
            if (number->value(periods) != periods ||
                std::find(tried.begin(), tried.end(), periods) != tried.end())
                continue;
            tried.push_back(periods);
            fit_with_periods(with_periods(periods));
        }
        climbs = number->value(best.fit.coordinates[at]) != middle;
    }
    sort_by_evidence(sets);
}

// The logarithm of the mean square residual of each part with the numbers fitted to the rest, averaged over
// the parts: one part that is far from all others does not decide.
double CauseSearch::held_out_log_misfit(const Hypothesis& hypothesis, const SeriesWeights& weights,
                                        const std::vector<LeftOut>& parts) {
    const CauseFitter& fitter = coarse_.fitter;
    CauseFitter::FitOptions options;
    options.any_size = false;
    options.weights = weights;
    const CauseFit all = fitter.fit(hypothesis, options);
    std::vector<Hypothesis> without;
    for (const CauseFit& fit : fitter.fits_without(all, parts)) without.push_back(fit.hypothesis());
    Eigen::MatrixXd residuals = fitter.data_residuals(without);
    fitter.apply(weights, residuals);
    double sum = 0.0;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        double squares = 0.0;
        double rows = 0.0;
        for (const ResidualSeries& series : fitter.series()) {
            if (series.run != parts[part].run) continue;
            const auto [from, to] = parts[part].rows(series.rows);
            rows += static_cast<double>(series.determined_rows(from, to));
            squares += residuals
                           .block(static_cast<Eigen::Index>(series.first_row + from),
                                  static_cast<Eigen::Index>(part), static_cast<Eigen::Index>(to - from), 1)
                           .squaredNorm();
        }
        sum += weighed_log(squares / std::max(1.0, rows));
    }
    return sum / static_cast<double>(parts.size());
}

// A cause that does not help to predict what the fit did not see may only have fitted the rest. It goes where
// the predictions lose more by it than the fit has gained. The set without it then goes before the set with
// it.
void CauseSearch::drop_unearned_causes(Fits& fits) {
    constexpr std::size_t enough_runs = 3;
    constexpr double unearned_penalty = 4.0;
    if (run_count_ < enough_runs) return;
    const double samples = fine_.fitter.independent_samples();
    while (fits.front().fit.causes.size() > 1 && !is_out_of_time()) {
        report("predicting each run from the others");
        const ScoredFit best = fits.front();
        const Hypothesis all = best.fit.hypothesis();
        const std::vector<LeftOut> parts = left_out_in_turn(run_count_, all.causes);
        const double with_all = held_out_log_misfit(all, best.fit.weights, parts);
        std::optional<ScoredFit> earned;
        double max_lost = 0.0;
        for (const CandidateCause* dropped : all.causes) {
            const Hypothesis fewer =
                only_causes(all, [&](const CandidateCause& cause) { return &cause != dropped; });
            // A log likelihood, as the evidence is.
            const double lost =
                0.5 * samples * (with_all - held_out_log_misfit(fewer, best.fit.weights, parts));
            if (lost < max_lost) continue;
            CauseFitter::FitOptions options;
            options.any_size = false;
            options.weights = best.fit.weights;
            ScoredFit fit = scored(fine_, fine_.fitter.fit(fewer, options));
            if (best.evidence - fit.evidence > lost) continue;
            max_lost = lost;
            earned = std::move(fit);
        }
        if (!earned) return;
        for (ScoredFit& each : fits) {
            const auto is_in = [&](const CandidateCause* cause) {
                return std::find(each.fit.causes.begin(), each.fit.causes.end(), cause) !=
                       each.fit.causes.end();
            };
            if (each.fit.bench == earned->fit.bench && each.fit.causes.size() > earned->fit.causes.size() &&
                std::all_of(earned->fit.causes.begin(), earned->fit.causes.end(), is_in))
                each.charge_unproven(std::max(0.0, each.evidence - (earned->evidence - unearned_penalty)));
        }
        fits.push_back(std::move(*earned));
        sort_by_evidence(fits);
    }
}

}  // namespace capstan::gap
