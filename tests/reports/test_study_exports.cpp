#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "capstan/reports/study_report.h"
#include "capstan/storage/read_only_query.h"
#include "capstan/storage/report_queries.h"
#include "sample_report.h"

namespace capstan::reports {
namespace {

using sample::SampleReport;

double one_number(storage::Database& database, const std::string& sql) {
    const auto result = storage::run_read_only(database, sql);
    const auto& value = result.rows.at(0).at(0);
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
    return std::get<double>(value);
}

TEST(StudyJson, AgreesWithTheDatabaseToTheLastBit) {
    SampleReport sample;
    const auto report = nlohmann::json::parse(study_report_json(sample.database, sample.study_id));
    const auto rows = report.at("error_by_layout");
    EXPECT_EQ(rows.size(), one_number(sample.database, "SELECT count(*) FROM v_error_by_layout"));
    const auto found = std::find_if(rows.begin(), rows.end(), [](const auto& row) {
        return row["regime"] == "mass" && row["family"] == "distal" && row["sensor_count"] == 3 &&
               row["method"] == "w_mean";
    });
    ASSERT_NE(found, rows.end());
    EXPECT_EQ(
        (*found)["mean_abs_error_N"].get<double>(),
        one_number(
            sample.database,
            "SELECT mean_abs_error_N FROM v_error_by_layout WHERE regime = 'mass' AND family = 'distal' "
            "AND sensor_count = 3 AND method = 'w_mean'"));
}

TEST(StudyJson, HasEveryReportTable) {
    SampleReport sample({.noise_levels = 2});
    const auto report = nlohmann::json::parse(study_report_json(sample.database, sample.study_id));
    for (const auto& query : storage::report_queries()) {
        EXPECT_GT(report.at(std::string(query.table)).size(), 0U) << query.table;
    }
}

TEST(StudyJson, HoldsOneStudyOnly) {
    SampleReport sample;
    const auto report = nlohmann::json::parse(study_report_json(sample.database, sample.study_id));
    for (const auto& row : report.at("study")) EXPECT_EQ(row.at("study_id"), sample.study_id);
}

TEST(ErrorCsv, HasARowPerRowOfTheView) {
    SampleReport sample;
    std::istringstream lines(study_error_csv(sample.database, sample.study_id));
    std::string header, line;
    std::getline(lines, header);
    EXPECT_EQ(header.substr(0, 28), "regime,noise_level_id,noise,");
    const auto columns = std::count(header.begin(), header.end(), ',');
    int rows = 0;
    while (std::getline(lines, line)) {
        if (line.find('"') == std::string::npos) {
            EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns) << line;
        }
        ++rows;
    }
    EXPECT_EQ(rows, one_number(sample.database, "SELECT count(*) FROM v_error_by_layout"));
}

TEST(ErrorCsv, QuotesTextWithCommas) {
    SampleReport sample;
    EXPECT_NE(study_error_csv(sample.database, sample.study_id).find(",\"Mean, direction known\","),
              std::string::npos);
}

TEST(StudyMarkdown, BeginsWithTheRecommendationAndShowsTheTables) {
    SampleReport sample;
    const std::string text = study_report_markdown(sample.database, sample.study_id);
    EXPECT_EQ(text.substr(0, 2), "# ");
    EXPECT_NE(text.find("## Recommendations"), std::string::npos);
    EXPECT_NE(text.find("| Single sensor at node 1 | 1.60 | 1.36 | -0.240 |"), std::string::npos);
    std::istringstream lines(text);
    std::string line;
    int error_rows = 0;
    while (std::getline(lines, line)) error_rows += line.rfind("| Mass motion | 10 % | ", 0) == 0 ? 1 : 0;
    EXPECT_EQ(error_rows, 1 + one_number(sample.database,
                                         "SELECT count(*) FROM v_error_by_layout WHERE regime = 'mass'"));
}

TEST(StudyMarkdown, KeepsHostileNamesHarmless) {
    SampleReport sample({.name = "a | b <img src=x>\n# c"});
    const std::string text = study_report_markdown(sample.database, sample.study_id);
    EXPECT_EQ(text.substr(0, text.find('\n')), "# a \\| b &lt;img src=x> # c");
}

TEST(StudyMarkdown, OmitsThePaperIfNothingIsCompared) {
    SampleReport sample({.with_paper_comparison = false});
    EXPECT_EQ(study_report_markdown(sample.database, sample.study_id).find("paper's numbers"),
              std::string::npos);
}

}  // namespace
}  // namespace capstan::reports
