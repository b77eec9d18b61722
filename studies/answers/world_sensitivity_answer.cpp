#include <fmt/format.h>
#include <fmt/ranges.h>

#include "capstan/answers/placement_answers.h"
#include "capstan/config/config_writer.h"

namespace capstan::answers {

namespace {

using reports::Data;
using sensitivity::AdviceWhere;
using sensitivity::VariedNumber;

std::string advised_words(const WorldAnswer& answer) {
    return answer.recommended ? answer.words(answer.best().expected.candidate) : answer.words(0);
}

const Expected& advised(const WorldAnswer& answer) {
    return answer.recommended ? answer.best().expected : answer.no_sensor;
}

Data where_data(const VariedNumber& number, const AdviceWhere& where) {
    const WorldAnswer& here = where.answer;
    return {{"title", number.title},
            {"value", fmt::format("{:.3g}{}{}", where.ratio * number.value, number.unit.empty() ? "" : " ",
                                  number.unit)},
            {"ratio", where.ratio},
            {"set", advised_words(here)},
            {"error_N", advised(here).objective.value_N},
            {"interval_95_N", Data::list({advised(here).objective.low_N, advised(here).objective.high_N})},
            {"no_sensor_error_N", here.no_sensor.objective.value_N},
            {"stated_advice_error_N", where.advised_as_stated.objective.value_N},
            {"loss_N", where.loss.value_N},
            {"loss_interval_N", Data::list({where.loss.low_N, where.loss.high_N})},
            {"beats_no_sensor", here.recommended.has_value()},
            {"advice_changes", where.changes}};
}

std::string headline_of(const sensitivity::WorldSensitivity& found) {
    std::vector<std::string> deciding;
    for (const VariedNumber& number : found.numbers)
        if (number.changes()) deciding.push_back(number.title);
    const std::string stated = fmt::format("the stated numbers advise {}", advised_words(found.stated));
    if (deciding.empty()) return stated + "; no number changes that within its range.";
    return fmt::format("{}; the advice depends on: {}.", stated, fmt::join(deciding, ", "));
}

reports::Table where_table(const sensitivity::WorldSensitivity& found) {
    reports::Table table{"world_sensitivity",
                         "Error along each stated number alone",
                         {"parameter", "ratio", "value", "what", "error_N", "set"},
                         {}};
    for (const VariedNumber& number : found.numbers) {
        for (const AdviceWhere& where : number.where) {
            const double value = where.ratio * number.value;
            const auto add = [&](const char* what, double error_N, const std::string& set) {
                table.rows.push_back({number.title, where.ratio, value, std::string(what), error_N, set});
            };
            add("advised there", advised(where.answer).objective.value_N, advised_words(where.answer));
            add("advised as stated", where.advised_as_stated.objective.value_N, advised_words(found.stated));
            add("no sensor", where.answer.no_sensor.objective.value_N, where.answer.words(0));
        }
    }
    return table;
}

}  // namespace

reports::Answer world_sensitivity_answer(const StudyPlan& plan, const sensitivity::WorldSensitivity& found) {
    Data rows = Data::list();
    for (const VariedNumber& number : found.numbers)
        for (const AdviceWhere& where : number.where) rows.push_back(where_data(number, where));
    reports::Answer answer{.id = "world_sensitivity",
                           .kind = "Sensitivity of the advice",
                           .title = plan.name,
                           .headline = headline_of(found)};
    answer.values = {{"name", plan.name},
                     {"seed", plan.seed},
                     {"worlds", found.stated.worlds},
                     {"objective", name_of(plan.placement.objective)},
                     {"set", advised_words(found.stated)},
                     {"error_N", advised(found.stated).objective.value_N},
                     {"no_sensor_error_N", found.stated.no_sensor.objective.value_N},
                     {"rows", rows}};
    answer.sections = {
        {.id = "scan", .heading = "Each number alone"},
        {.id = "numbers",
         .heading = "Advice by number",
         .tables = {{"rows",
                     "",
                     {{"title", "number"},
                      {"value", "value"},
                      {"set", "advised there"},
                      {"error_N", "error", "N", ".3f"},
                      {"no_sensor_error_N", "no sensor", "N", ".3f"},
                      {"stated_advice_error_N", "advised as stated", "N", ".3f"},
                      {"loss_N", "worse by", "N", ".3f"},
                      {"advice_changes", "advice changes"}},
                     rows}},
         .note = fmt::format(
             "Each number of the configuration is changed alone, for the worlds and for the estimator; {} worlds choose "
             "and as many others judge. Worse by: how much the sensors that the stated numbers advise are worse than the "
             "best set of their price. The advice changes where another price is advised, or where that loss exceeds "
             "{:g} N beyond its 95% interval.",
             found.stated.worlds, plan.placement.resolution_N)}};
    answer.drawn = {where_table(found)};
    answer.config_text = config::config_text(plan, config::Comments::none);
    return answer;
}

}  // namespace capstan::answers
