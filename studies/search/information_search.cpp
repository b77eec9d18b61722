#include "capstan/search/information_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace capstan {

namespace {

// Rounding must not cut off an equally good layout.
constexpr double rounding_nats = 1e-12;

// One scenario's I + D^-1/2 C D^-1/2 while sensors are added: of every node what is left of its variance, and
// its row of the Cholesky factor.
struct Factor {
    const SetInformation* information = nullptr;
    std::vector<double> left;              // nodes
    std::vector<std::vector<double>> row;  // sensors so far x nodes
};

class BranchAndBound {
  public:
    BranchAndBound(const AverageInformation& information, const PlacementConstraints& constraints,
                   int sensors, long max_branches)
        : fraction_(information.fraction),
          constraints_(constraints),
          usable_(constraints.usable_nodes()),
          sensors_(sensors),
          branches_left_(max_branches) {
        for (const SetInformation& scenario : information.scenarios) {
            Factor factor{&scenario, std::vector<double>(scenario.nodes()), {}};
            for (int node = 0; node < scenario.nodes(); ++node)
                factor.left[node] = 1.0 + scenario.scaled_covariance(node, node);
            factors_.push_back(std::move(factor));
        }
        // The most informative nodes first, so that good layouts are found early and bounds fall fast.
        std::stable_sort(usable_.begin(), usable_.end(), [&](int a, int b) { return gain(a) > gain(b); });
    }

    MostInformative run() {
        greedy();
        branch(0, 0.0);
        std::sort(best_.nodes.begin(), best_.nodes.end());
        best_.at_most_nats = std::max(best_.nats, cut_off_nats_);
        return best_;
    }

  private:
    double gain(int node) const {
        double nats = 0.0;
        for (std::size_t s = 0; s < factors_.size(); ++s) {
            if (fraction_[s] > 0.0)
                nats += fraction_[s] * 0.5 * std::log(std::max(factors_[s].left[node], 1.0));
        }
        return nats;
    }

    void add(int node) {
        for (Factor& factor : factors_) {
            const double pivot = std::sqrt(factor.left[node]);
            std::vector<double> row(factor.left.size());
            for (const int other : usable_) {
                double value =
                    factor.information->scaled_covariance(node, other) + (other == node ? 1.0 : 0.0);
                for (const std::vector<double>& before : factor.row) value -= before[node] * before[other];
                row[other] = value / pivot;
                factor.left[other] -= row[other] * row[other];
            }
            factor.row.push_back(std::move(row));
        }
        chosen_.push_back(node);
    }

    void take_back(std::vector<std::vector<double>> left_before) {
        for (std::size_t s = 0; s < factors_.size(); ++s) {
            factors_[s].left = std::move(left_before[s]);
            factors_[s].row.pop_back();
        }
        chosen_.pop_back();
    }

    std::vector<std::vector<double>> left() const {
        std::vector<std::vector<double>> all;
        for (const Factor& factor : factors_) all.push_back(factor.left);
        return all;
    }

    std::vector<int> with(int node) const {
        std::vector<int> layout = chosen_;
        layout.push_back(node);
        std::sort(layout.begin(), layout.end());
        return layout;
    }

    void keep_if_better(double nats) {
        if (nats <= best_.nats && !best_.nodes.empty()) return;
        std::vector<int> layout = chosen_;
        std::sort(layout.begin(), layout.end());
        if (!constraints_.allow(layout)) return;
        best_.nodes = std::move(layout);
        best_.nats = nats;
    }

    // Adds one sensor after the other, so that branches have a layout to compare with from the start.
    void greedy() {
        double nats = 0.0;
        std::vector<std::vector<std::vector<double>>> before;
        while (static_cast<int>(chosen_.size()) < sensors_) {
            int best = -1;
            for (const int node : usable_) {
                if (std::find(chosen_.begin(), chosen_.end(), node) != chosen_.end()) continue;
                if (!constraints_.allow_on_the_way(with(node))) continue;
                if (best < 0 || gain(node) > gain(best)) best = node;
            }
            if (best < 0) break;
            nats += gain(best);
            before.push_back(left());
            add(best);
        }
        if (static_cast<int>(chosen_.size()) == sensors_) keep_if_better(nats);
        while (!before.empty()) {
            take_back(std::move(before.back()));
            before.pop_back();
        }
    }

    // All layouts that begin with those chosen and go on with usable nodes from `first` on.
    void branch(std::size_t first, double nats) {
        const int open = sensors_ - static_cast<int>(chosen_.size());
        if (open == 0) return keep_if_better(nats);
        std::vector<std::pair<double, std::size_t>> next;  // gain, place among the usable
        for (std::size_t k = first; k < usable_.size(); ++k) {
            if (constraints_.allow_on_the_way(with(usable_[k]))) next.emplace_back(gain(usable_[k]), k);
        }
        // For each place the bound on layouts that continue with it and with later ones.
        std::vector<double> gains;
        std::vector<double> bound(next.size(), -std::numeric_limits<double>::infinity());
        for (std::size_t k = next.size(); k-- > 0;) {
            gains.insert(std::upper_bound(gains.begin(), gains.end(), next[k].first, std::greater<>()),
                         next[k].first);
            if (static_cast<int>(gains.size()) < open) continue;
            double most = nats + next[k].first;
            int taken = 1;
            bool own_left_out = false;
            for (std::size_t g = 0; g < gains.size() && taken < open; ++g) {
                if (!own_left_out && gains[g] == next[k].first) {
                    own_left_out = true;
                    continue;
                }
                most += gains[g];
                ++taken;
            }
            bound[k] = most;
        }
        for (std::size_t k = 0; k < next.size(); ++k) {
            if (bound[k] <= best_.nats + rounding_nats && !best_.nodes.empty()) continue;
            if (bound[k] == -std::numeric_limits<double>::infinity()) break;
            if (branches_left_-- <= 0) {
                cut_off_nats_ = std::max(cut_off_nats_, bound[k]);
                continue;
            }
            auto before = left();
            const double gained = next[k].first;
            add(usable_[next[k].second]);
            branch(next[k].second + 1, nats + gained);
            take_back(std::move(before));
        }
    }

    const std::vector<double>& fraction_;
    const PlacementConstraints& constraints_;
    std::vector<int> usable_;
    int sensors_;
    long branches_left_;
    std::vector<Factor> factors_;  // scenarios
    std::vector<int> chosen_;
    MostInformative best_;
    double cut_off_nats_ = 0.0;  // the largest bound of the branches not examined
};

}  // namespace

MostInformative max_information_layout(const AverageInformation& information,
                                       const PlacementConstraints& constraints, int sensors,
                                       long max_branches) {
    return BranchAndBound(information, constraints, sensors, max_branches).run();
}

}  // namespace capstan
