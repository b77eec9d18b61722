// What a corrected model leaves, and what it looks like.
#include <algorithm>

#include "capstan/answers/recording_answers.h"

namespace capstan::answers {

namespace {

using model_comparison::LeftOver;
using reports::Data;

Data law_data(const LeftOver& left, const std::string& channel) {
    const residual_law::ResidualLaw& law = left.law;
    Data terms = Data::list();
    for (const residual_law::LawTerm& term : law.terms)
        terms.push_back({{"kind", name_of(term.features.front().kind)},
                         {"parameter", term.features.front().parameter},
                         {"times_load", term.features.front().times_load},
                         {"size", term.size},
                         {"half_width_95", term.half_width > 0.0 ? Data(term.half_width) : Data()},
                         {"words", term.words}});
    const bool holds = law.holds();
    return {
        {"channel", channel},
        {"unit", left.names.output_unit},
        {"rms", law.residual_rms},
        {"form", !holds                  ? "no structure"
                 : law.terms.empty()     ? "history of the motion"
                 : law.has_history_model ? "terms and history of the motion"
                                         : "terms"},
        {"terms", terms},
        {"removed_fraction", holds ? Data(law.removed_fraction) : Data()},
        {"removed_interval_95", law.removed_low ? Data::list({*law.removed_low, *law.removed_high}) : Data()},
        {"rms_left_out", holds ? Data(law.left_out_rms) : Data()},
        {"band_95", law.band},
        {"sentence", residual_law::law_sentence(law, left.names)}};
}

}  // namespace

void add_before_curves(reports::Answer& answer, reports::AnswerSection section) {
    const auto curves = std::find_if(answer.sections.begin(), answer.sections.end(),
                                     [](const reports::AnswerSection& each) { return each.id == "runs"; });
    answer.sections.insert(curves, std::move(section));
}

void add_left_over(reports::Answer& answer, const std::vector<LeftOver>& left, const Recording& recording) {
    Data rows = Data::list();
    std::string prose;
    for (const LeftOver& each : left) {
        const std::string& channel = recording.channels[each.channels.output].name;
        rows.push_back(law_data(each, channel));
        const std::string sentence = residual_law::law_sentence(each.law, each.names);
        if (!sentence.empty()) prose += (prose.empty() ? "" : " ") + sentence;
    }
    answer.values["left_over"] = rows;
    if (prose.empty()) return;
    add_before_curves(
        answer,
        {.id = "left",
         .heading = "What is left",
         .prose = prose,
         .tables = {{"left_over",
                     "RMS that the corrected model leaves, from one second into each run",
                     {worded_column("channel"),
                      {"unit", "unit"},
                      {"rms", "corrected", "", ".3g"},
                      {"rms_left_out", "with law", "", ".3g"},
                      {"form", "form"},
                      {"removed_fraction", "removed", "", ".2f"},
                      {"removed_interval_95", "95% interval", "", ".2f"},
                      {"band_95", "95% band", "", ".3g"}},
                     rows}},
         .note =
             "The law is chosen and fitted without each run in turn and judged on it: with law, removed "
             "(fraction of the mean square) and band (95% of the samples are within) are for such runs. A run whose "
             "load lies outside those of the others counts less there."});
}

}  // namespace capstan::answers
