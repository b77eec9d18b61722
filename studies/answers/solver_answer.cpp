#include <fmt/format.h>

#include <algorithm>

#include "capstan/answers/paper_answers.h"

namespace capstan::answers {

namespace {

using paper::Agreement;
using reports::Data;
using reports::Table;

constexpr double papers_rate_Hz = 1000.0;
constexpr std::int64_t papers_segments = 40;  // of its linear solver at that rate

Table rate_table(const std::vector<RatesOfCable>& cables) {
    Table table{"solver_rate", "Steps per second, measured", {"solver", "segments", "steps_per_s"}, {}};
    for (const RatesOfCable& cable : cables) {
        for (const paper::SolverRate& rate : cable.rates) {
            if (rate.steps_per_s)
                table.rows.push_back({rate.title, std::int64_t{cable.segments}, *rate.steps_per_s});
        }
    }
    return table;
}

Table agreement_table(const std::vector<Agreement>& agreements) {
    Table table{"agreement",
                "Closed form against the generic solver, step by step",
                {"motion", "segments", "steps", "converged", "largest_difference_N"},
                {}};
    for (const Agreement& row : agreements) {
        table.rows.push_back({name_of(row.motion), std::int64_t{row.segments}, std::int64_t{row.steps},
                              std::int64_t{row.converged}, row.largest_difference_N});
    }
    return table;
}

// One row for each cable, the rate of each solver under its name.
Data rates_of_cables(const std::vector<RatesOfCable>& cables) {
    Data rows = Data::list();
    for (const RatesOfCable& cable : cables) {
        Data row = {{"segments", cable.segments}};
        for (const paper::SolverRate& rate : cable.rates) row[rate.name] = Data(rate.steps_per_s);
        row["ratio"] = Data(cable.rates.back().closed_form_is_faster_by);
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<reports::Column> rate_columns(const std::vector<RatesOfCable>& cables) {
    std::vector<reports::Column> columns = {{"segments", "segments"}};
    if (!cables.empty()) {
        for (const paper::SolverRate& rate : cables.front().rates)
            columns.push_back({rate.name, rate.title, "1/s", ".3g"});
    }
    columns.push_back({"ratio", "closed form / generic", "", ".3g"});
    return columns;
}

double largest_difference_N(const std::vector<Agreement>& agreements) {
    double largest_N = 0.0;
    for (const Agreement& row : agreements) largest_N = std::max(largest_N, row.largest_difference_N);
    return largest_N;
}

}  // namespace

reports::Answer solver_answer(const std::vector<Agreement>& agreements,
                              const std::vector<RatesOfCable>& rates) {
    reports::Answer answer{
        .id = "solver",
        .kind = "The paper's Sec. III.B",
        .title = "The closed-form step and other solvers",
        .headline = fmt::format(
            "the closed form agrees with a generic root finder to {:.0e} N (paper: below 1e-9 N).",
            largest_difference_N(agreements))};
    answer.values = {{"agreement", Data::list()}, {"rates", Data::list()}};
    for (const Agreement& row : agreements) {
        answer.values["agreement"].push_back(
            {{"motion", name_of(row.motion)},
             {"segments", row.segments},
             {"steps", row.steps},
             {"converged", row.converged},
             {"converged_fraction", static_cast<double>(row.converged) / row.steps},
             {"largest_difference_N", row.largest_difference_N}});
    }
    for (const RatesOfCable& cable : rates) {
        for (const paper::SolverRate& rate : cable.rates)
            answer.values["rates"].push_back({{"segments", cable.segments},
                                              {"solver", rate.name},
                                              {"steps_per_s", Data(rate.steps_per_s)}});
    }
    answer.sections = {
        {.id = "agreement",
         .heading = "Agreement",
         .prose =
             "Both solvers start from the same state, step by step, in mass, partial, mono- and bidirectional "
             "motion. Steps in which the generic solver does not converge do not count in the difference. "
             "Paper: below 1e-9 N in all conditions.",
         .tables = {{"agreement",
                     "",
                     {{"motion", "motion"},
                      {"segments", "segments"},
                      {"steps", "steps"},
                      {"converged_fraction", "converged", "", ".1%"},
                      {"largest_difference_N", "difference", "N", ".1e"}},
                     answer.values["agreement"]}}},
        {.id = "rates",
         .heading = "Steps per second against the number of segments (the paper's Fig. 7)",
         .prose = "One cable of Table I at 40 N, its far end on a spring of 40 N/m, driven 0.15 cm at 1 kHz.",
         .tables = {{"rates", "", rate_columns(rates), rates_of_cables(rates)}},
         .note =
             "The paper's linear-assumed solver is over two orders of magnitude faster than MATLAB's fsolve and "
             "takes 40 segments at 1 kHz. Here every solver is compiled, so that the generic one has no "
             "interpreter to carry."}};
    answer.drawn = {rate_table(rates), agreement_table(agreements),
                    Table{"control_rate",
                          "The rate of a control loop, and the paper's solver there",
                          {"segments", "steps_per_s", "label"},
                          {{papers_segments, papers_rate_Hz, std::string("paper: 40 segments at 1 kHz")}}}};
    return answer;
}

}  // namespace capstan::answers
