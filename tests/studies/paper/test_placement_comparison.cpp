#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capstan/paper/placement_comparison.h"
#include "capstan/paper/reading_ablations.h"
#include "paper_plan.h"
#include "temporary_study.h"

namespace capstan {
namespace {

using Rows = std::vector<storage::PaperComparisonRecord>;

Rows compared(const StudyPlan& plan) {
    test::TemporaryStudy study;
    const std::int64_t id = run_study(study.database(), plan, "test", {}).study_id;
    return paper::compare_placement(study.database(), id);
}

// The paper's study with the methods that the paper has.
StudyPlan papers_methods(int repetitions) {
    StudyPlan plan = test::paper_plan(repetitions);
    plan.fusion_methods = {"mean_known", "mean", "mean_r", "w_mean", "w_mean_r"};
    return plan;
}

const Rows& papers_rows() {
    static const Rows rows = compared(papers_methods(400));
    return rows;
}

const storage::PaperComparisonRecord* find(const Rows& rows, const std::string& quantity) {
    const auto found =
        std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.quantity == quantity; });
    return found == rows.end() ? nullptr : &*found;
}

TEST(PaperComparison, HasANumberOfOursForEachOfThePapers) {
    ASSERT_EQ(papers_rows().size(), 21u);
    for (const auto& row : papers_rows()) {
        EXPECT_TRUE(std::isfinite(row.ours_N)) << row.quantity;
        EXPECT_TRUE(std::isfinite(row.standard_error_N)) << row.quantity;
        EXPECT_GT(row.standard_error_N, 0.0) << row.quantity;
        EXPECT_TRUE(row.paper_N.has_value()) << row.quantity;
        EXPECT_FALSE(row.reason.empty()) << row.quantity;
    }
}

// 0.03 N for the paper's rounding and its single draws, and two of our standard errors; nothing for a bound.
TEST(PaperComparison, SaysAgreesExactlyWhereTheNumbersAreWithinRounding) {
    int agreeing = 0;
    for (const auto& row : papers_rows()) {
        const bool within = row.relation == "<"
                                ? row.ours_N <= *row.paper_N + 2.0 * row.standard_error_N
                                : std::abs(row.ours_N - *row.paper_N) <= 0.03 + 2.0 * row.standard_error_N;
        EXPECT_EQ(row.reason == "agrees", within) << row.quantity << ": " << row.ours_N;
        agreeing += within;
    }
    EXPECT_GT(agreeing, 3);
    EXPECT_LT(agreeing, 21) << "the paper's W numbers in partial motion cannot be reproduced";
}

// A reason that names an ablation is not taken on trust.
TEST(PaperComparison, AnAblationThatAReasonNamesAccountsForTheRow) {
    const paper::AblatedTable table = paper::ablate_readings(papers_methods(400), {});
    int shown = 0;
    for (const auto& row : table.as_configured) {
        const auto at = row.reason.find("(ablation: ");
        if (at == std::string::npos) continue;
        const auto first = at + std::string("(ablation: ").size();
        const std::string name = row.reason.substr(first, row.reason.find(')', first) - first);
        const auto ablation = std::find_if(table.ablations.begin(), table.ablations.end(),
                                           [&](const auto& each) { return each.name == name; });
        ASSERT_NE(ablation, table.ablations.end()) << row.reason;
        const auto* changed = find(ablation->rows, row.quantity);
        ASSERT_NE(changed, nullptr) << row.quantity;
        EXPECT_TRUE(paper::accounts_for(*changed, row)) << row.quantity << ": " << changed->ours_N;
        ++shown;
    }
    EXPECT_GT(shown, 5);
}

TEST(PaperComparison, ARowThatDiffersNamesAnAblationOrCallsItsReasonAGuessOrUnknown) {
    for (const auto& row : papers_rows()) {
        const bool stated = row.reason == "agrees" || row.reason == "unknown" ||
                            row.reason.find("(a guess)") != std::string::npos ||
                            row.reason.find("(ablation: ") != std::string::npos;
        EXPECT_TRUE(stated) << row.quantity << ": " << row.reason;
    }
}

TEST(PaperComparison, LayoutsTieWhenTheDirectionIsKnown) {
    const auto* row = find(papers_rows(), "direction known: largest difference between layouts");
    ASSERT_NE(row, nullptr);
    EXPECT_EQ(row->relation, "<");
    EXPECT_LT(row->ours_N, 0.01 + 3.0 * row->standard_error_N);
}

// Numbers of an independent prototype with 2000 repetitions; 0.03 N for its draws beside our 400.
TEST(PaperComparison, ReproducesThePrototypeInMassMotion) {
    const std::pair<const char*, double> prototype[] = {
        {"single sensor at the proximal node", 1.36},
        {"single sensor at the distal node", 0.41},
        {"mass motion, all layouts and counts: W Mean", 0.41},
        {"mass motion, all layouts and counts: Mean-R", 0.45},
        {"mass motion, all layouts and counts: Mean", 0.53},
        {"mass motion, all layouts and counts: W Mean-R", 0.57},
        {"Distal, 2 to 5 sensors: Mean", 0.36},
        {"Distal, 2 to 5 sensors: W Mean", 0.36},
        {"Distal, 6 sensors to all: Mean", 0.38},
        {"Distal, 6 sensors to all: W Mean", 0.32},
        {"gain from one sensor to all: Even", 0.44},
        {"gain from one sensor to all: Distal", -0.03},
        {"gain from one sensor to all: Both", 0.44},
        {"Distal is better than Even by", 0.13},
        {"Distal is better than Both by", 0.15},
    };
    for (const auto& [quantity, number_N] : prototype) {
        const auto* row = find(papers_rows(), quantity);
        ASSERT_NE(row, nullptr) << quantity;
        EXPECT_NEAR(row->ours_N, number_N, 0.03 + 3.0 * row->standard_error_N) << quantity;
    }
}

TEST(PaperComparison, LeavesOutRowsWhoseRegimeIsMissing) {
    StudyPlan mass_only = papers_methods(4);
    mass_only.regimes = {{Regime::mass, {112, 142}, 1.0}};
    const Rows rows = compared(mass_only);
    EXPECT_EQ(rows.size(), 17u);
    for (const auto& row : rows) EXPECT_EQ(row.quantity.find("partial motion"), std::string::npos);
}

TEST(PaperComparison, LeavesOutRowsWhoseMethodIsMissing) {
    StudyPlan no_known = papers_methods(4);
    no_known.fusion_methods = {"mean"};
    const Rows rows = compared(no_known);
    EXPECT_EQ(find(rows, "direction known: largest difference between layouts"), nullptr);
    EXPECT_EQ(find(rows, "mass motion, all layouts and counts: W Mean"), nullptr);
    EXPECT_NE(find(rows, "mass motion, all layouts and counts: Mean"), nullptr);
}

}  // namespace
}  // namespace capstan
