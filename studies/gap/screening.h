#pragma once

#include <vector>

#include "capstan/gap/cause_fit.h"

namespace capstan::gap {

/// What a cause promises to explain, and where a search for its numbers should start.
struct Screened {
    const CandidateCause* cause = nullptr;
    Eigen::VectorXd start;  // of the cause's own numbers
    double sum_of_squares = 0.0;
};

/// A quick look at what each cause could explain on top of `present`: by the direction in which it moves the
/// residuals, the numbers already there free to follow. Most promising first. The fitter may be a coarse one.
std::vector<Screened> screen(const CauseFitter& fitter, const std::vector<CandidateCause>& causes,
                             const Hypothesis& present);

}  // namespace capstan::gap
