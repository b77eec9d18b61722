#include <fmt/format.h>

#include "capstan/answers/paper_answers.h"
#include "capstan/paper/placement_comparison.h"
#include "capstan/storage/report_queries.h"

namespace capstan::answers {

namespace {

using reports::AnswerTable;
using reports::Data;

const storage::PaperComparisonRecord* same_row(const std::vector<storage::PaperComparisonRecord>& rows,
                                               const std::string& quantity) {
    for (const auto& row : rows) {
        if (row.quantity == quantity) return &row;
    }
    return nullptr;
}

Data rows_data(const paper::AblatedTable& table) {
    Data rows = Data::list();
    for (const auto& row : table.as_configured) {
        std::vector<std::string> accounting;
        Data each = {{"quantity", row.quantity},
                     {"relation", row.relation},
                     {"paper_N", row.paper_N ? Data(*row.paper_N) : Data()},
                     {"ours_N", row.ours_N},
                     {"standard_error_N", row.standard_error_N},
                     {"reason", row.reason}};
        for (const paper::ReadingAblation& ablation : table.ablations) {
            const auto* changed = same_row(ablation.rows, row.quantity);
            if (changed != nullptr && row.reason != paper::agrees && paper::accounts_for(*changed, row))
                accounting.push_back(ablation.name);
            each[ablation.name] = changed == nullptr ? Data()
                                                     : Data({{"ours_N", changed->ours_N},
                                                             {"standard_error_N", changed->standard_error_N},
                                                             {"agrees", changed->reason == paper::agrees}});
        }
        each["accounted_for_by"] = accounting;
        rows.push_back(std::move(each));
    }
    return rows;
}

AnswerTable numbers_table(const paper::AblatedTable& table, const Data& rows) {
    AnswerTable numbers{"ablations",
                        "",
                        {{"quantity", "quantity"},
                         {"relation", ""},
                         {"paper_N", "paper", "N", ".3g"},
                         {"ours_N", "as configured", "N", ".3f"},
                         {"standard_error_N", "standard error", "N", ".3f"}},
                        rows};
    for (const paper::ReadingAblation& ablation : table.ablations)
        numbers.columns.push_back({ablation.name + ".ours_N", ablation.name, "N", ".3f"});
    return numbers;
}

int agreeing(const std::vector<storage::PaperComparisonRecord>& rows) {
    int count = 0;
    for (const auto& row : rows) count += row.reason == paper::agrees ? 1 : 0;
    return count;
}

}  // namespace

reports::Answer paper_estimation_answer(const paper::AblatedTable& table) {
    reports::Answer answer;
    answer.id = "paper_estimation";
    answer.kind = "The paper's estimation experiment";
    answer.title = "Readings that the paper leaves open";
    answer.headline = fmt::format("{} of {} numbers agree with the paper's as configured.",
                                  agreeing(table.as_configured), table.as_configured.size());
    Data ablations = Data::list();
    for (const paper::ReadingAblation& each : table.ablations) {
        ablations.push_back(
            {{"name", each.name}, {"meaning", each.meaning}, {"rows_that_agree", agreeing(each.rows)}});
    }
    Data rows = rows_data(table);
    answer.values = {{"rows", rows}, {"ablations", ablations}};
    answer.sections = {
        {.id = "rows",
         .heading = "The paper's numbers and ours, with each reading changed by itself",
         .tables = {numbers_table(table, rows)},
         .note = storage::paper_agreement_words() + " " + storage::paper_matched_words},
        {.id = "meanings",
         .heading = "What each ablation changes",
         .tables = {{"ablation_meanings",
                     "",
                     {{"name", "ablation"}, {"meaning", "change"}, {"rows_that_agree", "rows that agree"}},
                     ablations}}},
        {.id = "reasons",
         .heading = "Why our numbers part from the paper's",
         .tables = {{"reasons",
                     "",
                     {{"quantity", "quantity"},
                      {"accounted_for_by", "accounted for by"},
                      {"reason", "reason that the comparison gives"}},
                     rows}},
         .note =
             "An ablation accounts for a row if with it the row agrees, or lies on the other side of the paper's "
             "number."}};
    return answer;
}

}  // namespace capstan::answers
