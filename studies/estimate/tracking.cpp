#include "capstan/estimate/tracking.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "capstan/platform/work_meter.h"

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

// The cable of a run with its numbers off, one after the other.
class ShiftedModels {
  public:
    ShiftedModels(const SensedCable& cable, const SensedRun& run, const std::vector<ShiftedCable>& shifts) {
        models_.reserve(shifts.size());
        for (const ShiftedCable& shift : shifts) {
            CableSpecification specification = cable.specification_in(run);
            specification.dynamic_friction *= shift.friction_ratio;
            specification.static_friction *= shift.friction_ratio;
            specification.axial_stiffness_N *= shift.stiffness_ratio;
            specification.pretension_N *= shift.pretension_ratio;
            models_.emplace_back(Cable(specification), ModelRules::consistent());
            rests_.push_back(pretensioned(models_.back().cable()));
            RateFriction& rate = rate_friction_.emplace_back(cable.rate_friction);
            rate.viscous.drag_N_s_per_m2 *= shift.viscous_ratio;
            rate.stribeck.extra_friction *= shift.stribeck_ratio;
        }
    }

    std::vector<RecursiveEstimator> estimators(RecursiveSettings settings) const {
        std::vector<RecursiveEstimator> all;
        all.reserve(models_.size());
        for (std::size_t k = 0; k < models_.size(); ++k) {
            settings.rate_friction = rate_friction_[k];
            all.emplace_back(models_[k], rests_[k], settings);
        }
        return all;
    }

    // The same motion from the rest of another cable.
    KnownEnds ends(std::size_t model, const CableState& rest, const KnownEnds& known) const {
        return {
            known.proximal_displacement_m + rests_[model].displacement_m.front() -
                rest.displacement_m.front(),
            known.distal_displacement_m + rests_[model].displacement_m.back() - rest.displacement_m.back()};
    }

  private:
    std::vector<QuasiStaticStep> models_;
    std::vector<CableState> rests_;
    std::vector<RateFriction> rate_friction_;
};

}  // namespace

ChannelSet all_but(const SensedCable& cable, std::span<const std::size_t> left_out) {
    ChannelSet used;
    for (std::size_t channel = 0; channel < cable.channels.size(); ++channel) {
        if (std::find(left_out.begin(), left_out.end(), channel) == left_out.end()) used.push_back(channel);
    }
    return used;
}

RecursiveEstimator::Moments TrackedSample::at_node(std::size_t node) const {
    const double mean_N = estimator.mean_N()[node];
    double squares = std::pow(estimator.deviation_N()[node], 2);
    for (const RecursiveEstimator& each : shifted) squares += std::pow(each.mean_N()[node] - mean_N, 2);
    return {mean_N, shifted.empty() ? estimator.deviation_N()[node] : std::sqrt(squares)};
}

RecursiveEstimator::Moments TrackedSample::at(const SensorSpot& spot) const {
    RecursiveEstimator::Moments moments = estimator.at(spot);
    double squares = std::pow(moments.deviation_N, 2);
    for (const RecursiveEstimator& each : shifted)
        squares += std::pow(each.at(spot).mean_N - moments.mean_N, 2);
    if (!shifted.empty()) moments.deviation_N = std::sqrt(squares);
    return moments;
}

TrackingSummary track(const SensedCable& cable, const ChannelSet& used, const ModelTrust& trust,
                      const TrackingOptions& options, const std::function<void(const TrackedSample&)>& show) {
    TrackingSummary summary;
    RecursiveSettings settings;
    settings.members = options.members;
    settings.seed = options.seed;
    settings.wander = {trust.wander_m, trust.wander_m};
    settings.rate_friction = cable.rate_friction;
    settings.interval_s = cable.interval_s;
    for (std::size_t r = 0; r < cable.runs.size(); ++r) {
        const SensedRun& run = cable.runs[r];
        const QuasiStaticStep model(Cable(cable.specification_in(run)), ModelRules::consistent());
        const CableState rest = pretensioned(model.cable());
        RecursiveEstimator estimator(model, rest, settings);
        // Only a band needs them.
        const ShiftedModels others(cable, run, show ? cable.uncertain : std::vector<ShiftedCable>{});
        std::vector<RecursiveEstimator> shifted = others.estimators(settings);
        std::vector<TensionReading> readings;
        for (const std::size_t channel : used) {
            TensionReading reading;
            reading.spot = spot_at(model.cable(), cable.channels[channel].position_m);
            reading.noise.additive_N = cable.channels[channel].noise_N;
            reading.noise.multiplicative_ratio = trust.error_ratio;
            readings.push_back(reading);
        }
        const double work_per_sample = options.members * (1.0 + static_cast<double>(shifted.size()));
        for (std::size_t k = 0; k < run.ends.size(); ++k) {
            for (std::size_t i = 0; i < used.size(); ++i) readings[i].value_N = run.reading_N[used[i]][k];
            const RecursiveReport report = estimator.step(run.ends[k], readings);
            for (std::size_t s = 0; s < shifted.size(); ++s)
                shifted[s].step(others.ends(s, rest, run.ends[k]), readings);
            summary.log_evidence += report.log_evidence;
            summary.unverified += report.unverified;
            ++summary.steps;
            if (show) show({r, k, estimator, shifted});
            note_work(work_per_sample);
        }
    }
    return summary;
}

double tracking_work(const SensedCable& cable, const TrackingOptions& options) {
    double samples = 0.0;
    for (const SensedRun& run : cable.runs) samples += static_cast<double>(run.ends.size());
    return samples * options.members * (1.0 + static_cast<double>(cable.uncertain.size()));
}

double choosing_work(const SensedCable& cable, const TrackingOptions& options) {
    double samples = 0.0;
    for (const SensedRun& run : cable.runs) samples += static_cast<double>(run.ends.size());
    return samples * std::min(options.members, choosing_members) *
           static_cast<double>(2 * std::size(wanders_m) + std::size(error_ratios));
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
