#include "capstan/sensitivity/world_sensitivity.h"

#include <algorithm>
#include <cmath>

#include "capstan/sensitivity/uncertain_parameter.h"
#include "capstan/worlds/choice.h"

namespace capstan::sensitivity {

namespace {

// A number of the configuration, and how to change it.
struct StatedNumber {
    std::string name;
    std::string title;
    std::string unit;
    std::vector<double> SensitivityPlan::*range;
    double (*value)(const StudyPlan&);
    void (*scale)(StudyPlan&, double ratio);
};

double far_end_range_m(const StudyPlan& plan) {
    const double stated_m = plan.uncertainty.far_end_range_m;
    return stated_m > 0.0 ? stated_m : std::abs(plan.motion.distal.amplitude);
}

template <double Uncertainty::*fraction>
StatedNumber width(std::string name, std::string title) {
    return {std::move(name),
            std::move(title),
            "",
            &SensitivityPlan::uncertainty_ratio,
            [](const StudyPlan& plan) { return plan.uncertainty.*fraction; },
            [](StudyPlan& plan, double ratio) { plan.uncertainty.*fraction *= ratio; }};
}

std::vector<StatedNumber> stated_numbers() {
    return {
        {"far_end_range", "range of the far end", "m", &SensitivityPlan::far_end_range_ratio, far_end_range_m,
         [](StudyPlan& plan, double ratio) {
             plan.uncertainty.far_end_range_m = ratio * far_end_range_m(plan);
         }},
        {"far_end_bandwidth", "bandwidth of the far end", "Hz", &SensitivityPlan::far_end_bandwidth_ratio,
         [](const StudyPlan& plan) { return plan.uncertainty.far_end_bandwidth_Hz; },
         [](StudyPlan& plan, double ratio) { plan.uncertainty.far_end_bandwidth_Hz *= ratio; }},
        width<&Uncertainty::friction_fraction>("friction_fraction", "uncertainty of friction"),
        width<&Uncertainty::wrap_fraction>("wrap_fraction", "uncertainty of the bends"),
        width<&Uncertainty::stiffness_fraction>("stiffness_fraction", "uncertainty of stiffness"),
        width<&Uncertainty::pretension_fraction>("pretension_fraction", "uncertainty of pretension"),
    };
}

std::vector<double> ratios_of(const std::vector<double>& range, int values) {
    std::vector<double> ratios;
    for (int k = 0; k < values; ++k) {
        const double at = values == 1 ? 1.0 : k / (values - 1.0);
        ratios.push_back(range[0] * std::pow(range[1] / range[0], at));
    }
    return ratios;
}

// The advice alone, from fewer worlds than the study itself takes.
WorldAnswer advice_of(ErrorTable& table) {
    Choice choice(table);
    return choose_of_each_price(choice);
}

AdviceWhere advice_where(const StudyPlan& plan, double ratio, const WorldAnswer& stated,
                         const TableOptions& options) {
    ErrorTable table(plan, options);
    AdviceWhere where;
    where.ratio = ratio;
    where.answer = advice_of(table);
    const int advised =
        stated.recommended ? table.candidate_of(stated.set(stated.best().expected.candidate).sensors) : 0;
    Choice choice(table);
    const int first = choice.worlds();
    choice.fill(Condition::as_stated, std::vector{advised}, first, 2 * first, "the stated advice");
    where.advised_as_stated = choice.expected(advised);
    const double price = table.candidates()[static_cast<std::size_t>(advised)].price;
    for (const PriceBest& best : where.answer.prices) {
        if (std::abs(best.price - price) > 1e-9 * price || best.expected.candidate == advised) continue;
        where.loss = choice.paired(Condition::as_stated, advised, Condition::as_stated,
                                   best.expected.candidate, first, 2 * first);
    }
    const double price_here = where.answer.recommended ? where.answer.best().price : 0.0;
    where.changes = std::abs(price_here - price) > 1e-9 * price ||
                    (where.loss.low_N > 0.0 && where.loss.value_N > choice.resolution_N());
    return where;
}

}  // namespace

bool VariedNumber::changes() const {
    return std::any_of(where.begin(), where.end(), [](const AdviceWhere& each) { return each.changes; });
}

WorldSensitivity vary_worlds(const StudyPlan& plan, const TableOptions& options) {
    if (const auto problems = problems_of(plan); !problems.empty()) throw InvalidInput(problems);
    StudyPlan short_plan = plan;
    short_plan.repetitions = std::min(plan.repetitions, plan.sensitivity.repetitions);
    ErrorTable table(short_plan, options);
    WorldSensitivity result{advice_of(table), {}};
    const auto vary = [&](VariedNumber number, const std::vector<double>& range, const auto& scale) {
        if (!(number.value > 0.0) || range[0] == range[1]) return;
        for (const double ratio : ratios_of(range, plan.sensitivity.values)) {
            StudyPlan varied = short_plan;
            scale(varied, ratio);
            place_nodes(varied);
            number.where.push_back(advice_where(varied, ratio, result.stated, options));
        }
        result.numbers.push_back(std::move(number));
    };
    for (const StatedNumber& each : stated_numbers())
        vary({each.name, each.title, each.unit, each.value(plan), {}}, plan.sensitivity.*each.range,
             each.scale);
    for (const UncertainParameter& each : uncertain_parameters())
        vary({each.name, each.title, each.unit, each.value(plan, 0), {}}, each.range(plan.sensitivity),
             [&](StudyPlan& varied, double ratio) { each.scale(varied, 0, ratio); });
    return result;
}

}  // namespace capstan::sensitivity
