#pragma once

#include <cstdint>

#include "capstan/sensing/random_stream.h"

namespace capstan::gap_trial {

/// The purpose of a random number. Each purpose has its own stream, so that one more draw for one purpose
/// changes nothing for the others.
enum class DrawTopic : std::uint32_t { plan = 101, bench, motion, effect, noise, nominal_error, nuisance };

/// Numbers of one case for one topic, in order. The same seed, case and topic give the same numbers on every
/// machine and thread.
class TrialStream {
  public:
    TrialStream(std::uint64_t seed, int case_index, DrawTopic topic);

    double normal();  ///< mean 0, standard deviation 1
    double uniform(double low, double high);
    /// Uniform in the logarithm; both ends positive.
    double log_uniform(double low, double high);
    int integer_below(int count);  ///< 0 to count - 1, all equally likely
    double sign();                 ///< -1 or 1

  private:
    RandomAddress address_;
    double spare_ = 0.0;
    bool has_spare_ = false;
};

}  // namespace capstan::gap_trial
