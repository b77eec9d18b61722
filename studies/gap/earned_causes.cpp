#include <algorithm>
#include <optional>
#include <utility>

#include "capstan/gap/cause_search.h"

namespace capstan::gap {

// The mean square of the residuals of each run with the numbers fitted to the others.
double CauseSearch::held_out_misfit(const Hypothesis& hypothesis, const SeriesWeights& weights) {
    const CauseFitter& fitter = coarse_.fitter;
    CauseFitter::FitOptions options;
    options.any_size = false;
    options.weights = weights;
    const CauseFit all = fitter.fit(hypothesis, options);
    std::vector<LeftOut> runs;
    for (std::size_t run = 0; run < run_count_; ++run) runs.push_back({run});
    std::vector<Hypothesis> without;
    for (const CauseFit& fit : fitter.fits_without(all, runs)) without.push_back(fit.hypothesis());
    Eigen::MatrixXd residuals = fitter.data_residuals(without);
    fitter.apply(weights, residuals);
    double squares = 0.0;
    for (const ResidualSeries& series : fitter.series())
        squares +=
            residuals
                .block(static_cast<Eigen::Index>(series.first_row), static_cast<Eigen::Index>(series.run),
                       static_cast<Eigen::Index>(series.rows), 1)
                .squaredNorm();
    return squares / fitter.determined_rows();
}

// A cause that does not help to predict runs which the fit did not see has only fitted these. The set without
// it then goes before the set with it.
void CauseSearch::drop_unearned_causes(Fits& fits) {
    constexpr std::size_t enough_runs = 3;
    constexpr double unearned_penalty = 4.0;
    if (run_count_ < enough_runs) return;
    while (fits.front().fit.causes.size() > 1 && !is_out_of_time()) {
        report("predicting each run from the others");
        const Hypothesis all = fits.front().fit.hypothesis();
        const SeriesWeights weights = fits.front().fit.weights;
        double least = held_out_misfit(all, weights);
        std::optional<Hypothesis> earned;
        for (const CandidateCause* dropped : all.causes) {
            const Hypothesis fewer =
                only_causes(all, [&](const CandidateCause& cause) { return &cause != dropped; });
            const double misfit = held_out_misfit(fewer, weights);
            if (misfit > least) continue;
            least = misfit;
            earned = fewer;
        }
        if (!earned) return;
        CauseFitter::FitOptions options;
        options.any_size = false;
        options.weights = weights;
        ScoredFit fewer = scored(fine_, fine_.fitter.fit(*earned, options));
        for (ScoredFit& each : fits) {
            const auto is_in = [&](const CandidateCause* cause) {
                return std::find(each.fit.causes.begin(), each.fit.causes.end(), cause) !=
                       each.fit.causes.end();
            };
            if (each.fit.bench == fewer.fit.bench && each.fit.causes.size() > fewer.fit.causes.size() &&
                std::all_of(fewer.fit.causes.begin(), fewer.fit.causes.end(), is_in))
                each.charge_unproven(std::max(0.0, each.evidence - (fewer.evidence - unearned_penalty)));
        }
        fits.push_back(std::move(fewer));
        sort_by_evidence(fits);
    }
}

}  // namespace capstan::gap
