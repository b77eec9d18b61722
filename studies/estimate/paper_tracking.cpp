#include <algorithm>
#include <cmath>

#include "capstan/estimate/tracking.h"

namespace capstan::estimate {

namespace {

constexpr int paper_segments = 10;

// Of channels that share a node the one with the least noise.
template <typename NodeOf>
ChannelSet one_a_node(const SensedCable& cable, const ChannelSet& used, const NodeOf& node_of) {
    ChannelSet by_noise = used;
    std::sort(by_noise.begin(), by_noise.end(), [&](std::size_t a, std::size_t b) {
        return cable.channels[a].noise_N < cable.channels[b].noise_N;
    });
    ChannelSet kept;
    for (const std::size_t channel : by_noise) {
        const bool taken = std::any_of(kept.begin(), kept.end(),
                                       [&](std::size_t other) { return node_of(other) == node_of(channel); });
        if (!taken) kept.push_back(channel);
    }
    return kept;
}

}  // namespace

double paper_rms_N(const SensedCable& cable, const ChannelSet& used, std::size_t predicted,
                   const FusionMethod& method) {
    double squares = 0.0;
    double samples = 0.0;
    for (const SensedRun& run : cable.runs) {
        CableSpecification specification = cable.specification_in(run);
        specification.segments = paper_segments;
        const QuasiStaticStep model(Cable(specification), ModelRules::consistent());
        const auto node_of = [&](std::size_t channel) {
            return model.cable().nearest_node(cable.channels[channel].position_m);
        };
        const ChannelSet read = one_a_node(cable, used, node_of);
        std::vector<NodeReading> readings;
        for (const std::size_t channel : read) readings.push_back({node_of(channel), 0.0});
        RecursiveFusion fusion(model, pretensioned(model.cable()), method, DistalSide::excluded);
        const SensorSpot spot = spot_at(model.cable(), cable.channels[predicted].position_m);
        for (std::size_t k = 0; k < run.ends.size(); ++k) {
            for (std::size_t i = 0; i < readings.size(); ++i) readings[i].value_N = run.reading_N[read[i]][k];
            fusion.step(run.ends[k].proximal_displacement_m, readings);
            squares += std::pow(run.reading_N[predicted][k] - tension_at_N(fusion.estimate(), spot), 2);
            ++samples;
        }
    }
    return std::sqrt(squares / samples);
}

}  // namespace capstan::estimate
