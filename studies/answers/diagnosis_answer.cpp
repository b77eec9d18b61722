#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "capstan/answers/recording_answers.h"
#include "capstan/effects/known_causes.h"
#include "capstan/rig/channel_names.h"

namespace capstan::answers {

namespace {

using gap::Diagnosis;
using reports::Answer;
using reports::Data;
using reports::Table;
using storage::DiagnosisCauseRecord;
using storage::DiagnosisChannelRecord;
using storage::DiagnosisRecord;

constexpr std::size_t drawn_causes = 8;
// An effect with a smaller probability is in JSON and CSV only.
constexpr double shown_probability = 0.005;

Data text_or_nothing(const std::string& text) {
    return text.empty() ? Data() : Data(text);
}

// The load's torque, else the first channel.
const DiagnosisChannelRecord* judged_channel(const DiagnosisRecord& diagnosis) {
    for (const DiagnosisChannelRecord& each : diagnosis.channels) {
        if (each.channel == "load_torque") return &each;
    }
    return diagnosis.channels.empty() ? nullptr : &diagnosis.channels.front();
}

// Of titles, from "sensor_offset, motor_torque".
reports::Column cause_column(const std::string& path) {
    return {path, path, "", "", [](const std::string& name) {
                const std::size_t comma = name.find(", ");
                return cause_words(name.substr(0, comma),
                                   comma == std::string::npos ? "" : name.substr(comma + 2));
            }};
}

Data interval_or_nothing(const std::optional<double>& low, const std::optional<double>& high) {
    return low && high ? Data::list({*low, *high}) : Data();
}

Data cause_data(const DiagnosisCauseRecord& cause) {
    Data numbers = Data::record();
    for (const auto& number : cause.numbers)
        numbers[number.name] = {
            {"value", number.value_in_unit},
            {"unit", number.unit},
            {"interval_95", interval_or_nothing(number.low_in_unit, number.high_in_unit)}};
    return {{"effect", cause.effect},
            {"variant", text_or_nothing(cause.variant)},
            {"component", cause.component},
            {"position_m", cause.position_m},
            {"numbers", numbers}};
}

Data channel_data(const DiagnosisChannelRecord& channel) {
    const Data interval = interval_or_nothing(channel.closed_low_fraction, channel.closed_high_fraction);
    return {{"channel", channel.channel},
            {"unit", channel.unit},
            {"noise", channel.noise_in_unit},
            {"rms_before", channel.rms_before_in_unit},
            {"rms_after", channel.rms_after_in_unit},
            {"rms_held_out", channel.rms_held_out_in_unit},
            {"rms_runner_up", channel.rms_runner_up_in_unit},
            {"closed_fraction", channel.closed_fraction},
            {"closed_low", channel.closed_low_fraction},
            {"closed_high", channel.closed_high_fraction},
            {"closed_interval_95", interval}};
}

Data candidates_data(const DiagnosisRecord& diagnosis) {
    Data list = Data::list();
    for (const auto& each : diagnosis.candidates)
        list.push_back({{"effects", reports::parse_json(each.effects)},
                        {"variants", reports::parse_json(each.variants)},
                        {"open_numbers", each.open_numbers},
                        {"misfit", each.misfit_ratio},
                        {"nominal_penalty", each.nominal_penalty_log},
                        {"visibility", reports::parse_json(each.visibility_ratios)},
                        {"evidence", each.evidence_log}});
    return list;
}

// A diagnosis that was stored by an early version does not say whether an effect is present at all.
constexpr double not_stated = std::numeric_limits<double>::quiet_NaN();

std::vector<gap::RankedEffect> effects_of(const DiagnosisRecord& diagnosis) {
    std::vector<gap::RankedEffect> effects;
    for (const auto& each : diagnosis.effects)
        effects.push_back({each.effect, each.probability_fraction, each.present_fraction.value_or(not_stated),
                           each.varies});
    return effects;
}

Data ranked_data(const std::vector<gap::RankedEffect>& effects) {
    Data list = Data::list();
    for (const gap::RankedEffect& each : effects) {
        Data entry = {{"effect", each.effect},
                      {"probability", each.probability},
                      {"present", std::isnan(each.present) ? Data() : Data(each.present)}};
        if (!each.varies.empty()) entry["varies"] = each.varies;
        list.push_back(entry);
    }
    return list;
}

// The form that a judge reads (case, ranked, where, RMS before and after) and everything else.
Data values_of(const DiagnosisRecord& diagnosis) {
    Data data = {{"case", diagnosis.recording},
                 {"ranked", ranked_data(gap::in_answered_names(effects_of(diagnosis)))},
                 {"effects", ranked_data(effects_of(diagnosis))}};
    data["where"] = {{"component", text_or_nothing(diagnosis.component)},
                     {"end", text_or_nothing(diagnosis.cable_end)},
                     {"s_m", diagnosis.position_m},
                     {"worst_run", diagnosis.worst_run},
                     {"worst_channel", diagnosis.worst_channel}};
    if (const DiagnosisChannelRecord* channel = judged_channel(diagnosis)) {
        data["channel"] = channel->channel;
        data["rms_before"] = channel->rms_before_in_unit;
        data["rms_after"] = channel->rms_after_in_unit;
        data["unit"] = channel->unit;
    }
    data["causes"] = Data::list();
    for (const DiagnosisCauseRecord& cause : diagnosis.causes) data["causes"].push_back(cause_data(cause));
    data["nominal_ratios"] = {{"friction", diagnosis.friction_ratio},
                              {"stiffness", diagnosis.stiffness_ratio},
                              {"pretension", diagnosis.pretension_ratio}};
    data["nominal_intervals_95"] = {
        {"friction", interval_or_nothing(diagnosis.friction_low_ratio, diagnosis.friction_high_ratio)},
        {"stiffness", interval_or_nothing(diagnosis.stiffness_low_ratio, diagnosis.stiffness_high_ratio)},
        {"pretension", interval_or_nothing(diagnosis.pretension_low_ratio, diagnosis.pretension_high_ratio)}};
    data["misfit"] = {{"before", diagnosis.misfit_before_ratio}, {"after", diagnosis.misfit_after_ratio}};
    data["independent_samples"] = diagnosis.independent_samples_count;
    data["candidates"] = candidates_data(diagnosis);
    data["channels"] = Data::list();
    for (const auto& channel : diagnosis.channels) data["channels"].push_back(channel_data(channel));
    data["gap_map"] = Data::list();
    for (const auto& each : diagnosis.gap)
        data["gap_map"].push_back({{"by", each.divided_by},
                                   {"name", each.part},
                                   {"fraction", each.energy_fraction},
                                   {"low", each.low_fraction},
                                   {"high", each.high_fraction},
                                   {"fraction_of_samples", each.samples_fraction}});
    data["gap_sentence"] = diagnosis.gap_sentence;
    return data;
}

// The fitted numbers, and the nominal ones as ratios to their nominal values.
Data fitted_data(const DiagnosisRecord& diagnosis) {
    Data rows = Data::list();
    for (const DiagnosisCauseRecord& cause : diagnosis.causes) {
        for (const auto& number : cause.numbers)
            rows.push_back({{"of", cause.effect + (cause.variant.empty() ? "" : ", " + cause.variant)},
                            {"number", number.name},
                            {"value", number.value_in_unit},
                            {"interval_95", interval_or_nothing(number.low_in_unit, number.high_in_unit)},
                            {"unit", number.unit}});
    }
    const auto add = [&](const char* name, double ratio, const std::optional<double>& low,
                         const std::optional<double>& high) {
        rows.push_back({{"of", "nominal model"},
                        {"number", name},
                        {"value", ratio},
                        {"interval_95", interval_or_nothing(low, high)},
                        {"unit", "nominal value"}});
    };
    add("friction", diagnosis.friction_ratio, diagnosis.friction_low_ratio, diagnosis.friction_high_ratio);
    add("stiffness", diagnosis.stiffness_ratio, diagnosis.stiffness_low_ratio,
        diagnosis.stiffness_high_ratio);
    add("pretension", diagnosis.pretension_ratio, diagnosis.pretension_low_ratio,
        diagnosis.pretension_high_ratio);
    return rows;
}

std::size_t likely_effects(const DiagnosisRecord& diagnosis) {
    const auto likely =
        std::count_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                      [](const auto& each) { return each.probability_fraction >= shown_probability; });
    return std::max<std::size_t>(1, static_cast<std::size_t>(likely));
}

std::string where_sentence(const DiagnosisRecord& diagnosis) {
    std::string text = diagnosis.gap_sentence;
    if (diagnosis.component.empty() || diagnosis.component == "none") return text;
    text += fmt::format(" The cause is in the component {}", channel_words(diagnosis.component));
    if (!diagnosis.cable_end.empty()) text += fmt::format(", at the {} end", diagnosis.cable_end);
    if (diagnosis.position_m) text += fmt::format(", about {:.2f} m from the motor", *diagnosis.position_m);
    return text + fmt::format(". Relative to its noise the gap is largest in the {} of run {}.",
                              channel_words(diagnosis.worst_channel), diagnosis.worst_run);
}

reports::AnswerSection verdict_section(const DiagnosisRecord& diagnosis, const Data& values) {
    return {
        .id = "verdict",
        .heading = "The cause",
        .prose =
            "Every known cause is fitted, with the bench's numbers free within their uncertainty. Causes are judged "
            "by what they leave of the gap and by how many numbers they need. Causes that act together share "
            "their probability; \"present at all\" is the probability that a cause is there, whatever else is.",
        .tables = {{"probability",
                    "Probability of each cause",
                    {cause_column("effect"),
                     {"probability", "probability", "", ".2f"},
                     {"present", "present at all", "", ".2f"}},
                    ranked_data(effects_of(diagnosis)),
                    likely_effects(diagnosis)},
                   {"fitted",
                    "Fitted numbers",
                    {cause_column("of"),
                     worded_column("number"),
                     {"value", "value"},
                     {"interval_95", "95% interval", "", ".4g"},
                     {"unit", "unit"}},
                    fitted_data(diagnosis)},
                   {"channels",
                    "RMS of measured minus modelled, over all samples",
                    {worded_column("channel"),
                     {"unit", "unit"},
                     {"noise", "noise", "", ".3g"},
                     {"rms_before", "before", "", ".3g"},
                     {"rms_after", "after", "", ".3g"},
                     {"rms_held_out", "held out", "", ".3g"},
                     {"rms_runner_up", "runner-up", "", ".3g"},
                     {"closed_fraction", "closed", "", ".2f"},
                     {"closed_interval_95", "95% interval", "", ".2f"}},
                    *values.find("channels")}},
        .note =
            "Held out: each run predicted with numbers fitted to the other runs. Runner-up: the best cause that "
            "the verdict does not name. Closed: fraction of the mean square beyond noise that is closed on "
            "held-out runs; a channel without a gap has none."};
}

Table ranking_table(const DiagnosisRecord& diagnosis) {
    Table table{"ranking", "Probability of each cause", {"effect", "probability"}, {}};
    for (const auto& each : diagnosis.effects) {
        if (table.rows.size() < drawn_causes)
            table.rows.push_back({cause_title(each.effect), each.probability_fraction});
    }
    return table;
}

Table map_table(const DiagnosisRecord& diagnosis) {
    Table table{"gap_map",
                "Fraction of the gap's energy by part of the recording",
                {"part", "fraction", "low", "high", "fraction_of_samples"},
                {}};
    for (const auto& each : diagnosis.gap)
        table.rows.push_back({part_name(each.divided_by, each.part), each.energy_fraction, each.low_fraction,
                              each.high_fraction, each.samples_fraction});
    return table;
}

// ---- what only the diagnosis itself knows

std::string next_experiment_sentence(const gap::NonIdentifiable& open) {
    if (open.group.size() < 2) return "";
    std::vector<std::string> group;
    for (const auto& effects : open.group) {
        std::vector<std::string> titles;
        for (const std::string& effect : effects) titles.push_back(cause_title(effect));
        group.push_back(fmt::format("{}", fmt::join(titles, " with ")));
    }
    const std::string text = (open.is_unknown ? "Known effects do not explain all of the gap. Closest come: "
                                              : "This recording cannot distinguish: ") +
                             fmt::format("{}.", fmt::join(group, "; "));
    constexpr double helps = 0.8;
    if (open.experiments.empty() || open.experiments.front().discrimination_probability < helps)
        return text + " None of the experiments that were simulated would distinguish them.";
    const gap::ExperimentScore& best = open.experiments.front();
    const std::string next = text + fmt::format(" Record next: {}. ", best.description);
    if (open.is_unknown)
        return next + "Their predictions differ most there, which shows best how each of them is wrong.";
    return next + fmt::format("It would name the right cause with probability {:.2f}.",
                              best.discrimination_probability);
}

Data open_data(const gap::NonIdentifiable& open) {
    Data data = {{"group", open.group}, {"unknown", open.is_unknown}, {"experiments", Data::list()}};
    for (const gap::ExperimentScore& each : open.experiments)
        data["experiments"].push_back({{"kind", each.kind},
                                       {"name", each.name},
                                       {"description", each.description},
                                       {"discrimination_probability", each.discrimination_probability}});
    return data;
}

reports::AnswerSection next_section(const gap::NonIdentifiable& open, const Data& data) {
    constexpr std::size_t shown = 6;
    Data first = Data::list();
    for (const Data& each : data.find("experiments")->items()) {
        if (first.items().size() < shown) first.push_back(each);
    }
    return {
        .id = "next",
        .heading = "What to record next",
        .prose = next_experiment_sentence(open),
        .tables = {{"experiments",
                    open.is_unknown ? "Probability that the two most similar would be distinguished"
                                    : "Probability that the right cause would be named",
                    {{"description", "experiment"}, {"discrimination_probability", "probability", "", ".2f"}},
                    first}},
        .note =
            "Each experiment is simulated with every explanation as it was fitted; the other explanations may "
            "change all their numbers to match it. " +
            std::string(open.is_unknown ? "0.5 means that no prediction differs."
                                        : "A guess would be right with probability 0.5.")};
}

}  // namespace

