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

// Where to look for a true cause's numbers: as a diagnosis would, but for what the label tells in so many
// words.
std::vector<Eigen::VectorXd> starts_of(const CandidateCause& cause, const TrueCause& truth) {
    std::vector<Eigen::VectorXd> starts = gap::start_grid(cause);
    for (Eigen::VectorXd& start : starts) {
        for (std::size_t k = 0; k < cause.numbers.size(); ++k) {
            const gap::OpenNumber& number = cause.numbers[k];
            double& coordinate = start(static_cast<Eigen::Index>(k));
            if (number.kind == gap::OpenNumber::Kind::place && truth.where)
                coordinate = 0.5 * (truth.where->from_m + truth.where->to_m) / number.typical;
            // A residual as ragged as a staircase leads nowhere from a wrong step.
            if (truth.effect == "sensor_quantization")
                coordinate = (truth.size - number.absent) / (number.typical - number.absent);
            const auto told = truth.shape.find(number.name);
            if (number.kind == gap::OpenNumber::Kind::shape && told != truth.shape.end())
                coordinate = std::log(told->second / number.typical);
        }
    }
    const auto before = [](const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
        return std::lexicographical_compare(x.begin(), x.end(), y.begin(), y.end());
    };
    std::sort(starts.begin(), starts.end(), before);
    starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
    return starts;
}

struct Start {
    const CandidateCause* cause = nullptr;
    Eigen::VectorXd own;
    double sum_of_squares = 0.0;
};

Eigen::VectorXd joined(const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
    Eigen::VectorXd both(first.size() + second.size());
    both << first, second;
    return both;
}

// The best fit of what is there already and one more true cause; none if the engine has no such cause.
std::optional<gap::CauseFit> with_one_more(const gap::CauseFitter& fitter,
                                           const std::vector<CandidateCause>& candidates,
                                           const gap::CauseFit& present, const TrueCause& truth) {
    const auto together = [&](const CandidateCause* cause) {
        Causes causes = present.causes;
        causes.push_back(cause);
        return causes;
    };
    std::vector<Start> starts;
    for (const CandidateCause& candidate : candidates) {
        if (!is_meant(candidate, truth)) continue;
        for (const Eigen::VectorXd& own : starts_of(candidate, truth))
            starts.push_back(
                {&candidate, own,
                 fitter.residuals(together(&candidate), joined(present.coordinates, own)).squaredNorm()});
    }
    std::stable_sort(starts.begin(), starts.end(),
                     [](const Start& a, const Start& b) { return a.sum_of_squares < b.sum_of_squares; });
    std::optional<gap::CauseFit> best;
    const Eigen::VectorXd nominal = present.coordinates.head(gap::nominal_coordinates);
    const Eigen::VectorXd others = present.coordinates.tail(present.coordinates.size() - nominal.size());
    for (std::size_t k = 0; k < std::min(full_fits, starts.size()); ++k) {
        const gap::CauseFit fit =
            fitter.fit(together(starts[k].cause), nominal, {joined(others, starts[k].own)});
        if (!best || fit.sum_of_squares < best->sum_of_squares) best = fit;
    }
    return best;
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
    const gap::CauseFitter fitter(recording, searching, 1);
    // The clearest first: the other one is sought in what it leaves.
    std::vector<TrueCause> truths = label.causes;
    std::stable_sort(truths.begin(), truths.end(),
                     [](const TrueCause& a, const TrueCause& b) { return a.visibility > b.visibility; });
    gap::CauseFit fit;
    fit.coordinates = Eigen::VectorXd::Zero(gap::nominal_coordinates);
    for (const TrueCause& truth : truths) {
        const auto more = with_one_more(fitter, candidates, fit, truth);
        if (!more) return std::nullopt;
        fit = *more;
    }
    return measured_gap(recording, gap::CauseFitter::numbers(fit.causes, fit.coordinates));
}

}  // namespace capstan::gap_trial
