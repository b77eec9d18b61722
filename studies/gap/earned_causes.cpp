#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "capstan/gap/cause_search.h"

namespace capstan::gap {

namespace {

// A number that follows a condition of the runs, or the time since the session began, is known only from all
// runs together: to predict a run from the others would be to extrapolate.
bool is_known_between_runs(const CandidateCause* cause) {
    return !cause->varies.empty() || cause->effect == "pretension_drift";
}

// Each run in turn; the halves of each run where all runs are needed.
std::vector<LeftOut> parts_to_predict(const Hypothesis& hypothesis, std::size_t runs) {
    const bool all_runs =
        std::any_of(hypothesis.causes.begin(), hypothesis.causes.end(), is_known_between_runs);
    std::vector<LeftOut> parts;
    for (std::size_t run = 0; run < runs; ++run) {
        if (all_runs) {
            parts.push_back({run, 0.0, 0.5});
            parts.push_back({run, 0.5, 1.0});
        } else {
            parts.push_back({run});
        }
    }
    return parts;
}

}  // namespace

// The mean square of the residuals of each part with the numbers fitted to the rest.
double CauseSearch::held_out_misfit(const Hypothesis& hypothesis, const SeriesWeights& weights,
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
    double squares = 0.0;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        for (const ResidualSeries& series : fitter.series()) {
            if (series.run != parts[part].run) continue;
            const auto [from, to] = parts[part].rows(series.rows);
            squares += residuals
                           .block(static_cast<Eigen::Index>(series.first_row + from),
                                  static_cast<Eigen::Index>(part), static_cast<Eigen::Index>(to - from), 1)
                           .squaredNorm();
        }
    }
    return squares / fitter.determined_rows();
}

// A cause that does not help to predict what the fit did not see has only fitted the rest. The set without it
// then goes before the set with it.
void CauseSearch::drop_unearned_causes(Fits& fits) {
    constexpr std::size_t enough_runs = 3;
    constexpr double unearned_penalty = 4.0;
    if (run_count_ < enough_runs) return;
    while (fits.front().fit.causes.size() > 1 && !is_out_of_time()) {
        report("predicting each run from the others");
        const Hypothesis all = fits.front().fit.hypothesis();
        const SeriesWeights weights = fits.front().fit.weights;
        const std::vector<LeftOut> parts = parts_to_predict(all, run_count_);
        double least = held_out_misfit(all, weights, parts);
        std::optional<Hypothesis> earned;
        for (const CandidateCause* dropped : all.causes) {
            const Hypothesis fewer =
                only_causes(all, [&](const CandidateCause& cause) { return &cause != dropped; });
            const double misfit = held_out_misfit(fewer, weights, parts);
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
