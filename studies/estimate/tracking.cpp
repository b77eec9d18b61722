#include "capstan/estimate/tracking.h"

#include <algorithm>
#include <limits>

namespace capstan::estimate {

namespace {

// From below what an encoder resolves to a tenth of a millimetre a sample.
constexpr double wanders_m[] = {1e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4};
constexpr double error_ratios[] = {0.0, 0.003, 0.01, 0.03, 0.1, 0.2};
constexpr ModelTrust first_guess{1e-5, 0.03};
// A choice among a few orders of magnitude needs fewer members than a band.
constexpr int choosing_members = 16;

// Every so many-th run of choices: what is chosen, by evidence.
template <std::size_t count>
void choose(const SensedCable& cable, const ChannelSet& used, const TrackingOptions& options,
            const double (&grid)[count], double ModelTrust::*number, ModelTrust& trust) {
    double best = -std::numeric_limits<double>::infinity();
    ModelTrust chosen = trust;
    for (const double value : grid) {
        ModelTrust tried = trust;
        tried.*number = value;
        const double evidence = track(cable, used, tried, options).log_evidence;
        if (evidence > best) {
            best = evidence;
            chosen = tried;
        }
    }
    trust = chosen;
}

}  // namespace

ChannelSet all_but(const SensedCable& cable, std::span<const std::size_t> left_out) {
    ChannelSet used;
    for (std::size_t channel = 0; channel < cable.channels.size(); ++channel) {
        if (std::find(left_out.begin(), left_out.end(), channel) == left_out.end()) used.push_back(channel);
    }
    return used;
}

TrackingSummary track(const SensedCable& cable, const ChannelSet& used, const ModelTrust& trust,
                      const TrackingOptions& options, const std::function<void(const TrackedSample&)>& show) {
    TrackingSummary summary;
    RecursiveSettings settings;
    settings.members = options.members;
    settings.seed = options.seed;
    settings.wander = {trust.wander_m, trust.wander_m};
    for (std::size_t r = 0; r < cable.runs.size(); ++r) {
        const SensedRun& run = cable.runs[r];
        CableSpecification specification = cable.specification;
        specification.pretension_N = run.pretension_N;
        const QuasiStaticStep model(Cable(specification), ModelRules::consistent());
        RecursiveEstimator estimator(model, pretensioned(model.cable()), settings);
        std::vector<TensionReading> readings;
        for (const std::size_t channel : used) {
            TensionReading reading;
            reading.spot = spot_at(model.cable(), cable.channels[channel].position_m);
            reading.noise.additive_N = cable.channels[channel].noise_N;
            reading.noise.multiplicative_ratio = trust.error_ratio;
            readings.push_back(reading);
        }
        for (std::size_t k = 0; k < run.ends.size(); ++k) {
            for (std::size_t i = 0; i < used.size(); ++i) readings[i].value_N = run.reading_N[used[i]][k];
            const RecursiveReport report = estimator.step(run.ends[k], readings);
            summary.log_evidence += report.log_evidence;
            summary.unverified += report.unverified;
            ++summary.steps;
            if (show) show({r, k, estimator});
        }
    }
    return summary;
}

ModelTrust likeliest_trust(const SensedCable& cable, const ChannelSet& used, const TrackingOptions& options) {
    TrackingOptions few = options;
    few.members = std::min(options.members, choosing_members);
    ModelTrust trust = first_guess;
    choose(cable, used, few, wanders_m, &ModelTrust::wander_m, trust);
    choose(cable, used, few, error_ratios, &ModelTrust::error_ratio, trust);
    choose(cable, used, few, wanders_m, &ModelTrust::wander_m, trust);
    return trust;
}

}  // namespace capstan::estimate
