#include "capstan/worlds/world_trial.h"

#include <algorithm>
#include <cmath>

#include "capstan/estimation/recursive_fusion.h"

namespace capstan {

namespace {

// The fraction of the cable that each node stands for: half of the segments beside it.
std::vector<double> fractions_of_nodes(const Cable& cable) {
    std::vector<double> fraction(static_cast<std::size_t>(cable.nodes()), 0.0);
    for (std::size_t segment = 0; segment + 1 < fraction.size(); ++segment) {
        const double half = 0.5 * cable.relative_length()[segment] / cable.segments();
        fraction[segment] += half;
        fraction[segment + 1] += half;
    }
    return fraction;
}

// Adds up what one sample says, and divides in the end.
class ErrorSums {
  public:
    explicit ErrorSums(const Cable& cable)
        : fraction_(fractions_of_nodes(cable)), node_abs_N_(fraction_.size(), 0.0) {}

    void add(std::span<const double> truth_N, std::span<const double> mean_N,
             std::span<const double> deviation_N) {
        for (std::size_t node = 0; node < truth_N.size(); ++node) {
            const double error_N = std::abs(mean_N[node] - truth_N[node]);
            node_abs_N_[node] += error_N;
            squares_N2_ += fraction_[node] * error_N * error_N;
            // Rounding of a band without width, where everything is known.
            covered_ += error_N <= deviations_of_95 * deviation_N[node] + 1e-9 ? fraction_[node] : 0.0;
        }
        ++samples_;
    }

    WorldError error() && {
        WorldError error;
        for (std::size_t node = 0; node < node_abs_N_.size(); ++node) {
            node_abs_N_[node] /= samples_;
            error.mean_abs_N += fraction_[node] * node_abs_N_[node];
        }
        error.load_end_N = node_abs_N_.back();
        error.worst_place_N = *std::max_element(node_abs_N_.begin(), node_abs_N_.end());
        error.mean_square_N2 = squares_N2_ / samples_;
        error.covered_fraction = covered_ / samples_;
        error.node_abs_N = std::move(node_abs_N_);
        return error;
    }

  private:
    std::vector<double> fraction_;    // nodes
    std::vector<double> node_abs_N_;  // nodes
    double squares_N2_ = 0.0;
    double covered_ = 0.0;
    double samples_ = 0.0;
};

}  // namespace

EnsembleDraws ensemble_draws(const WorldQuestion& question, std::uint32_t world) {
    return {{question.seed, world},
            question.uncertainty.members,
            3 + question.cable.bends(),
            static_cast<int>(question.offers.size()),
            question.motion.samples};
}

WorldError filter_error(const WorldQuestion& question, const CableBelief& belief, const World& world,
                        const EnsembleDraws& draws, std::span<const int> sensors) {
    EnsembleFilter filter(question.cable, belief, question.offers, sensors, draws);
    ErrorSums sums(Cable(question.cable.nominal()));
    std::vector<double> readings(sensors.size());
    for (int sample = 0; sample < world.samples(); ++sample) {
        const auto all = world.readings(sample);
        for (std::size_t s = 0; s < sensors.size(); ++s)
            readings[s] = all[static_cast<std::size_t>(sensors[s])];
        filter.step(world.proximal_increment_m[static_cast<std::size_t>(sample)], readings);
        sums.add(world.tensions_N(sample), filter.mean_N(), filter.deviation_N());
    }
    return std::move(sums).error();
}

WorldError paper_error(const WorldQuestion& question, const World& world, std::span<const int> sensors,
                       const FusionMethod& method) {
    const Cable cable(question.cable.nominal());
    const QuasiStaticStep step(cable, ModelRules::consistent());
    const CableState start = pretensioned(cable);
    RecursiveFusion fusion(step, start, method, DistalSide::admitted);
    const std::vector<double> band(static_cast<std::size_t>(world.nodes), 0.0);
    ErrorSums sums(cable);
    double proximal_m = start.displacement_m.front();
    std::vector<NodeReading> readings;
    for (int sample = 0; sample < world.samples(); ++sample) {
        const auto all = world.readings(sample);
        proximal_m += world.proximal_increment_m[static_cast<std::size_t>(sample)];
        readings.clear();
        for (const int sensor : sensors) {
            const SensorOffer& offer = question.offers[static_cast<std::size_t>(sensor)];
            if (!measures_tension(offer.kind)) continue;
            const int node = cable.nearest_node(offer.place_m);
            const bool is_new = std::none_of(readings.begin(), readings.end(),
                                             [&](const NodeReading& other) { return other.node == node; });
            if (is_new) readings.push_back({node, std::max(all[static_cast<std::size_t>(sensor)], 0.0)});
        }
        fusion.step(proximal_m, readings);
        sums.add(world.tensions_N(sample), fusion.estimate().tension_N, band);
    }
    return std::move(sums).error();
}

}  // namespace capstan
