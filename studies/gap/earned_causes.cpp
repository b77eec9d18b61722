#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "capstan/gap/cause_search.h"

namespace capstan::gap {

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
        double most_lost = 0.0;
        for (const CandidateCause* dropped : all.causes) {
            const Hypothesis fewer =
                only_causes(all, [&](const CandidateCause& cause) { return &cause != dropped; });
            const double lost =
                0.5 * samples * (with_all - held_out_log_misfit(fewer, best.fit.weights, parts));
            if (lost < most_lost) continue;
            CauseFitter::FitOptions options;
            options.any_size = false;
            options.weights = best.fit.weights;
            ScoredFit fit = scored(fine_, fine_.fitter.fit(fewer, options));
            if (best.evidence - fit.evidence > lost) continue;
            most_lost = lost;
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
