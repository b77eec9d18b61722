#include <fmt/format.h>

#include <algorithm>

#include "capstan/answers/placement_answers.h"

namespace capstan::answers {

namespace {

using reports::Data;

struct Range {
    double low = 1.0;
    double high = 0.0;
    double sum = 0.0;
    int count = 0;

    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
        sum += value;
        ++count;
    }
    double mean() const { return sum / count; }
};

Data range_data(const StudyPlan& plan, const Range& as_stated, const Range& wider, int worlds,
                int exceptions) {
    return {{"name", plan.name},
            {"sets", as_stated.count},
            {"worlds", worlds},
            {"mean", as_stated.mean()},
            {"range", Data::list({as_stated.low, as_stated.high})},
            {"exceptions", exceptions},
            {"wider_mean", wider.mean()},
            {"wider_range", Data::list({wider.low, wider.high})}};
}

}  // namespace

reports::Answer band_answer(const std::vector<ConfigurationBands>& configurations) {
    Data sets = Data::list();
    Data summary = Data::list();
    Range all;
    int exceptions = 0;
    for (const ConfigurationBands& each : configurations) {
        Range as_stated, wider;
        int own_exceptions = 0;
        for (std::size_t k = 0; k < each.bands.size(); ++k) {
            const BandCoverage& band = each.bands[k];
            const bool is_exception = band.as_stated.is_exception();
            sets.push_back({{"name", each.plan.name},
                            {"set", each.sets[k]},
                            {"covered_fraction", band.as_stated.value},
                            {"standard_error", band.as_stated.standard_error},
                            {"exception", is_exception},
                            {"wider_covered_fraction", band.wider.value}});
            as_stated.add(band.as_stated.value);
            wider.add(band.wider.value);
            all.add(band.as_stated.value);
            own_exceptions += is_exception ? 1 : 0;
        }
        exceptions += own_exceptions;
        summary.push_back(range_data(each.plan, as_stated, wider, each.worlds, own_exceptions));
    }
    reports::Answer answer{
        .id = "bands",
        .kind = "Coverage of the 95% bands",
        .title = configurations.size() == 1 ? configurations.front().plan.name
                                            : counted(configurations.size(), "configuration"),
        .headline = fmt::format(
            "the bands of {} hold {:.1f} to {:.1f}% of the true tensions, {:.1f}% in the mean; {} "
            "beyond 93 to 97%.",
            counted(static_cast<std::size_t>(all.count), "set"), 100.0 * all.low, 100.0 * all.high,
            100.0 * all.mean(),
            exceptions == 0   ? "none is"
            : exceptions == 1 ? "one is"
                              : fmt::format("{} are", exceptions))};
    answer.values = {{"sets", sets}, {"configurations", summary}};
    answer.sections = {
        {.id = "configurations",
         .heading = "Configurations",
         .tables = {{"configurations",
                     "",
                     {{"name", "configuration"},
                      {"sets", "sets"},
                      {"worlds", "worlds"},
                      {"mean", "in band", "", ".1%"},
                      {"range", "range of the sets", "", ".1%"},
                      {"exceptions", "beyond 93 to 97%"},
                      {"wider_mean", "twice as uncertain", "", ".1%"},
                      {"wider_range", "range of the sets", "", ".1%"}},
                     summary}},
         .note =
             "In band: the fraction of true tensions, over worlds, time and the length of the cable, that the estimator's 95% "
             "band holds; the worlds are drawn from the uncertainty that the estimator is told. Twice as uncertain: the same "
             "where the worlds are, and the estimator is not told. Beyond 93 to 97%: by more than two standard errors."},
        {.id = "sets",
         .heading = "Sets of sensors",
         .tables = {{"sets",
                     "",
                     {{"name", "configuration"},
                      {"set", "sensors"},
                      {"covered_fraction", "in band", "", ".1%"},
                      {"standard_error", "standard error", "", ".1%"},
                      {"exception", "beyond 93 to 97%"},
                      {"wider_covered_fraction", "twice as uncertain", "", ".1%"}},
                     sets}}}};
    return answer;
}

}  // namespace capstan::answers
