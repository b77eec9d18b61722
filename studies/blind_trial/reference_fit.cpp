#include <algorithm>
#include <cmath>
#include <iterator>

#include "capstan/blind_trial/trial_score.h"
#include "capstan/gap/cause_fit.h"
#include "capstan/gap/screening.h"

namespace capstan::gap_trial {

namespace {

using gap::CandidateCause;

// As a diagnosis searches; the result is measured with every sample.
constexpr gap::EffectsTwinOptions searching{40, 2};
constexpr gap::EffectsTwinOptions measuring{40, 1};
// The label does not say which cable is bent, so several candidates can match it.
constexpr std::size_t max_full_fits = 3;

bool matches_label(const CandidateCause& candidate, const TrueCause& truth) {
    return candidate.effect == truth.effect && candidate.component == truth.component &&
           (truth.end.empty() || candidate.end.empty() || candidate.end == truth.end);
}

// The best fit of the present causes with one more true cause; none if the engine has no such cause.
std::optional<gap::CauseFit> with_one_more(const gap::CauseFitter& fitter, const gap::Hypothesis& present,
                                           const std::vector<CandidateCause>& meant) {
    std::optional<gap::CauseFit> best;
    std::size_t fitted = 0;
    for (const gap::Screened& each : gap::screen(fitter, meant, present)) {
        if (fitted++ == max_full_fits) break;
        const gap::CauseFit fit = fitter.fit(gap::with_cause(present, each.cause, each.start), {});
        if (!best || fit.sum_of_squares < best->sum_of_squares) best = fit;
    }
    return best;
}

std::vector<ChannelRms> measured_gap(const Recording& recording, const gap::BenchNumbers& numbers) {
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

std::optional<std::vector<ChannelRms>> reference_fit(const Recording& recording, const CaseLabel& label) {
    if (label.group == TruthGroup::none || label.group == TruthGroup::foreign) return std::nullopt;
    // The engine's fit has neither free geometry nor numbers that follow a condition.
    const bool varies = std::any_of(label.causes.begin(), label.causes.end(),
                                    [](const TrueCause& cause) { return !cause.varies.empty(); });
    if (varies || !recording.nominal) return std::nullopt;
    // The most visible cause first: the other one is fitted to the residuals that it leaves.
    std::vector<TrueCause> truths = label.causes;
    std::stable_sort(truths.begin(), truths.end(),
                     [](const TrueCause& a, const TrueCause& b) { return a.visibility > b.visibility; });
    const std::vector<CandidateCause> candidates = gap::candidate_causes(recording);
    std::vector<std::vector<CandidateCause>> meant;
    for (const TrueCause& truth : truths) {
        meant.emplace_back();
        std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(meant.back()),
                     [&](const CandidateCause& candidate) { return matches_label(candidate, truth); });
    }
    const gap::CauseFitter fitter(recording, searching, 1);
    gap::Hypothesis found = gap::nominal_hypothesis(gap::measured_bench());
    for (const std::vector<CandidateCause>& list : meant) {
        if (list.empty()) return std::nullopt;
        const auto fit = with_one_more(fitter, found, list);
        if (!fit) return std::nullopt;
        found = fit->hypothesis();
    }
    return measured_gap(recording, gap::bench_numbers(found));
}

}  // namespace capstan::gap_trial
