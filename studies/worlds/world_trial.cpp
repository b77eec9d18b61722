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

// The same over both cables of a pair.
std::vector<double> fractions_of_nodes(const WorldQuestion& question) {
    std::vector<double> fraction = fractions_of_nodes(Cable(question.cable.nominal()));
    if (question.belief.arrangement == CableArrangement::single) return fraction;
    for (double& each : fraction) each *= 0.5;
    const std::vector<double> of_one = fraction;
    fraction.insert(fraction.end(), of_one.begin(), of_one.end());
    return fraction;
}

// Adds up what one sample says, and divides in the end.
class ErrorSums {
  public:
    explicit ErrorSums(const WorldQuestion& question)
        : fraction_(fractions_of_nodes(question)),
          cables_(static_cast<std::size_t>(cables_of(question.belief.arrangement))),
          node_abs_N_(fraction_.size(), 0.0) {}

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
        const std::size_t nodes = node_abs_N_.size() / cables_;
        for (std::size_t end = nodes; end <= node_abs_N_.size(); end += nodes)
            error.load_end_N += node_abs_N_[end - 1] / static_cast<double>(cables_);
        error.worst_place_N = *std::max_element(node_abs_N_.begin(), node_abs_N_.end());
        error.mean_square_N2 = squares_N2_ / samples_;
        error.covered_fraction = covered_ / samples_;
        error.node_abs_N = std::move(node_abs_N_);
        return error;
    }

  private:
    std::vector<double> fraction_;  // cables x nodes
    std::size_t cables_;
    std::vector<double> node_abs_N_;  // cables x nodes
    double squares_N2_ = 0.0;
    double covered_ = 0.0;
    double samples_ = 0.0;
};

}  // namespace

EnsembleDraws ensemble_draws(const WorldQuestion& question, std::uint32_t world) {
    return {{question.seed, world},
            question.uncertainty.members,
            cables_of(question.belief.arrangement) * EnsembleCable::drawn_numbers(question.cable),
            static_cast<int>(question.offers.size()),
            question.motion.samples};
}

WorldError filter_error(const WorldQuestion& question, const CableBelief& belief, const World& world,
                        const EnsembleDraws& draws, std::span<const int> sensors) {
    EnsembleFilter filter(question.cable, belief, question.offers, sensors, draws);
    ErrorSums sums(question);
    std::vector<double> readings;
    for (int sample = 0; sample < world.samples(); ++sample) {
        world.read(sample, question.offers, sensors, readings);
        filter.step(world.proximal_increment_m[static_cast<std::size_t>(sample)], readings);
        sums.add(world.tensions_N(sample), filter.mean_N(), filter.deviation_N());
    }
    return std::move(sums).error();
}

WorldError paper_error(const WorldQuestion& question, const World& world, std::span<const int> sensors,
                       const FusionMethod& method, std::span<const double> weight) {
    const Cable cable(question.cable.nominal());
    const QuasiStaticStep step(cable, ModelRules::consistent());
    const CableState start = pretensioned(cable);
    const auto node_of = [&](const SensorOffer& offer) { return cable.nearest_node(offer.place_m); };
    std::vector<double> weight_of_node(static_cast<std::size_t>(world.nodes), 0.0);
    for (std::size_t s = sensors.size(); s-- > 0 && !weight.empty();) {
        const auto sensor = static_cast<std::size_t>(sensors[s]);
        if (measures_tension(question.offers[sensor].kind))
            weight_of_node[static_cast<std::size_t>(node_of(question.offers[sensor]))] = weight[sensor];
    }
    RecursiveFusion fusion(step, start, method, DistalSide::admitted, weight_of_node);
    const std::vector<double> band(static_cast<std::size_t>(world.nodes), 0.0);
    ErrorSums sums(question);
    double proximal_m = start.displacement_m.front();
    std::vector<double> all;
    std::vector<NodeReading> readings;
    for (int sample = 0; sample < world.samples(); ++sample) {
        world.read(sample, question.offers, sensors, all);
        proximal_m += world.proximal_increment_m[static_cast<std::size_t>(sample)];
        readings.clear();
        for (std::size_t s = 0; s < sensors.size(); ++s) {
            const SensorOffer& offer = question.offers[static_cast<std::size_t>(sensors[s])];
            if (!measures_tension(offer.kind)) continue;
            const int node = node_of(offer);
            const bool is_new = std::none_of(readings.begin(), readings.end(),
                                             [&](const NodeReading& other) { return other.node == node; });
            if (is_new) readings.push_back({node, std::max(all[s], 0.0)});
        }
        fusion.step(proximal_m, readings);
        sums.add(world.tensions_N(sample), fusion.estimate().tension_N, band);
    }
    return std::move(sums).error();
}

double paper_weight(const WorldQuestion& question, int sensor) {
    constexpr std::uint32_t first_world = 1U << 30;  // no study gets there
    constexpr std::uint32_t worlds = 10;
    double sum_N = 0.0;
    for (std::uint32_t world = first_world; world < first_world + worlds; ++world)
        sum_N += paper_error(question, draw_world(question, world), {&sensor, 1}, mean_method).mean_abs_N;
    return worlds / std::max(sum_N, 1e-12);
}

}  // namespace capstan
