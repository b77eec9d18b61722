#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "capstan/reports/figure_catalogue.h"
#include "capstan/reports/study_report.h"
#include "capstan/storage/error.h"
#include "sample_report.h"

namespace capstan::reports {
namespace {

using sample::holds;
using sample::SampleReport;

std::string page_of(const sample::SampleOptions& options = {}) {
    SampleReport sample(options);
    return study_report_html(sample.database, sample.study_id);
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

// The page without the chart library, whose code mentions addresses that it never loads.
std::string own_part(const std::string& page) {
    std::string own = page.substr(0, page.find("<script data-file=\"vega.min.js\">"));
    return own + page.substr(page.find("<script data-file=\"page.js\">"));
}

nlohmann::json data_of(const std::string& page) {
    const std::string opening = "<script type=\"application/json\" id=\"study-data\">";
    const std::size_t begin = page.find(opening) + opening.size();
    return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(StudyPage, LoadsNothingFromTheNetwork) {
    const std::string page = page_of();
    const std::string own = own_part(page);
    for (const char* way :
         {" src=", "href=\"http", "href=\"//", "href='", "@import", "url(", "fetch(", "XMLHttpRequest"}) {
        EXPECT_FALSE(holds(own, way)) << way;
    }
    EXPECT_FALSE(holds(page, "<link"));
    EXPECT_TRUE(holds(page, "default-src 'none'"));  // and the browser is told so
}

TEST(StudyPage, CarriesItsChartScripts) {
    const std::string page = page_of();
    EXPECT_TRUE(holds(page, "vegaEmbed"));
    EXPECT_TRUE(holds(page, "vegaLite"));
    EXPECT_LT(page.size(), 3'000'000U);
}

TEST(StudyPage, EscapesHostileNames) {
    const std::string hostile = "</title><script>alert(\"1\")</script><!-- ' & \xe2\x80\xa8 \xff";
    const std::string page = page_of({.name = hostile});
    EXPECT_FALSE(holds(page, "<script>alert"));
    EXPECT_TRUE(
        holds(page, "&lt;/title&gt;&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt;&lt;!-- &#39; &amp;"));
    EXPECT_EQ(count_of(own_part(page), "</body>"), 1U);
    EXPECT_NO_THROW(data_of(page));
}

TEST(StudyPage, PutsTheRecommendationBeforeTheFigures) {
    const std::string page = page_of();
    const std::size_t advice = page.find("<section id=\"recommendation\"");
    ASSERT_NE(advice, std::string::npos);
    EXPECT_LT(page.find("class=\"verdict\""), advice);
    EXPECT_LT(advice, page.find("<section id=\"one-sensor\""));
    EXPECT_LT(page.find("<section id=\"fusion\""), page.find("<section id=\"paper\""));
    EXPECT_LT(page.find("<section id=\"paper\""), page.find("<section id=\"making\""));
    EXPECT_EQ(count_of(page, "<article class=\"advice\""), 4U);  // two regimes, regret, duty cycle
    EXPECT_EQ(count_of(page, "<svg class=\"cable\""), 4U);
    EXPECT_EQ(count_of(page, "<g class=\"sensor\">"), 16U);  // four sensors each
}

TEST(StudyPage, HoldsTheDataOfEveryFigureOnce) {
    const std::string page = page_of();
    const auto data = data_of(page);
    const std::string mark = "data-figure=\"";
    int drawn = 0;
    for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1)) {
        const std::size_t begin = at + mark.size();
        const std::string id = page.substr(begin, page.find('"', begin) - begin);
        for (const std::string table : data.at("figures").at(id).at("usermeta").at("capstan").at("tables")) {
            EXPECT_GT(data.at("tables").at(table).at("rows"), 0) << id << " " << table;
        }
        ++drawn;
    }
    EXPECT_GE(drawn, 14);
    EXPECT_EQ(count_of(page, "\"error_by_instant\":{\"meaning\""), 1U);
}

TEST(StudyPage, ReservesSpaceForEveryFigureAndHasItsCaption) {
    const std::string page = page_of();
    const std::size_t figure_count = count_of(page, "<figure id=");
    EXPECT_EQ(count_of(page, "style=\"min-height:"), figure_count);
    EXPECT_EQ(count_of(page, "<figcaption"), figure_count);
    EXPECT_EQ(count_of(page, "<details class=\"data\">"), figure_count);
    for (const Figure& figure : figures()) EXPECT_GT(figure.caption.size(), 40U) << figure.id;
}

TEST(StudyPage, OmitsSectionsWithoutData) {
    const std::string page =
        page_of({.with_partial_regime = false, .with_paper_comparison = false, .with_node_errors = false});
    EXPECT_FALSE(holds(page, "<section id=\"paper\""));
    EXPECT_FALSE(holds(page, "href=\"#paper\""));
    EXPECT_FALSE(holds(page, "data-regime=\"partial_proximal\""));
    EXPECT_FALSE(holds(page, "id=\"figure-node_error\""));
    EXPECT_FALSE(holds(page, "id=\"figure-error_by_noise"));
    EXPECT_FALSE(holds(page, "<fieldset id=\"noise\">"));
    EXPECT_TRUE(holds(page, "id=\"figure-error_by_count-mass\""));
}

TEST(StudyPage, OffersEveryNoiseLevel) {
    const std::string page = page_of({.noise_levels = 3});
    EXPECT_EQ(count_of(page, "<input type=\"radio\" name=\"noise\""), 3U);
    EXPECT_TRUE(holds(page, "id=\"figure-error_by_noise-mass\""));
    EXPECT_EQ(count_of(page, "<article class=\"advice\""), 12U);
}

TEST(StudyPage, RejectsAnUnknownStudy) {
    SampleReport sample;
    EXPECT_THROW(study_report_html(sample.database, 99), storage::Error);
}

TEST(StudyPage, IsTheSameTwice) {
    SampleReport sample;
    EXPECT_EQ(study_report_html(sample.database, sample.study_id),
              study_report_html(sample.database, sample.study_id));
}

}  // namespace
}  // namespace capstan::reports
