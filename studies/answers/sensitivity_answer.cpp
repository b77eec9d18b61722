#include <fmt/format.h>

#include "capstan/answers/placement_answers.h"
#include "capstan/config/config_writer.h"
#include "capstan/sensing/layout.h"

namespace capstan::answers {

namespace {

using reports::Data;
using sensitivity::Advice;
using sensitivity::AdviceThere;
using sensitivity::Flip;
using sensitivity::ParameterSensitivity;

std::string words_of(const Advice& advice) {
    return fmt::format("{} {} by {}", advice.nodes.size() == 1 ? "node" : "nodes",
                       nodes_as_people_count(advice.nodes), title_of_method(advice.method));
}

std::string value_words(const ParameterSensitivity& parameter, double ratio) {
    return fmt::format("{:.4g}{}{}", ratio * parameter.value, parameter.unit.empty() ? "" : " ",
                       parameter.unit);
}

std::string flips_words(const ParameterSensitivity& parameter) {
    if (!parameter.flip_below && !parameter.flip_above) return "not within its range";
    std::string text;
    const auto add = [&](const std::optional<Flip>& flip, const char* side) {
        if (!flip) return;
        text += fmt::format("{}{} {} (x {:.3f}): {}, {:.3f} N better", text.empty() ? "" : "; ", side,
                            value_words(parameter, flip->ratio), flip->ratio, words_of(flip->there.best),
                            flip->there.regret.value_N);
    };
    add(parameter.flip_below, "below");
    add(parameter.flip_above, "above");
    return text;
}

Data advice_data(const Advice& advice) {
    return {{"nodes", from_one(advice.nodes)}, {"method", advice.method}};
}

Data there_data(const AdviceThere& there) {
    return {{"best", advice_data(there.best)},
            {"best_error", estimate_data(there.best_error)},
            {"regret", estimate_data(there.regret)}};
}

Data flip_data(const ParameterSensitivity& parameter, const std::optional<Flip>& flip) {
    if (!flip) return {};
    Data data = {{"ratio", flip->ratio},
                 {"value", flip->ratio * parameter.value},
                 {"held_at_ratio", flip->held_ratio}};
    data.update(there_data(flip->there));
    return data;
}

Data effects_data(const sensitivity::ElementaryEffects& effects) {
    return {{"mean_N", effects.mean},
            {"mean_absolute_N", effects.mean_absolute},
            {"spread_N", effects.spread},
            {"steps", effects.steps}};
}

Data parameter_data(const ParameterSensitivity& parameter) {
    Data data = {
        {"name", parameter.name},
        {"title", parameter.title},
        {"unit", parameter.unit},
        {"value", parameter.value},
        {"range_ratio", Data::list({parameter.range[0], parameter.range[1]})},
        {"range", Data::list({parameter.range[0] * parameter.value, parameter.range[1] * parameter.value})},
        {"effect_on_regret", effects_data(parameter.on_regret)},
        {"effect_on_error", effects_data(parameter.on_error)},
        {"flips", flips_words(parameter)},
        {"flips_below", flip_data(parameter, parameter.flip_below)},
        {"flips_above", flip_data(parameter, parameter.flip_above)},
        {"scan", Data::list()}};
    for (const auto& point : parameter.scan) {
        Data entry = {{"ratio", point.ratio}, {"value", point.ratio * parameter.value}};
        if (point.there) entry.update(there_data(*point.there));
        data["scan"].push_back(std::move(entry));
    }
    return data;
}

std::string headline_of(const StudyPlan& plan, const sensitivity::SensitivityAnswer& found) {
    const std::string& regime = plan.sensitivity.regime;
    return fmt::format(
        "the advice for {} {}, sensor noise {}, is {}, with an error of {:.3f} N (95% interval "
        "{:.3f} to {:.3f} N).",
        counted(static_cast<std::size_t>(plan.sensitivity.sensors), "sensor"),
        regime == "duty_cycle" ? "over the duty cycle" : "in the regime " + regime, found.noise,
        words_of(found.advice), found.error.value_N, found.error.low_N, found.error.high_N);
}

std::string screening_sentence(const StudyPlan& plan, const sensitivity::SensitivityAnswer& found) {
    std::string text = fmt::format(
        "All parameters varied at once: in {} of {} sets of parameters another layout is better by more than {:g} "
        "N, at worst by {:.3f} N.",
        found.changed, found.screened, plan.sensitivity.tolerance_N, found.largest_regret_N);
    if (found.never > 0)
        text += fmt::format(" In {} further sets the motion is never in the regime.", found.never);
    return text;
}

reports::Table scan_table(const sensitivity::SensitivityAnswer& found) {
    reports::Table scan{"sensitivity_scan",
                        "Regret of the advice along each parameter alone",
                        {"parameter", "ratio", "value", "regret_N", "interval_low_N", "interval_high_N",
                         "best_nodes", "method_title"},
                        {}};
    for (const ParameterSensitivity& parameter : found.parameters) {
        for (const auto& point : parameter.scan) {
            if (!point.there) continue;
            const IntervalEstimate& regret = point.there->regret;
            scan.rows.push_back({parameter.title, point.ratio, value_words(parameter, point.ratio),
                                 regret.value_N, regret.low_N, regret.high_N,
                                 nodes_as_people_count(point.there->best.nodes),
                                 title_of_method(point.there->best.method)});
        }
    }
    return scan;
}

}  // namespace

reports::Answer sensitivity_answer(const StudyPlan& plan, const sensitivity::SensitivityAnswer& found) {
    reports::Answer answer{.id = "sensitivity",
                           .kind = "Sensitivity of the advice",
                           .title = plan.name,
                           .headline = headline_of(plan, found)};
    answer.values = {{"name", plan.name},
                     {"seed", plan.seed},
                     {"noise", found.noise},
                     {"objective", name_of(plan.placement.objective)},
                     {"sensor_count", plan.sensitivity.sensors},
                     {"regime", plan.sensitivity.regime},
                     {"tolerance_N", plan.sensitivity.tolerance_N},
                     {"repetitions", plan.sensitivity.repetitions},
                     {"advice", advice_data(found.advice)},
                     {"error", estimate_data(found.error)},
                     {"screened", found.screened},
                     {"changed", found.changed},
                     {"never_in_regime", found.never},
                     {"largest_regret_N", found.largest_regret_N},
                     {"evaluations", found.evaluations},
                     {"parameters", Data::list()}};
    for (const ParameterSensitivity& parameter : found.parameters)
        answer.values["parameters"].push_back(parameter_data(parameter));
    answer.sections = {
        {.id = "scan", .heading = "Each parameter alone", .prose = screening_sentence(plan, found)},
        {.id = "numbers",
         .heading = "Parameters",
         .tables = {{"parameters",
                     "",
                     {{"title", "parameter"},
                      {"value", "value"},
                      {"unit", "unit"},
                      {"range", "range"},
                      {"effect_on_regret.mean_absolute_N", "regret mu*", "N", ".3f"},
                      {"effect_on_regret.spread_N", "spread", "N", ".3f"},
                      {"effect_on_error.mean_absolute_N", "error mu*", "N", ".3f"},
                      {"effect_on_error.spread_N", "spread", "N", ".3f"},
                      {"flips", "the advice changes"}},
                     answer.values["parameters"]}},
         .note = fmt::format(
             "Regret: how much larger the error of the advice is than that of the best layout with these "
             "parameters, on independent draws. mu*: mean absolute change when a parameter moves through its range "
             "(Morris), from {} trajectories; a large spread means that it depends on the other parameters. The "
             "advice changes where the regret exceeds {:g} N with this parameter alone varied.",
             plan.sensitivity.trajectories, plan.sensitivity.tolerance_N)}};
    answer.drawn = {scan_table(found)};
    answer.config_text = config::config_text(plan, config::Comments::none);
    return answer;
}

}  // namespace capstan::answers
