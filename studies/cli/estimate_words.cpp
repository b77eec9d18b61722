#include "capstan/cli/estimate_words.h"

#include <fmt/format.h>

#include "capstan/cli/json_text.h"
#include "capstan/platform/wrapped_text.h"

namespace capstan::cli {

namespace {

using estimate::LeftOutChannel;
using estimate::SensedCable;
using nlohmann::ordered_json;

ordered_json trust_json(const estimate::ModelTrust& trust) {
    return {{"wander_m", trust.wander_m}, {"error_ratio", trust.error_ratio}};
}

ordered_json channel_json(const SensedCable& cable, const LeftOutChannel& result) {
    const estimate::SensedChannel& channel = cable.channels[result.channel];
    ordered_json json = {{"channel", channel.name},
                         {"cable", cable.name},
                         {"position_m", channel.position_m},
                         {"noise_N", channel.noise_N},
                         {"rms_N", result.rms_N},
                         {"coverage", result.coverage},
                         {"mean_band_N", result.mean_band_N},
                         {"coverage_without_widening", result.plain_coverage},
                         {"model_alone_rms_N", result.model_alone_rms_N},
                         {"paper_mean_rms_N", result.paper_mean_rms_N},
                         {"paper_mean_r_rms_N", result.paper_mean_r_rms_N},
                         {"trust", trust_json(result.trust)},
                         {"unverified_fraction", result.unverified_fraction}};
    if (result.widening_known) {
        json["widening"] = result.widening;
    } else {
        json["widening"] = nullptr;
    }
    return json;
}

}  // namespace

std::string left_out_words(const Recording& recording, const std::vector<LeftOutCable>& results) {
    std::string text = fmt::format("{}: {} samples at {:g} Hz; each channel predicted without itself\n\n",
                                   recording.name, recording.samples(), recording.sample_rate_Hz);
    text +=
        fmt::format("  {:<14} {:>6} {:>8} {:>8} {:>9} {:>9} {:>10}  {:>8} {:>8} {:>8}\n", "channel", "s [m]",
                    "noise", "error", "in band", "band +-", "unwidened", "model", "Mean", "Mean-R");
    bool all_known = true;
    for (const LeftOutCable& cable : results) {
        for (const LeftOutChannel& result : cable.channels) {
            const estimate::SensedChannel& channel = cable.cable->channels[result.channel];
            all_known = all_known && result.widening_known;
            text += fmt::format(
                "  {:<14} {:>6.3f} {:>8.3f} {:>8.3f} {:>8.1f}% {:>9.3f} {:>9.1f}%  {:>8.3f} {:>8.3f} {:>8.3f}\n",
                channel.name, channel.position_m, channel.noise_N, result.rms_N, 1e2 * result.coverage,
                result.mean_band_N, 1e2 * result.plain_coverage, result.model_alone_rms_N,
                result.paper_mean_rms_N, result.paper_mean_r_rms_N);
        }
    }
    std::string explained =
        "In newtons. noise: of one sample. error: RMS of reading less prediction, noise included. in band: fraction of "
        "readings within the 95% band, whose mean half width is band; unwidened: the same without the model error that "
        "predicting the other channels shows. model: RMS of the model alone, which reads nothing. Mean, Mean-R: of the "
        "paper's estimators, each step from their own last estimate; they give no band.";
    if (!all_known) {
        explained +=
            " Some bands are NOT widened: it takes three channels on a cable to see the model's error without the channel "
            "that is left out.";
    }
    return text + "\n" + wrapped(explained, 100, "", "") + "\n";
}

std::string left_out_json(const Recording& recording, const std::vector<LeftOutCable>& results) {
    ordered_json json = {{"case", recording.name}, {"channels", ordered_json::array()}};
    for (const LeftOutCable& cable : results) {
        for (const LeftOutChannel& result : cable.channels)
            json["channels"].push_back(channel_json(*cable.cable, result));
    }
    return json_text(json);
}

std::string whole_json(const Recording& recording, const std::vector<SensedCable>& cables,
                       const std::vector<estimate::WholeEstimate>& wholes) {
    ordered_json json = {{"case", recording.name}, {"cables", ordered_json::array()}};
    for (std::size_t c = 0; c < cables.size(); ++c) {
        ordered_json channels = ordered_json::array();
        for (const auto& channel : cables[c].channels) channels.push_back(channel.name);
        ordered_json cable = {
            {"cable", cables[c].name}, {"channels", channels}, {"trust", trust_json(wholes[c].trust)}};
        if (wholes[c].widening_known) {
            cable["widening"] = wholes[c].widening;
        } else {
            cable["widening"] = nullptr;
        }
        json["cables"].push_back(cable);
    }
    return json_text(json);
}

}  // namespace capstan::cli
