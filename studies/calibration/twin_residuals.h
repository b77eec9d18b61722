#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "capstan/calibration/twin.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

/// Consecutive samples of one run.
struct RunPart {
    std::size_t run = 0;
    int first = 0;
    int end = 0;
};

struct ChannelErrors {
    std::vector<std::optional<double>> rms;  // channels; none where the twin predicts nothing
    int unsolved_steps = 0;
};

/// Measured minus model over a recording, each channel of each run in units of its own scale.
class TwinResiduals {
  public:
    /// `recording` and `twin` must outlive this; `threads` as for parallel_for_each_index.
    TwinResiduals(const Recording& recording, const Twin& twin, int threads);

    /// Each run from where the twin can be compared.
    std::vector<RunPart> complete_runs() const;

    /// Scale of a channel in a run: the RMS of its residuals with these parameters, at least its stated
    /// noise.
    void set_scales(const std::vector<double>& values);

    /// Residuals of the parts, one column for each set of parameters: blocks x channels x samples.
    Eigen::MatrixXd of(const std::vector<RunPart>& parts,
                       const std::vector<std::vector<double>>& values) const;
    /// Where each block of a second ends in the rows of `of`.
    std::vector<Eigen::Index> block_ends(const std::vector<RunPart>& parts) const;

    ChannelErrors rms(std::size_t run, const std::vector<double>& values) const;

  private:
    std::vector<RunPart> blocks(const std::vector<RunPart>& parts) const;
    int rows(const RunPart& block) const;

    const Recording& recording_;
    const Twin& twin_;
    int threads_;
    std::vector<std::vector<int>> predicted_;  // runs x predicted channels: their indices
    std::vector<std::vector<double>> scales_;  // runs x channels
};

}  // namespace capstan::gap
