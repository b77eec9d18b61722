#include "capstan/gap_trial/reference_fit.h"

#include <algorithm>
#include <cmath>

#include "capstan/gap/cause_fit.h"

namespace capstan::gap_trial {

namespace {

using gap::CandidateCause;
using Causes = std::vector<const CandidateCause*>;

// As a diagnosis searches; the result is measured with every sample.
constexpr gap::EffectsTwinOptions searching{40, 2};
constexpr gap::EffectsTwinOptions measuring{40, 1};
constexpr std::size_t full_fits = 2;

bool is_meant(const CandidateCause& candidate, const TrueCause& truth) {
    return candidate.effect == truth.effect && candidate.component == truth.component &&
           (truth.end.empty() || candidate.end.empty() || candidate.end == truth.end);
}

// Every way to pick one candidate for each true cause: a bend's cables are not in the label.
std::vector<Causes> choices(const std::vector<CandidateCause>& candidates,
                            const std::vector<TrueCause>& truths) {
    std::vector<Causes> all = {{}};
    for (const TrueCause& truth : truths) {
        std::vector<Causes> longer;
        for (const Causes& begun : all) {
            for (const CandidateCause& candidate : candidates) {
                if (!is_meant(candidate, truth)) continue;
                longer.push_back(begun);
                longer.back().push_back(&candidate);
            }
        }
        all = std::move(longer);
    }
    return all;
}

std::vector<Eigen::VectorXd> starts_of(const Causes& causes) {
    std::vector<Eigen::VectorXd> all = {Eigen::VectorXd(0)};
    for (const CandidateCause* cause : causes) {
        std::vector<Eigen::VectorXd> longer;
        for (const Eigen::VectorXd& begun : all) {
            for (const Eigen::VectorXd& own : gap::start_grid(*cause)) {
                Eigen::VectorXd together(begun.size() + own.size());
                together << begun, own;
                longer.push_back(together);
            }
        }
        all = std::move(longer);
    }
    return all;
}

struct Start {
    const Causes* causes = nullptr;
    Eigen::VectorXd own;
    double sum_of_squares = 0.0;
};

// All starts of all choices, best first.
std::vector<Start> ranked_starts(const gap::CauseFitter& fitter, const std::vector<Causes>& all) {
    std::vector<Start> ranked;
    for (const Causes& causes : all) {
        for (const Eigen::VectorXd& own : starts_of(causes)) {
            Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(gap::nominal_coordinates + own.size());
            coordinates.tail(own.size()) = own;
            ranked.push_back({&causes, own, fitter.residuals(causes, coordinates).squaredNorm()});
        }
    }
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const Start& a, const Start& b) { return a.sum_of_squares < b.sum_of_squares; });
    return ranked;
}

std::vector<ChannelRms> measured_gap(const gap::Recording& recording, const gap::BenchNumbers& numbers) {
    const gap::EffectsTwin twin(recording, measuring);
    std::vector<ChannelRms> sums(recording.channels.size());
    std::vector<double> samples(recording.channels.size(), 0.0);
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const gap::TwinRun before = twin.run(run, {});
        const gap::TwinRun after = twin.run(run, numbers);
        for (std::size_t channel = 0; channel < sums.size(); ++channel) {
            for (std::size_t k = 0; k < before.values[channel].size(); ++k) {
                const double measured = recording.runs[run].values[channel][k];
                sums[channel].before += std::pow(measured - before.values[channel][k], 2);
                sums[channel].after += std::pow(measured - after.values[channel][k], 2);
                samples[channel] += 1.0;
            }
        }
    }
    std::vector<ChannelRms> channels;
    for (std::size_t channel = 0; channel < sums.size(); ++channel) {
        if (samples[channel] == 0.0) continue;
        channels.push_back({recording.channels[channel].name,
                            std::sqrt(sums[channel].before / samples[channel]),
                            std::sqrt(sums[channel].after / samples[channel])});
    }
    return channels;
}

}  // namespace

std::optional<std::vector<ChannelRms>> reference_fit(const gap::Recording& recording,
                                                     const CaseLabel& label) {
    if (label.group == TruthGroup::none || label.group == TruthGroup::foreign) return std::nullopt;
    const std::vector<CandidateCause> candidates = gap::candidate_causes(recording);
    const std::vector<Causes> all = choices(candidates, label.causes);
    if (all.empty()) return std::nullopt;
    const gap::CauseFitter fitter(recording, searching, 1);
    const std::vector<Start> starts = ranked_starts(fitter, all);
    std::optional<gap::CauseFit> best;
    for (std::size_t k = 0; k < std::min(full_fits, starts.size()); ++k) {
        const gap::CauseFit fit =
            fitter.fit(*starts[k].causes, Eigen::VectorXd::Zero(gap::nominal_coordinates), {starts[k].own});
        if (!best || fit.sum_of_squares < best->sum_of_squares) best = fit;
    }
    return measured_gap(recording, gap::CauseFitter::numbers(best->causes, best->coordinates));
}

}  // namespace capstan::gap_trial
