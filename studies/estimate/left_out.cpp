#include "capstan/estimate/left_out.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimate/tracking.h"
#include "capstan/platform/parallel_for.h"
#include "capstan/platform/statistics.h"

namespace capstan::estimate {

namespace {

// The squared model error, in parts of the tension, that one reading asks for so as to be just within the
// band.
void add_needed(const SensedCable& cable, const ChannelSet& used, std::size_t predicted,
                const ModelTrust& trust, const TrackingOptions& options, std::vector<double>& needed) {
    const SensedChannel& channel = cable.channels[predicted];
    const Cable cut(cable.specification_in(cable.runs.front()));
    const SensorSpot spot = spot_at(cut, channel.position_m);
    track(cable, used, trust, options, [&](const TrackedSample& at) {
        const RecursiveEstimator::Moments moments = at.at(spot);
        const double error_N = cable.runs[at.run].reading_N[predicted][at.sample] - moments.mean_N;
        const double within = std::pow(error_N / two_sided_95, 2) - std::pow(moments.deviation_N, 2) -
                              std::pow(channel.noise_N, 2);
        // The error of a slack cable is not a fraction of its tension; 1 N keeps the ratio finite.
        const double tension_N = std::max(moments.mean_N, 1.0);
        needed.push_back(std::max(within, 0.0) / (tension_N * tension_N));
    });
}

// E39.
double widening_of(std::vector<double> needed) {
    if (needed.empty()) return 0.0;
    const auto place =
        needed.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(needed.size()));
    std::nth_element(needed.begin(), place, needed.end());
    return std::sqrt(*place);
}

double model_alone_rms_N(const SensedCable& cable, std::size_t predicted, const SensorSpot& spot) {
    double squares = 0.0;
    long samples = 0;
    TrackingOptions one_is_enough;
    one_is_enough.members = 8;
    track(cable, {}, {0.0, 0.0}, one_is_enough, [&](const TrackedSample& at) {
        squares += std::pow(cable.runs[at.run].reading_N[predicted][at.sample] - at.at(spot).mean_N, 2);
        ++samples;
    });
    return std::sqrt(squares / static_cast<double>(samples));
}

LeftOutChannel left_out(const SensedCable& cable, std::size_t predicted, const TrackingOptions& options) {
    LeftOutChannel result;
    result.channel = predicted;
    const std::size_t one[] = {predicted};
    const ChannelSet used = all_but(cable, one);
    result.trust = likeliest_trust(cable, used, options);
    std::vector<double> needed;
    if (used.size() >= 2) {
        for (const std::size_t other : used) {
            const std::size_t two[] = {predicted, other};
            add_needed(cable, all_but(cable, two), other, result.trust, options, needed);
        }
    }
    result.widening_known = used.size() >= 2;
    result.widening = widening_of(std::move(needed));

    const SensedChannel& channel = cable.channels[predicted];
    const SensorSpot spot = spot_at(Cable(cable.specification_in(cable.runs.front())), channel.position_m);
    long samples = 0;
    long within = 0;
    long within_plain = 0;
    double squares = 0.0;
    const TrackingSummary summary = track(cable, used, result.trust, options, [&](const TrackedSample& at) {
        const RecursiveEstimator::Moments moments = at.at(spot);
        const double error_N = std::abs(cable.runs[at.run].reading_N[predicted][at.sample] - moments.mean_N);
        const double noise_N = two_sided_95 * channel.noise_N;
        const double half_N = std::hypot(band_N(moments, result.widening), noise_N);
        within += error_N <= half_N;
        within_plain += error_N <= std::hypot(band_N(moments, 0.0), noise_N);
        squares += error_N * error_N;
        result.mean_band_N += half_N;
        ++samples;
    });
    const double count = static_cast<double>(samples);
    result.rms_N = std::sqrt(squares / count);
    result.coverage = static_cast<double>(within) / count;
    result.plain_coverage = static_cast<double>(within_plain) / count;
    result.mean_band_N /= count;
    result.unverified_fraction =
        static_cast<double>(summary.unverified) / static_cast<double>(summary.steps * options.members);
    result.model_alone_rms_N = model_alone_rms_N(cable, predicted, spot);
    result.paper_mean_rms_N = paper_rms_N(cable, used, predicted, mean_method);
    result.paper_mean_r_rms_N = paper_rms_N(cable, used, predicted, mean_r_method);
    return result;
}

}  // namespace

double band_N(const RecursiveEstimator::Moments& moments, double widening) {
    return two_sided_95 * std::hypot(moments.deviation_N, widening * moments.mean_N);
}

double leave_out_work(const SensedCable& cable, std::size_t channels, const TrackingOptions& options) {
    const auto others = static_cast<double>(cable.channels.size() - 1);
    return static_cast<double>(channels) *
           (choosing_work(cable, options) + (others + 1.0) * tracking_work(cable, options));
}

double tuning_work(const SensedCable& cable, const TrackingOptions& options) {
    const std::size_t channels = cable.channels.size();
    return choosing_work(cable, options) +
           (channels < 2 ? 0.0 : static_cast<double>(channels) * tracking_work(cable, options));
}

std::vector<LeftOutChannel> leave_out(const SensedCable& cable, const std::vector<std::size_t>& channels,
                                      const TrackingOptions& options) {
    if (cable.channels.size() < 2) {
        throw InvalidInput({"cable " + cable.name + " has one tension channel only, " +
                            cable.channels.front().name +
                            "; leaving it out leaves nothing to predict it from. Record at least two"});
    }
    std::vector<LeftOutChannel> results(channels.size());
    parallel_for_each_index(static_cast<int>(channels.size()), options.jobs, [&](int k) {
        const auto index = static_cast<std::size_t>(k);
        results[index] = left_out(cable, channels[index], options);
    });
    return results;
}

EstimatorTuning tune_estimator(const SensedCable& cable, const TrackingOptions& options) {
    EstimatorTuning tuning;
    const ChannelSet all = all_but(cable, {});
    tuning.trust = likeliest_trust(cable, all, options);
    tuning.widening_known = all.size() >= 2;
    if (!tuning.widening_known) return tuning;
    std::vector<std::vector<double>> needed(all.size());
    parallel_for_each_index(static_cast<int>(all.size()), options.jobs, [&](int k) {
        const std::size_t predicted[] = {static_cast<std::size_t>(k)};
        add_needed(cable, all_but(cable, predicted), predicted[0], tuning.trust, options,
                   needed[predicted[0]]);
    });
    std::vector<double> pooled;
    for (const std::vector<double>& one : needed) pooled.insert(pooled.end(), one.begin(), one.end());
    tuning.widening = widening_of(std::move(pooled));
    return tuning;
}

}  // namespace capstan::estimate
