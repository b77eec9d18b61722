#include <fmt/format.h>

#include "capstan/answers/recording_answers.h"

namespace capstan::answers {

namespace {

using gap_trial::Fraction;
using gap_trial::TrialScore;
using reports::Data;

Data fraction_data(const Fraction& fraction) {
    return {{"hits", fraction.hits},
            {"of", fraction.of},
            {"fraction", fraction.of > 0 ? Data(fraction.value()) : Data()},
            {"interval_95", Data::list({fraction.low(), fraction.high()})}};
}

Data shrinkage_data(const gap_trial::Shrinkage& shrinkage) {
    return {{"cases", shrinkage.cases},
            {"median_before_by_truth", shrinkage.median_before},
            {"median_after_by_truth", shrinkage.median_after},
            {"at_most_10_percent_more", fraction_data(shrinkage.as_good_as_truth)}};
}

Data reliability_data(const std::vector<gap_trial::ReliabilityBin>& bins) {
    Data rows = Data::list();
    for (const gap_trial::ReliabilityBin& bin : bins)
        rows.push_back({{"from", bin.from},
                        {"to", bin.to},
                        {"cases", bin.right.of},
                        {"mean_probability", bin.mean_probability},
                        {"fraction_right", bin.right.value()},
                        {"interval_95", Data::list({bin.right.low(), bin.right.high()})}});
    return rows;
}

Data causes_data(const gap_trial::CausesScore& causes) {
    Data data = {{"named_from", gap_trial::named_from}, {"groups", Data::list()}};
    for (const gap_trial::CauseGroup& group : causes.groups)
        data["groups"].push_back({{"by", group.by},
                                  {"name", group.name},
                                  {"recall", fraction_data(group.recall)},
                                  {"all_named", fraction_data(group.all_named)},
                                  {"first", fraction_data(group.first)},
                                  {"false_names", fraction_data(group.false_names)}});
    data["unknown"] = fraction_data(causes.unknown);
    data["varies"] = fraction_data(causes.varies);
    data["false_varies"] = fraction_data(causes.false_varies);
    data["calibration_error"] = causes.calibration_error;
    data["calibration_error_by_chance"] = causes.calibration_error_by_chance;
    data["reliability"] = reliability_data(causes.reliability);
    return data;
}

Data named(const char* what, Data row) {
    Data data = {{"what", what}};
    data.update(row);
    return data;
}

Data values_of(const gap_trial::TrialOptions& options, const std::string& seal, const TrialScore& score) {
    Data data = {{"trial", reports::parse_json(gap_trial::options_text(options))},
                 {"labels_sha256", seal},
                 {"groups", Data::list()}};
    for (const gap_trial::GroupScore& group : score.groups)
        data["groups"].push_back({{"by", group.by},
                                  {"name", group.name},
                                  {"top1", fraction_data(group.top1)},
                                  {"top3", fraction_data(group.top3)},
                                  {"family", fraction_data(group.family)}});
    data["false_alarms"] = fraction_data(score.false_alarms);
    data["missed_gaps"] = fraction_data(score.missed_gaps);
    data["unknown_found"] = fraction_data(score.foreign_found);
    data["needless_unknown"] = fraction_data(score.needless_unknown);
    data["both_of_mixtures"] = fraction_data(score.both_of_mixtures);
    data["component"] = fraction_data(score.component);
    data["end"] = fraction_data(score.end);
    data["place"] = fraction_data(score.place);
    data["median_place_error_m"] = score.median_place_error_m;
    data["brier"] = score.calibration.brier;
    data["ece"] = score.calibration.ece;
    data["ece_by_chance"] = score.calibration.ece_by_chance;
    data["reliability"] = reliability_data(score.calibration.bins);
    data["causes"] = causes_data(score.causes);
    data["shrinkage"] = {{"load_torque", shrinkage_data(score.load_torque)},
                         {"clearest_channel", shrinkage_data(score.clearest_channel)}};
    data["unanswered"] = score.unanswered;
    return data;
}

reports::AnswerTable fractions_table(const char* id, Data rows) {
    return {id,
            "",
            {{"what", ""},
             {"hits", "cases"},
             {"of", "of"},
             {"fraction", "fraction", "", ".1%"},
             {"interval_95", "95% interval", "", ".1%"}},
            std::move(rows)};
}

reports::AnswerTable reliability_table(const char* id, Data rows) {
    return {id,
            "",
            {{"from", "from", "", ".1f"},
             {"to", "to", "", ".1f"},
             {"cases", "statements"},
             {"mean_probability", "mean stated", "", ".3f"},
             {"fraction_right", "right", "", ".3f"},
             {"interval_95", "95% interval", "", ".2f"}},
            std::move(rows)};
}

}  // namespace

reports::Answer trial_score_answer(const gap_trial::TrialOptions& options, const std::string& seal,
                                   const TrialScore& score) {
    reports::Answer answer{.id = "trial", .kind = "Blind trial of the diagnosis", .title = "Blind trial"};
    const Fraction& first = score.groups.front().top1;
    answer.headline =
        fmt::format("the cause is named first in {} of {} cases ({:.1f}%, 95% interval {:.0f} to {:.0f}%).",
                    first.hits, first.of, 1e2 * first.value(), 1e2 * first.low(), 1e2 * first.high());
    answer.values = values_of(options, seal, score);
    Data alarms = Data::list(), places = Data::list(), left = Data::list();
    alarms.push_back(
        named("false alarms: an effect is named where there is none", fraction_data(score.false_alarms)));
    alarms.push_back(
        named("missed: `none` is named where there is an effect", fraction_data(score.missed_gaps)));
    alarms.push_back(
        named("`unknown` where the effect is outside the catalogue", fraction_data(score.foreign_found)));
    alarms.push_back(
        named("`unknown` where the catalogue has the effect", fraction_data(score.needless_unknown)));
    alarms.push_back(
        named("both effects of a mixture are the first two", fraction_data(score.both_of_mixtures)));
    places.push_back(named("component", fraction_data(score.component)));
    places.push_back(named("end", fraction_data(score.end)));
    places.push_back(named("place within 0.15 m", fraction_data(score.place)));
    Data conditions = Data::list();
    conditions.push_back(
        named("`unknown` is named where all causes are known", fraction_data(score.causes.unknown)));
    conditions.push_back(named("the condition of a named number that follows one is stated",
                               fraction_data(score.causes.varies)));
    conditions.push_back(named("a condition is stated for an effect that follows none",
                               fraction_data(score.causes.false_varies)));
    left.push_back(named("load torque", shrinkage_data(score.load_torque)));
    left.push_back(named("clearest channel", shrinkage_data(score.clearest_channel)));
    answer.sections = {
        {.id = "groups",
         .heading = "Cause named first, among the first three, and its family",
         .tables = {{"groups",
                     "",
                     {{"by", "by"},
                      {"name", "group"},
                      {"top1.of", "cases"},
                      {"top1.fraction", "first", "", ".1%"},
                      {"top1.interval_95", "95% interval", "", ".0%"},
                      {"top3.fraction", "first three", "", ".1%"},
                      {"family.fraction", "family", "", ".1%"}},
                     answer.values["groups"]}}},
        {.id = "alarms",
         .heading = "None, unknown and mixtures",
         .tables = {fractions_table("alarms", alarms)}},
        {.id = "places",
         .heading = "Where, of single causes that were named correctly",
         .tables = {fractions_table("places", places)},
         .note = score.place.of > 0
                     ? fmt::format("Median error of the place: {:.3f} m.", score.median_place_error_m)
                     : ""},
        {.id = "reliability",
         .heading = "Stated probabilities",
         .prose = fmt::format(
             "Brier score {:.3f}, expected calibration error {:.3f} ({:.3f} by chance alone if every probability "
             "is right). A verdict of several effects is right if all of them are there.",
             score.calibration.brier, score.calibration.ece, score.calibration.ece_by_chance),
         .tables = {reliability_table("reliability", answer.values["reliability"])}},
        {.id = "causes",
         .heading = "Causes by name",
         .prose = fmt::format(
             "An effect is named where the probability that it is present is at least {}. Nuisances that every "
             "rig has count neither way. A false name is an effect that is not there; `unknown` is counted apart.",
             gap_trial::named_from),
         .tables = {{"causes",
                     "",
                     {{"by", "by"},
                      {"name", "group"},
                      {"recall.of", "causes"},
                      {"recall.fraction", "named", "", ".1%"},
                      {"recall.interval_95", "95% interval", "", ".0%"},
                      {"first.of", "cases"},
                      {"all_named.fraction", "all named", "", ".1%"},
                      {"first.fraction", "a cause first", "", ".1%"},
                      {"false_names.fraction", "a false name", "", ".1%"}},
                     answer.values["causes"]["groups"]},
                    fractions_table("conditions", conditions)}},
        {.id = "presence",
         .heading = "Stated probabilities that an effect is present",
         .prose = fmt::format(
             "Of every effect stated with at least {}; expected calibration error {:.3f} ({:.3f} by "
             "chance alone if every probability is right).",
             gap_trial::stated_from, score.causes.calibration_error,
             score.causes.calibration_error_by_chance),
         .tables = {reliability_table("presence", answer.values["causes"]["reliability"])}},
        {.id = "shrinkage",
         .heading =
             "What the named cause leaves of the gap on runs held out, relative to the true cause (median of the RMS ratio)",
         .tables = {{"shrinkage",
                     "",
                     {{"what", "channel"},
                      {"cases", "cases"},
                      {"median_before_by_truth", "before", "", ".2f"},
                      {"median_after_by_truth", "after", "", ".2f"},
                      {"at_most_10_percent_more.fraction", "at most 10% more", "", ".1%"}},
                     left}}}};
    if (!score.unanswered.empty())
        answer.sections.back().note =
            fmt::format("{} cases were not answered and are not in these numbers.", score.unanswered.size());
    return answer;
}

}  // namespace capstan::answers
