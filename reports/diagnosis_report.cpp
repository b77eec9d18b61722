#include "capstan/reports/diagnosis_report.h"

#include <fmt/format.h>

#include "capstan/reports/plain_tables.h"

namespace capstan::reports {
namespace {

using nlohmann::ordered_json;
using storage::DiagnosisCauseRecord;
using storage::DiagnosisChannelRecord;
using storage::DiagnosisRecord;

constexpr std::size_t shown_causes = 8;

Table ranking_table(const DiagnosisRecord& diagnosis) {
    Table table{"ranking", "Probability of each cause", {"effect", "probability"}, {}};
    for (const auto& each : diagnosis.effects) {
        if (table.rows.size() < shown_causes) table.rows.push_back({each.effect, each.probability_fraction});
    }
    return table;
}

Table map_table(const DiagnosisRecord& diagnosis) {
    Table table{"gap_map",
                "Fraction of the gap's energy by part of the recording",
                {"part", "fraction", "low", "high", "fraction_of_samples"},
                {}};
    for (const auto& each : diagnosis.gap)
        table.rows.push_back({each.divided_by + ": " + each.part, each.energy_fraction, each.low_fraction,
                              each.high_fraction, each.samples_fraction});
    return table;
}

std::string name_of(const DiagnosisCauseRecord& cause) {
    return cause.effect + (cause.variant.empty() ? "" : ", " + cause.variant);
}

NumberTable fitted_numbers(const DiagnosisRecord& diagnosis) {
    NumberTable table{"What was fitted", {"Of", "Number", "Value", "Unit"}, {}};
    for (const DiagnosisCauseRecord& cause : diagnosis.causes) {
        for (const auto& number : cause.numbers)
            table.rows.push_back(
                {name_of(cause), number.name, fmt::format("{:.4g}", number.value_in_unit), number.unit});
    }
    const auto add = [&](const char* name, double ratio) {
        table.rows.push_back({"nominal model", name, fmt::format("{:.4f}", ratio), "of the stated value"});
    };
    add("friction", diagnosis.friction_ratio);
    add("stiffness", diagnosis.stiffness_ratio);
    add("pretension", diagnosis.pretension_ratio);
    return table;
}

NumberTable shrinkage_numbers(const DiagnosisRecord& diagnosis) {
    NumberTable table{
        "RMS of measured minus modelled, over complete runs",
        {"Channel", "Unit", "Noise", "Before", "After", "Held out", "Runner-up", "Fraction closed, held out"},
        {}};
    const auto number = [](double value) { return fmt::format("{:.3g}", value); };
    for (const DiagnosisChannelRecord& each : diagnosis.channels) {
        table.rows.push_back({each.channel, each.unit, number(each.noise_in_unit),
                              number(each.rms_before_in_unit), number(each.rms_after_in_unit),
                              number(each.rms_held_out_in_unit), number(each.rms_runner_up_in_unit),
                              each.closed_fraction && each.closed_low_fraction && each.closed_high_fraction
                                  ? fmt::format("{:.2f} ({:.2f} to {:.2f})", *each.closed_fraction,
                                                *each.closed_low_fraction, *each.closed_high_fraction)
                                  : "no gap"});
    }
    return table;
}

NumberTable numbers_of(const Table& table, const std::vector<std::string>& heads) {
    NumberTable numbers{table.meaning, heads, {}};
    for (const auto& row : table.rows) {
        auto& line = numbers.rows.emplace_back();
        for (const Value& value : row) {
            const auto* fraction = std::get_if<double>(&value);
            line.push_back(fraction != nullptr ? fmt::format("{:.2f}", *fraction)
                                               : std::get<std::string>(value));
        }
    }
    return numbers;
}

// The torque of the load, or the first channel if it was not measured.
const DiagnosisChannelRecord* judged_channel(const DiagnosisRecord& diagnosis) {
    for (const DiagnosisChannelRecord& each : diagnosis.channels) {
        if (each.channel == "load_torque") return &each;
    }
    return diagnosis.channels.empty() ? nullptr : &diagnosis.channels.front();
}

ordered_json text_or_null(const std::string& text) {
    return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

ordered_json number_or_null(const std::optional<double>& number) {
    return number ? ordered_json(*number) : ordered_json(nullptr);
}

ordered_json cause_json(const DiagnosisCauseRecord& cause) {
    ordered_json numbers = ordered_json::object();
    for (const auto& number : cause.numbers)
        numbers[number.name] = {{"value", number.value_in_unit}, {"unit", number.unit}};
    return {{"effect", cause.effect},
            {"variant", text_or_null(cause.variant)},
            {"component", cause.component},
            {"numbers", numbers}};
}

ordered_json channel_json(const DiagnosisChannelRecord& channel) {
    return {{"channel", channel.channel},
            {"unit", channel.unit},
            {"noise", channel.noise_in_unit},
            {"rms_before", channel.rms_before_in_unit},
            {"rms_after", channel.rms_after_in_unit},
            {"rms_held_out", channel.rms_held_out_in_unit},
            {"rms_runner_up", channel.rms_runner_up_in_unit},
            {"closed_fraction", number_or_null(channel.closed_fraction)},
            {"closed_low", number_or_null(channel.closed_low_fraction)},
            {"closed_high", number_or_null(channel.closed_high_fraction)}};
}

ordered_json candidates_json(const DiagnosisRecord& diagnosis) {
    ordered_json list = ordered_json::array();
    for (const auto& each : diagnosis.candidates)
        list.push_back({{"effects", ordered_json::parse(each.effects)},
                        {"variants", ordered_json::parse(each.variants)},
                        {"open_numbers", each.open_numbers},
                        {"misfit", each.misfit_ratio},
                        {"nominal_penalty", each.nominal_penalty_log},
                        {"visibility", ordered_json::parse(each.visibility_ratios)},
                        {"evidence", each.evidence_log}});
    return list;
}

}  // namespace

ExperimentPage diagnosis_page(const DiagnosisRecord& diagnosis) {
    ExperimentPage page;
    page.id = "diagnosis";
    page.kind = "Why a bench disagrees with its model";
    page.title = diagnosis.recording;
    page.verdict = diagnosis.sentence;
    page.sections = {
        {"verdict",
         "The cause",
         "Every cause that is known is fitted with the nominal numbers free within their "
         "uncertainty; what it leaves is weighed against how many numbers it needed.",
         {fitted_numbers(diagnosis), shrinkage_numbers(diagnosis)},
         "Held out: each run predicted with numbers fitted to the others. Runner-up: the best cause that the verdict "
         "does not name. Fraction closed: of the mean square beyond noise, with its 95% interval."},
        {"where", "Where it lies", diagnosis.gap_sentence, {}, ""}};
    page.tables = {ranking_table(diagnosis), map_table(diagnosis)};
    page.program_version = diagnosis.program_version;
    return page;
}

std::string diagnosis_html(const DiagnosisRecord& diagnosis) {
    return experiment_page_html(diagnosis_page(diagnosis));
}

std::string diagnosis_markdown(const DiagnosisRecord& diagnosis) {
    std::string text = fmt::format("# {}\n\n{}\n", escape_markdown(diagnosis.recording),
                                   escape_markdown(diagnosis.sentence));
    text += markdown_of(numbers_of(ranking_table(diagnosis), {"Cause", "Probability"}));
    text += markdown_of(fitted_numbers(diagnosis)) + markdown_of(shrinkage_numbers(diagnosis));
    text += markdown_of(
        numbers_of(map_table(diagnosis), {"Part", "Fraction", "95% low", "95% high", "Of the samples"}));
    return text + fmt::format("\n{}\n\nMade by capstan {} from runs {}.\n",
                              escape_markdown(diagnosis.gap_sentence), diagnosis.program_version,
                              escape_markdown(diagnosis.runs));
}

std::string diagnosis_csv(const DiagnosisRecord& diagnosis) {
    Table table{"diagnosis", "", {"part", "name", "quantity", "value", "unit"}, {}};
    const auto add = [&](const char* part, const std::string& name, const std::string& quantity, double value,
                         const std::string& unit) {
        table.rows.push_back({std::string(part), name, quantity, value, unit});
    };
    for (const auto& each : diagnosis.effects)
        add("effect", each.effect, "probability", each.probability_fraction, "");
    for (const DiagnosisCauseRecord& cause : diagnosis.causes) {
        if (cause.position_m) add("cause", name_of(cause), "position", *cause.position_m, "m");
        for (const auto& number : cause.numbers)
            add("cause", name_of(cause), number.name, number.value_in_unit, number.unit);
    }
    add("nominal", "friction", "of the stated value", diagnosis.friction_ratio, "");
    add("nominal", "stiffness", "of the stated value", diagnosis.stiffness_ratio, "");
    add("nominal", "pretension", "of the stated value", diagnosis.pretension_ratio, "");
    for (const DiagnosisChannelRecord& each : diagnosis.channels) {
        const auto of_channel = [&](const char* quantity, double value) {
            add("channel", each.channel, quantity, value, each.unit);
        };
        of_channel("noise", each.noise_in_unit);
        of_channel("rms_before", each.rms_before_in_unit);
        of_channel("rms_after", each.rms_after_in_unit);
        of_channel("rms_held_out", each.rms_held_out_in_unit);
        of_channel("rms_runner_up", each.rms_runner_up_in_unit);
        if (each.closed_fraction) add("channel", each.channel, "closed_fraction", *each.closed_fraction, "");
    }
    for (const auto& each : diagnosis.gap) {
        const std::string part = each.divided_by + ": " + each.part;
        add("gap", part, "energy_fraction", each.energy_fraction, "");
        add("gap", part, "low_fraction", each.low_fraction, "");
        add("gap", part, "high_fraction", each.high_fraction, "");
        add("gap", part, "samples_fraction", each.samples_fraction, "");
    }
    return csv_text(table.columns, table.rows);
}

ordered_json diagnosis_json(const DiagnosisRecord& diagnosis) {
    ordered_json json = {{"case", diagnosis.recording}, {"ranked", ordered_json::array()}};
    for (const auto& each : diagnosis.effects)
        json["ranked"].push_back({{"effect", each.effect}, {"probability", each.probability_fraction}});
    json["where"] = {{"component", text_or_null(diagnosis.component)},
                     {"end", text_or_null(diagnosis.cable_end)},
                     {"s_m", number_or_null(diagnosis.position_m)},
                     {"worst_run", diagnosis.worst_run},
                     {"worst_channel", diagnosis.worst_channel}};
    if (const DiagnosisChannelRecord* channel = judged_channel(diagnosis)) {
        json["channel"] = channel->channel;
        json["rms_before"] = channel->rms_before_in_unit;
        json["rms_after"] = channel->rms_after_in_unit;
        json["unit"] = channel->unit;
    }
    json["causes"] = ordered_json::array();
    for (const DiagnosisCauseRecord& cause : diagnosis.causes) json["causes"].push_back(cause_json(cause));
    json["nominal_ratios"] = {{"friction", diagnosis.friction_ratio},
                              {"stiffness", diagnosis.stiffness_ratio},
                              {"pretension", diagnosis.pretension_ratio}};
    json["misfit"] = {{"before", diagnosis.misfit_before_ratio}, {"after", diagnosis.misfit_after_ratio}};
    json["independent_samples"] = diagnosis.independent_samples_count;
    json["candidates"] = candidates_json(diagnosis);
    json["channels"] = ordered_json::array();
    for (const auto& channel : diagnosis.channels) json["channels"].push_back(channel_json(channel));
    json["gap_map"] = ordered_json::array();
    for (const auto& each : diagnosis.gap)
        json["gap_map"].push_back({{"by", each.divided_by},
                                   {"name", each.part},
                                   {"fraction", each.energy_fraction},
                                   {"low", each.low_fraction},
                                   {"high", each.high_fraction},
                                   {"fraction_of_samples", each.samples_fraction}});
    json["gap_in_words"] = diagnosis.gap_sentence;
    return json;
}

}  // namespace capstan::reports
