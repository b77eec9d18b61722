#include "capstan/gap_trial/trial_table.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

using nlohmann::ordered_json;

std::string in_percent(const Fraction& fraction) {
    if (fraction.of == 0) return "-";
    return fmt::format("{:.1f}% ({:.0f}-{:.0f})", 1e2 * fraction.value(), 1e2 * fraction.low(),
                       1e2 * fraction.high());
}

std::string row(const std::string& what, const Fraction& fraction) {
    return fmt::format("  {:<46} {:>18}  {:>4} of {}\n", what, in_percent(fraction), fraction.hits,
                       fraction.of);
}

std::string group_rows(const TrialScore& score) {
    std::string text = fmt::format("  {:<10} {:<26} {:>5} {:>17} {:>17} {:>17}\n", "by", "", "cases", "first",
                                   "among first 3", "family");
    std::string by;
    for (const GroupScore& group : score.groups) {
        text += fmt::format("  {:<10} {:<26} {:>5} {:>17} {:>17} {:>17}\n", group.by == by ? "" : group.by,
                            group.name, group.top1.of, in_percent(group.top1), in_percent(group.top3),
                            in_percent(group.family));
        by = group.by;
    }
    return text;
}

std::string reliability_rows(const Calibration& calibration) {
    std::string text =
        fmt::format("  {:<12} {:>5} {:>12} {:>12}\n", "probability", "cases", "mean stated", "right");
    for (const ReliabilityBin& bin : calibration.bins)
        text += fmt::format("  {:.1f} to {:.1f}   {:>5} {:>12.3f} {:>12.3f}\n", bin.from, bin.to, bin.cases,
                            bin.mean_probability, bin.fraction_right);
    return text;
}

std::string shrinkage_row(const std::string& channel, const Shrinkage& shrinkage) {
    if (shrinkage.cases == 0) return "";
    return fmt::format("  {:<20} {:>5} cases: {:.2f} (before: {:.1f}); at most 1.1 in {}\n", channel,
                       shrinkage.cases, shrinkage.median_after, shrinkage.median_before,
                       in_percent(shrinkage.as_good_as_truth));
}

ordered_json fraction_json(const Fraction& fraction) {
    return {{"hits", fraction.hits},
            {"of", fraction.of},
            {"fraction", fraction.of > 0 ? ordered_json(fraction.value()) : ordered_json(nullptr)},
            {"interval_95", {fraction.low(), fraction.high()}}};
}

ordered_json shrinkage_json(const Shrinkage& shrinkage) {
    return {{"cases", shrinkage.cases},
            {"median_before_by_truth", shrinkage.median_before},
            {"median_after_by_truth", shrinkage.median_after},
            {"at_most_10_percent_more", fraction_json(shrinkage.as_good_as_truth)}};
}

}  // namespace

std::string trial_table(const TrialScore& score) {
    std::string text = "Effect named first, among the first three, and its family; 95% intervals\n";
    text += group_rows(score);
    text += "\nNo cause, and causes outside the catalogue\n";
    text += row("false alarms: a cause named where there is none", score.false_alarms);
    text += row("missed gaps: `none` where there is a cause", score.missed_gaps);
    text += row("`unknown` for a cause outside the catalogue", score.foreign_found);
    text += row("`unknown` for a cause in the catalogue", score.needless_unknown);
    text += row("both effects of a pair are ranked first", score.both_of_mixtures);
    text += "\nPlace, for single causes that are named correctly\n";
    text += row("component", score.component);
    text += row("end", score.end);
    text += row("place within 0.15 m", score.place);
    if (score.place.of > 0)
        text +=
            fmt::format("  {:<46} {:>14.3f} m\n", "median error of the place", score.median_place_error_m);
    text += fmt::format("\nStated probabilities: Brier score {:.3f}, expected calibration error {:.3f}\n",
                        score.calibration.brier, score.calibration.ece);
    text += reliability_rows(score.calibration);
    if (score.load_torque.cases > 0) {
        text += "\nThe gap that the named cause leaves, relative to the true cause (RMS, median)\n";
        text += shrinkage_row(channel::load_torque, score.load_torque);
        text += shrinkage_row("clearest channel", score.clearest_channel);
    }
    if (!score.unanswered.empty())
        text +=
            fmt::format("\n{} cases without an answer are not in these numbers\n", score.unanswered.size());
    return text;
}

std::string trial_json(const TrialOptions& options, const std::string& seal, const TrialScore& score) {
    ordered_json json = {{"trial", ordered_json::parse(options_text(options))},
                         {"labels_sha256", seal},
                         {"groups", ordered_json::array()}};
    for (const GroupScore& group : score.groups)
        json["groups"].push_back({{"by", group.by},
                                  {"name", group.name},
                                  {"top1", fraction_json(group.top1)},
                                  {"top3", fraction_json(group.top3)},
                                  {"family", fraction_json(group.family)}});
    json["false_alarms"] = fraction_json(score.false_alarms);
    json["missed_gaps"] = fraction_json(score.missed_gaps);
    json["unknown_found"] = fraction_json(score.foreign_found);
    json["needless_unknown"] = fraction_json(score.needless_unknown);
    json["both_of_mixtures"] = fraction_json(score.both_of_mixtures);
    json["component"] = fraction_json(score.component);
    json["end"] = fraction_json(score.end);
    json["place"] = fraction_json(score.place);
    json["median_place_error_m"] = score.median_place_error_m;
    json["brier"] = score.calibration.brier;
    json["ece"] = score.calibration.ece;
    json["reliability"] = ordered_json::array();
    for (const ReliabilityBin& bin : score.calibration.bins)
        json["reliability"].push_back({{"from", bin.from},
                                       {"to", bin.to},
                                       {"cases", bin.cases},
                                       {"mean_probability", bin.mean_probability},
                                       {"fraction_right", bin.fraction_right}});
    json["shrinkage"] = {{channel::load_torque, shrinkage_json(score.load_torque)},
                         {"clearest_channel", shrinkage_json(score.clearest_channel)}};
    json["unanswered"] = score.unanswered;
    return json.dump(2) + "\n";
}

}  // namespace capstan::gap_trial
