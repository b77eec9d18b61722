#include "capstan/cli/diagnosis_words.h"

#include <fmt/format.h>

#include <cmath>

#include "capstan/cli/stored_diagnosis.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/reports/diagnosis_report.h"

namespace capstan::cli {

namespace {

using gap::ChannelGap;
using gap::Diagnosis;
using gap::FittedCause;
using nlohmann::ordered_json;

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

std::string next_experiment_in_words(const gap::NonIdentifiable& non_identifiable) {
    if (non_identifiable.group.size() < 2) return "";
    std::vector<std::string> group;
    for (const auto& effects : non_identifiable.group) group.push_back(explanation_in_words(effects));
    std::string text = fmt::format("This recording does not tell apart: {}.", fmt::join(group, "; "));
    constexpr double helps = 0.8;
    if (non_identifiable.experiments.empty() ||
        non_identifiable.experiments.front().discrimination_probability < helps)
        return text + " None of the experiments tried in simulation would.";
    const gap::ExperimentScore& best = non_identifiable.experiments.front();
    return text + fmt::format(" Record next: {}. It would name the right one with probability {:.2f}.",
                              best.description, best.discrimination_probability);
}

std::string in_words(const Recording& recording, const Diagnosis& diagnosis) {
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
                        "noise", "before", "after", "held out", "runner-up", "fraction closed, held out");
    for (const ChannelGap& channel : diagnosis.gap.channels)
        text +=
            fmt::format("  {:<14} {:>5} {:>9.3g} {:>9.3g} {:>9.3g} {:>9.3g} {:>10.3g}  {}\n", channel.channel,
                        channel.unit, channel.noise, channel.before_rms, channel.after_rms,
                        channel.held_out_rms, channel.runner_up_rms, closed_in_words(channel));
    text += "\n" + wrapped(gap::gap_sentence(diagnosis.gap.map), 100, "  ", "  ") + "\n";
    const std::string next = next_experiment_in_words(diagnosis.non_identifiable);
    return next.empty() ? text : text + "\n" + wrapped(next, 100, "  ", "  ") + "\n";
}

ordered_json in_json(const Recording& recording, const Diagnosis& diagnosis) {
    ordered_json json = reports::diagnosis_json(diagnosis_record(recording, diagnosis));
    json["non_identifiable"] = {{"group", diagnosis.non_identifiable.group},
                                {"experiments", ordered_json::array()}};
    for (const gap::ExperimentScore& each : diagnosis.non_identifiable.experiments)
        json["non_identifiable"]["experiments"].push_back(
            {{"kind", each.kind},
             {"name", each.name},
             {"description", each.description},
             {"discrimination_probability", each.discrimination_probability}});
    return json;
}

}  // namespace capstan::cli
