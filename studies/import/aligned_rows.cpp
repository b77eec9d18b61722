#include "capstan/import/aligned_rows.h"

#include <algorithm>
#include <cmath>

namespace capstan::imports {

namespace {

/// Times of a uniform grid, or the usable times of a source.
class SampleTimes {
  public:
    SampleTimes(const LogRun& run, const Piece& piece, std::size_t channel) : piece_(piece) {
        if (piece.grid_Hz == 0.0) readings_.emplace(run.sources[channel], run.rows);
    }

    bool next(double& time_s) {
        if (!readings_) {
            time_s = piece_.from_s + static_cast<double>(sample_++) / piece_.grid_Hz;
            return time_s <= piece_.to_s + 1e-9 / piece_.grid_Hz;
        }
        double value = 0.0;
        while (readings_->next(time_s, value)) {
            if (time_s > piece_.to_s) return false;
            if (time_s >= piece_.from_s) return true;
        }
        return false;
    }

  private:
    const Piece& piece_;
    std::optional<Track> readings_;
    std::size_t sample_ = 0;
};

}  // namespace

std::size_t for_each_row(const LogRun& run, const Piece& piece, std::span<const std::size_t> channels,
                         const std::function<void(double, std::span<const double>)>& row) {
    SampleTimes times(run, piece, channels.front());
    std::vector<TrackAt> tracks;
    for (const std::size_t channel : channels) tracks.emplace_back(run.sources[channel], run.rows);
    std::vector<double> values(channels.size());
    std::vector<double> sums(channels.size(), 0.0);
    std::size_t rows = 0;
    int in_block = 0;
    double block_s = 0.0;
    for (double time_s = 0.0; times.next(time_s);) {
        bool complete = true;
        for (std::size_t k = 0; k < tracks.size(); ++k) {
            values[k] = tracks[k].at(time_s);
            complete &= std::isfinite(values[k]);
        }
        if (!complete) continue;
        if (in_block == 0) block_s = time_s - piece.from_s;
        if (piece.thinning == Thinning::mean) {
            for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += values[k];
        } else if (in_block == 0) {
            row(block_s, values);
            ++rows;
        }
        if (++in_block < piece.thinned_by) continue;
        in_block = 0;
        if (piece.thinning == Thinning::mean) {
            for (double& sum : sums) sum /= piece.thinned_by;
            row(block_s, sums);
            ++rows;
            std::fill(sums.begin(), sums.end(), 0.0);
        }
    }
    return rows;
}

}  // namespace capstan::imports
