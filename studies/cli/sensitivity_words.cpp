#include "capstan/cli/sensitivity_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/cli/place_words.h"
#include "capstan/config/config_writer.h"
#include "capstan/estimation/fusion_method.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/sensing/layout.h"

namespace capstan::cli {

namespace {

using nlohmann::ordered_json;
using sensitivity::Advice;
using sensitivity::AdviceThere;
using sensitivity::Flip;
using sensitivity::ParameterSensitivity;

constexpr std::size_t words_width = 100;

std::string words_of(const Advice& advice) {
    return fmt::format("{} {} by {}", advice.nodes.size() == 1 ? "node" : "nodes",
                       nodes_as_people_count(advice.nodes), find_fusion_method(advice.method)->title);
}

std::string value_words(const ParameterSensitivity& parameter, double ratio) {
    return fmt::format("{:.4g}{}{}", ratio * parameter.value, parameter.unit.empty() ? "" : " ",
                       parameter.unit);
}

std::string flip_words(const ParameterSensitivity& parameter, const Flip& flip, const char* side) {
    return fmt::format("{} {} (x {:.3f}): {}, {:.3f} N better", side, value_words(parameter, flip.ratio),
                       flip.ratio, words_of(flip.there.best), flip.there.regret.value_N);
}

std::string flips_words(const ParameterSensitivity& parameter) {
    if (!parameter.flip_below && !parameter.flip_above) return "does not flip within its range";
    std::string text;
    if (parameter.flip_below) text += flip_words(parameter, *parameter.flip_below, "below");
    if (parameter.flip_above)
        text += (text.empty() ? "" : "; ") + flip_words(parameter, *parameter.flip_above, "above");
    return text;
}

std::vector<int> from_one(std::vector<int> nodes) {
    for (int& node : nodes) ++node;
    return nodes;
}

ordered_json advice_json(const Advice& advice) {
    return {{"nodes", from_one(advice.nodes)}, {"method", advice.method}};
}

ordered_json estimate_json(const IntervalEstimate& estimate) {
    return {{"value_N", estimate.value_N}, {"interval_95_N", {estimate.low_N, estimate.high_N}}};
}

ordered_json there_json(const AdviceThere& there) {
    return {{"best", advice_json(there.best)},
            {"best_error", estimate_json(there.best_error)},
            {"regret", estimate_json(there.regret)}};
}

ordered_json flip_json(const ParameterSensitivity& parameter, const std::optional<Flip>& flip) {
    if (!flip) return {};
    ordered_json json = {{"ratio", flip->ratio},
                         {"value", flip->ratio * parameter.value},
                         {"held_at_ratio", flip->held_ratio}};
    json.update(there_json(flip->there));
    return json;
}

ordered_json effects_json(const sensitivity::ElementaryEffects& effects) {
    return {{"mean_N", effects.mean},
            {"mean_absolute_N", effects.mean_absolute},
            {"spread_N", effects.spread},
            {"steps", effects.steps}};
}

ordered_json parameter_json(const ParameterSensitivity& parameter) {
    ordered_json json = {{"name", parameter.name},
                         {"unit", parameter.unit},
                         {"value", parameter.value},
                         {"range_ratio", parameter.range},
                         {"effect_on_regret", effects_json(parameter.on_regret)},
                         {"effect_on_error", effects_json(parameter.on_error)},
                         {"flips_below", flip_json(parameter, parameter.flip_below)},
                         {"flips_above", flip_json(parameter, parameter.flip_above)}};
    json["scan"] = ordered_json::array();
    for (const auto& point : parameter.scan) {
        ordered_json entry = {{"ratio", point.ratio}, {"value", point.ratio * parameter.value}};
        if (point.there) entry.update(there_json(*point.there));
        json["scan"].push_back(std::move(entry));
    }
    return json;
}

std::string where_words(const StudyPlan& plan) {
    const std::string& regime = plan.sensitivity.regime;
    return regime == "duty_cycle" ? "over the duty cycle" : "in the regime " + regime;
}

std::string advice_sentence(const StudyPlan& plan, const sensitivity::SensitivityAnswer& answer) {
    return fmt::format("Advice for {} {} {}, sensor noise {}: {}, {:.3f} N ({:.3f} to {:.3f} N at 95%).",
                       plan.sensitivity.sensors, plan.sensitivity.sensors == 1 ? "sensor" : "sensors",
                       where_words(plan), answer.noise, words_of(answer.advice), answer.error.value_N,
                       answer.error.low_N, answer.error.high_N);
}

std::string screening_sentence(const StudyPlan& plan, const sensitivity::SensitivityAnswer& answer) {
    std::string text = fmt::format(
        "All parameters at once: in {} of {} sets of parameters another layout is better by more than {:g} N, at "
        "worst by {:.3f} N.",
        answer.changed, answer.screened, plan.sensitivity.tolerance_N, answer.largest_regret_N);
    if (answer.never > 0) text += fmt::format(" In {} more the motion is never in the regime.", answer.never);
    return text;
}

}  // namespace

std::string in_words(const StudyPlan& plan, const sensitivity::SensitivityAnswer& answer) {
    std::string text = fmt::format("{}: what would change the advice\n\n", plan.name);
    text += wrapped(advice_sentence(plan, answer), words_width, "", "") + "\n\n";
    text += wrapped(screening_sentence(plan, answer), words_width, "", "") + "\n\n";
    text += fmt::format("  {:<24} {:>9}  {:>20}  {:>15}  {:>15}\n", "parameter", "value", "range",
                        "regret mu* (s)", "error mu* (s)");
    for (const ParameterSensitivity& parameter : answer.parameters) {
        text += fmt::format(
            "  {:<24} {:>9}  {:>20}  {:>15}  {:>15}\n", parameter.title, value_words(parameter, 1.0),
            fmt::format("{:.4g} to {}", parameter.range[0] * parameter.value,
                        value_words(parameter, parameter.range[1])),
            fmt::format("{:.3f} ({:.3f})", parameter.on_regret.mean_absolute, parameter.on_regret.spread),
            fmt::format("{:.3f} ({:.3f})", parameter.on_error.mean_absolute, parameter.on_error.spread));
    }
    text += "\nOne parameter alone, the others as configured; the advice flips\n";
    for (const ParameterSensitivity& parameter : answer.parameters) {
        text += wrapped(parameter.title + ": " + flips_words(parameter) + ".", words_width, "  * ", "    ") +
                "\n";
    }
    text += "\n" +
            wrapped(fmt::format(
                        "regret: how much worse the advice is than the best layout there, in newtons, on "
                        "draws that did not choose it. mu*: mean size of what moving through the whole range "
                        "does (Morris), from {} walks; s: its spread, large where it depends on the other "
                        "parameters. The advice flips where the regret exceeds {:g} N.",
                        plan.sensitivity.trajectories, plan.sensitivity.tolerance_N),
                    words_width, "", "") +
            "\n";
    return text;
}

ordered_json in_json(const StudyPlan& plan, const sensitivity::SensitivityAnswer& answer) {
    ordered_json json = {{"name", plan.name},
                         {"seed", plan.seed},
                         {"noise", answer.noise},
                         {"objective", name_of(plan.placement.objective)},
                         {"sensor_count", plan.sensitivity.sensors},
                         {"regime", plan.sensitivity.regime},
                         {"tolerance_N", plan.sensitivity.tolerance_N},
                         {"repetitions", plan.sensitivity.repetitions},
                         {"advice", advice_json(answer.advice)},
                         {"error", estimate_json(answer.error)},
                         {"screened", answer.screened},
                         {"changed", answer.changed},
                         {"never_in_regime", answer.never},
                         {"largest_regret_N", answer.largest_regret_N},
                         {"evaluations", answer.evaluations}};
    json["parameters"] = ordered_json::array();
    for (const ParameterSensitivity& parameter : answer.parameters)
        json["parameters"].push_back(parameter_json(parameter));
    return json;
}

reports::ExperimentPage sensitivity_page(const StudyPlan& plan,
                                         const sensitivity::SensitivityAnswer& answer) {
    reports::Table scan{"sensitivity_scan",
                        "Regret of the advice along each parameter alone",
                        {"parameter", "ratio", "value", "regret_N", "interval_low_N", "interval_high_N",
                         "best_nodes", "method_title"},
                        {}};
    reports::NumberTable numbers{
        "Parameters", {"Parameter", "Value", "Range", "mu* on regret [N]", "mu* on error [N]", "Flips"}, {}};
    for (const ParameterSensitivity& parameter : answer.parameters) {
        for (const auto& point : parameter.scan) {
            if (!point.there) continue;
            const IntervalEstimate& regret = point.there->regret;
            scan.rows.push_back({parameter.title, point.ratio, value_words(parameter, point.ratio),
                                 regret.value_N, regret.low_N, regret.high_N,
                                 nodes_as_people_count(point.there->best.nodes),
                                 std::string(find_fusion_method(point.there->best.method)->title)});
        }
        numbers.rows.push_back({parameter.title, value_words(parameter, 1.0),
                                fmt::format("{:.4g} to {}", parameter.range[0] * parameter.value,
                                            value_words(parameter, parameter.range[1])),
                                fmt::format("{:.3f}", parameter.on_regret.mean_absolute),
                                fmt::format("{:.3f}", parameter.on_error.mean_absolute),
                                flips_words(parameter)});
    }
    reports::ExperimentPage page;
    page.id = "sensitivity";
    page.kind = "What would change the advice";
    page.title = plan.name;
    page.verdict = advice_sentence(plan, answer);
    page.sections = {{"scan", "One parameter alone", screening_sentence(plan, answer), {}, ""},
                     {"numbers", "In numbers", "", {numbers}, ""}};
    page.tables = {scan};
    page.config_text = config::config_text(plan, config::Comments::none);
    return page;
}

}  // namespace capstan::cli