std::string cause_words(const std::string& effect, const std::string& variant) {
    const std::string title = cause_title(effect);
    return variant.empty() ? title : title + " (" + channel_words(variant) + ")";
}

std::string drawn_name(const Channel& channel) {
    return channel_words(channel.name) + " [" + channel.unit + "]";
}

reports::Column worded_column(const std::string& path) {
    return {path, path, "", "", [](const std::string& name) { return channel_words(name); }};
}

std::string part_name(const std::string& divided_by, const std::string& part) {
    return divided_by + ": " + (divided_by == "channel" ? channel_words(part) : part);
}

Answer stored_diagnosis_answer(const DiagnosisRecord& diagnosis) {
    Answer answer{.id = "diagnosis",
                  .kind = "Why a bench disagrees with its model",
                  .title = diagnosis.recording,
                  .headline = diagnosis.sentence};
    answer.values = values_of(diagnosis);
    answer.sections = {verdict_section(diagnosis, answer.values),
                       {.id = "where", .heading = "Where the gap is", .prose = where_sentence(diagnosis)}};
    answer.drawn = {ranking_table(diagnosis), map_table(diagnosis)};
    return answer;
}

Answer diagnosis_answer(const Recording& recording, const Diagnosis& diagnosis) {
    Answer answer = stored_diagnosis_answer(diagnosis_record(recording, diagnosis));
    answer.values["non_identifiable"] = open_data(diagnosis.non_identifiable);
    if (diagnosis.non_identifiable.group.size() >= 2)
        answer.sections.insert(answer.sections.begin() + 1,
                               next_section(diagnosis.non_identifiable, answer.values["non_identifiable"]));
    answer.sections.push_back({.id = "runs", .heading = "Measured, nominal, corrected"});
    answer.sections.push_back({.id = "loops", .heading = "Loops"});
    if (!recording.assumptions.empty()) answer.sections.push_back(assumptions_section(recording));
    for (Table& curve : diagnosis_curves(recording, diagnosis)) answer.drawn.push_back(std::move(curve));
    return answer;
}

}  // namespace capstan::answers
