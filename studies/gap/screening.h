#pragma once

#include <map>
#include <span>
#include <vector>

#include "capstan/gap/cause_fit.h"

namespace capstan::gap {

/// How much a cause could explain, and where a search for its numbers should start.
struct Screened {
    const CandidateCause* cause = nullptr;
    Eigen::VectorXd start;  // of the cause's own numbers
    double sum_of_squares = 0.0;
};

/// Where a search for a cause may start.
struct Probe {
    const CandidateCause* cause = nullptr;
    Eigen::VectorXd start;                      // of the cause's own numbers
    std::vector<Eigen::VectorXd> directions{};  // each with one size present, the others absent
    std::vector<std::size_t> sizes{};           // which of its numbers
};

/// Of a cause with many starts, such as periods of a ripple, those that promised most when it was screened
/// first. Only these are screened again.
using PromisingStarts = std::map<const CandidateCause*, std::vector<Probe>>;

/// A linear estimate of how much each cause could explain in addition to `present`, whose numbers are free to
/// follow: least squares on the changes of the residuals, weighted by `weights`. Most promising first. The
/// fitter may be a coarse one. `promising`: of earlier screenings; gets those of new causes.
std::vector<Screened> screen(const CauseFitter& fitter, std::span<const CandidateCause> causes,
                             const Hypothesis& present, const SeriesWeights& weights = {},
                             PromisingStarts* promising = nullptr);

/// The same for every place and shape at which a search for one cause may start.
std::vector<Screened> screen_each_start(const CauseFitter& fitter, const CandidateCause& cause,
                                        const Hypothesis& present, const SeriesWeights& weights);

/// Two causes that act together.
struct ScreenedPair {
    const CandidateCause* first = nullptr;
    Eigen::VectorXd start_of_first;
    const CandidateCause* second = nullptr;
    Eigen::VectorXd start_of_second;
    double sum_of_squares = 0.0;
};

/// A linear estimate of how much two causes could explain together, for every pair but those with a wrong
/// nominal number, a step or an oscillation. Most promising first.
std::vector<ScreenedPair> screen_pairs(const CauseFitter& fitter, std::span<const CandidateCause> causes,
                                       const Hypothesis& present, const SeriesWeights& weights = {},
                                       const PromisingStarts& promising = {});

}  // namespace capstan::gap
