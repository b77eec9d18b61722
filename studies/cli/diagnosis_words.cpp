#include "capstan/cli/diagnosis_words.h"

#include <fmt/format.h>

#include <cmath>

#include "capstan/cli/wrapped_text.h"

namespace capstan::cli {

namespace {

using gap::ChannelGap;
using gap::Diagnosis;
using gap::FittedCause;
using nlohmann::ordered_json;

constexpr std::string_view judged_channel = "load_torque";

const ChannelGap* find_channel(const Diagnosis& diagnosis, std::string_view name) {
    for (const ChannelGap& channel : diagnosis.gap.channels) {
        if (channel.channel == name) return &channel;
    }
    return diagnosis.gap.channels.empty() ? nullptr : &diagnosis.gap.channels.front();
}

std::string numbers_in_words(const FittedCause& cause) {
    std::string text;
    for (const gap::FittedNumber& number : cause.numbers)
        text += fmt::format("{}{} {:.4g}{}{}", text.empty() ? "" : ", ", number.name, number.value,
                            number.unit.empty() ? "" : " ", number.unit);
    return text;
}

std::string where_in_words(const Diagnosis& diagnosis) {
    std::string text = diagnosis.component;
    if (!diagnosis.end.empty()) text += fmt::format(", at the {} end", diagnosis.end);
    if (diagnosis.position_m) text += fmt::format(", about {:.2f} m from the motor", *diagnosis.position_m);
    return text;
}

}  // namespace

std::string verdict_sentence(const Diagnosis& diagnosis) {
    const gap::RankedEffect& first = diagnosis.ranked.front();
    if (first.effect == "none") return "No gap: what is left is noise and the model's own floor.";
    if (first.effect == "unknown")
        return "There is a gap, and none of the known effects explains enough of it; below is what the best of "
               "them does.";
    if (diagnosis.causes.size() > 1)
        return fmt::format("Two causes together: {} and {}.", diagnosis.causes[0].effect,
                           diagnosis.causes[1].effect);
    return fmt::format("The cause is {} with probability {:.2f}.", first.effect, first.probability);
}

namespace {

std::string closed_in_words(const ChannelGap& channel) {
    if (std::isnan(channel.closed)) return "no gap";
    return fmt::format("{:.2f} ({:.2f} to {:.2f})", channel.closed, channel.closed_low, channel.closed_high);
}

std::string explanation_in_words(const std::vector<std::string>& effects) {
    return fmt::format("{}", fmt::join(effects, " with "));
}

}  // namespace

std::string next_experiment_in_words(const gap::Indistinct& indistinct) {
    if (indistinct.group.size() < 2) return "";
    std::vector<std::string> group;
    for (const auto& effects : indistinct.group) group.push_back(explanation_in_words(effects));
    std::string text = fmt::format("This recording does not tell apart: {}.", fmt::join(group, "; "));
    constexpr double helps = 0.8;
    if (indistinct.experiments.empty() || indistinct.experiments.front().told_apart < helps)
        return text + " None of the experiments tried in simulation would.";
    const gap::ExperimentScore& best = indistinct.experiments.front();
    return text + fmt::format(" Record next: {}. It would name the right one with probability {:.2f}.",
                              best.description, best.told_apart);
}

std::string in_words(const gap::Recording& recording, const Diagnosis& diagnosis) {
    std::string text = fmt::format("{}: {}\n", recording.name, verdict_sentence(diagnosis));
    if (!diagnosis.component.empty() && diagnosis.component != "none")
        text += fmt::format("  where     {}\n", where_in_words(diagnosis));
    for (const FittedCause& cause : diagnosis.causes) {
        if (cause.numbers.empty()) continue;  // a wrong nominal number: the next line
        text += fmt::format("  fitted    {}{}{}: {}\n", cause.effect, cause.variant.empty() ? "" : ", ",
                            cause.variant, numbers_in_words(cause));
    }
    text += fmt::format("  nominal   friction x {:.3f}, stiffness x {:.3f}, pretension x {:.3f}\n",
                        diagnosis.friction_ratio, diagnosis.stiffness_ratio, diagnosis.pretension_ratio);
    text += fmt::format("  largest   in run {}, channel {}\n\n  probability of each\n",
                        diagnosis.gap.worst_run, diagnosis.gap.worst_channel);
    for (const gap::RankedEffect& each : diagnosis.ranked) {
        if (each.probability < 0.005) break;
        text += fmt::format("    {:<28} {:.2f}\n", each.effect, each.probability);
    }
    text += fmt::format("\n  {:<14} {:>5} {:>9} {:>9} {:>9} {:>9} {:>10}  {}\n", "RMS of gap", "unit",
                        "noise", "before", "after", "held out", "runner-up", "share closed, held out");
    for (const ChannelGap& channel : diagnosis.gap.channels)
        text +=
            fmt::format("  {:<14} {:>5} {:>9.3g} {:>9.3g} {:>9.3g} {:>9.3g} {:>10.3g}  {}\n", channel.channel,
                        channel.unit, channel.noise, channel.before_rms, channel.after_rms,
                        channel.held_out_rms, channel.runner_up_rms, closed_in_words(channel));
    text += "\n" + wrapped(gap::gap_sentence(diagnosis.gap.map), 100, "  ", "  ") + "\n";
    const std::string next = next_experiment_in_words(diagnosis.indistinct);
    return next.empty() ? text : text + "\n" + wrapped(next, 100, "  ", "  ") + "\n";
}

namespace {

ordered_json number_or_null(double value) {
    return std::isnan(value) ? ordered_json(nullptr) : ordered_json(value);
}

ordered_json optional_text(const std::string& text) {
    return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

}  // namespace

ordered_json in_json(const gap::Recording& recording, const Diagnosis& diagnosis) {
    ordered_json json = {{"case", recording.name}, {"ranked", ordered_json::array()}};
    for (const gap::RankedEffect& each : diagnosis.ranked)
        json["ranked"].push_back({{"effect", each.effect}, {"probability", each.probability}});
    json["where"] = {
        {"component", optional_text(diagnosis.component)},
        {"end", optional_text(diagnosis.end)},
        {"s_m", diagnosis.position_m ? ordered_json(*diagnosis.position_m) : ordered_json(nullptr)},
        {"worst_run", diagnosis.gap.worst_run},
        {"worst_channel", diagnosis.gap.worst_channel}};
    if (const ChannelGap* channel = find_channel(diagnosis, judged_channel)) {
        json["channel"] = channel->channel;
        json["rms_before"] = channel->before_rms;
        json["rms_after"] = channel->after_rms;
        json["unit"] = channel->unit;
    }
    json["causes"] = ordered_json::array();
    for (const FittedCause& cause : diagnosis.causes) {
        ordered_json numbers = ordered_json::object();
        for (const gap::FittedNumber& number : cause.numbers)
            numbers[number.name] = {{"value", number.value}, {"unit", number.unit}};
        json["causes"].push_back({{"effect", cause.effect},
                                  {"variant", optional_text(cause.variant)},
                                  {"component", cause.component},
                                  {"numbers", numbers}});
    }
    json["nominal_ratios"] = {{"friction", diagnosis.friction_ratio},
                              {"stiffness", diagnosis.stiffness_ratio},
                              {"pretension", diagnosis.pretension_ratio}};
    json["misfit"] = {{"before", diagnosis.misfit_before}, {"after", diagnosis.misfit_after}};
    json["independent_samples"] = diagnosis.independent_samples;
    json["candidates"] = ordered_json::array();
    for (const gap::CandidateScore& each : diagnosis.candidates)
        json["candidates"].push_back({{"effects", each.effects},
                                      {"variants", each.variants},
                                      {"open_numbers", each.open_numbers},
                                      {"misfit", each.misfit},
                                      {"nominal_price", each.nominal_price},
                                      {"visibility", each.visibility},
                                      {"evidence", each.evidence}});
    json["indistinct"] = {{"group", diagnosis.indistinct.group}, {"experiments", ordered_json::array()}};
    for (const gap::ExperimentScore& each : diagnosis.indistinct.experiments)
        json["indistinct"]["experiments"].push_back({{"kind", each.kind},
                                                     {"name", each.name},
                                                     {"description", each.description},
                                                     {"told_apart", each.told_apart}});
    json["channels"] = ordered_json::array();
    for (const ChannelGap& channel : diagnosis.gap.channels)
        json["channels"].push_back({{"channel", channel.channel},
                                    {"unit", channel.unit},
                                    {"noise", channel.noise},
                                    {"rms_before", channel.before_rms},
                                    {"rms_after", channel.after_rms},
                                    {"rms_held_out", channel.held_out_rms},
                                    {"rms_runner_up", channel.runner_up_rms},
                                    {"closed_share", number_or_null(channel.closed)},
                                    {"closed_low", number_or_null(channel.closed_low)},
                                    {"closed_high", number_or_null(channel.closed_high)}});
    json["gap_map"] = ordered_json::array();
    for (const gap::GapShare& share : diagnosis.gap.map)
        json["gap_map"].push_back({{"by", share.by},
                                   {"name", share.name},
                                   {"share", share.share},
                                   {"low", share.low},
                                   {"high", share.high},
                                   {"share_of_samples", share.of_samples}});
    json["gap_in_words"] = gap::gap_sentence(diagnosis.gap.map);
    return json;
}

}  // namespace capstan::cli
