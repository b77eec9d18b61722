#include <gtest/gtest.h>

#include "capstan/reports/experiment_page.h"

namespace capstan::reports {
namespace {

// A page with one of the two figures' tables of the comparison of solvers.
ExperimentPage page_of(const std::string& title) {
    ExperimentPage page;
    page.id = "solver";
    page.kind = "Test";
    page.title = title;
    page.verdict = "One sentence.";
    page.sections = {{"rates", "Rates", "Words.", {{"Numbers", {"What", "How much"}, {{title, "3"}}}}, ""},
                     {"agreement", "Agreement", "Words.", {}, ""}};
    page.tables = {
        {"solver_rate", "Rates", {"solver", "segments", "steps_per_s"}, {{title, std::int64_t{1}, 2.0}}},
        {"control_rate", "Paper", {"segments", "steps_per_s", "label"}, {{std::int64_t{40}, 1e3, "paper"}}},
        {"agreement", "Nothing", {"motion", "segments", "largest_difference_N"}, {}}};
    return page;
}

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(ExperimentPage, ShowsNumbersBesideTheFiguresOfItsSection) {
    const std::string html = experiment_page_html(page_of("Solvers"));
    EXPECT_LT(html.find("<table class=\"numbers\">"), html.find("<figure id=\"figure-rate\""));
    EXPECT_TRUE(holds(html, "default-src 'none'"));
    EXPECT_LT(html.size(), 3'000'000U);
}

TEST(ExperimentPage, LeavesOutFiguresWithoutRowsAndSectionsWithoutFigures) {
    const std::string html = experiment_page_html(page_of("Solvers"));
    EXPECT_FALSE(holds(html, "id=\"figure-agreement\""));
    EXPECT_FALSE(holds(html, "<section id=\"agreement\""));
    EXPECT_FALSE(holds(html, "href=\"#agreement\""));
}

TEST(ExperimentPage, HasOnlyItsOwnFigures) {
    EXPECT_FALSE(holds(experiment_page_html(page_of("Solvers")), "\"error_by_count\""));
}

TEST(ExperimentPage, EscapesHostileTexts) {
    const std::string html = experiment_page_html(page_of("</script><script>alert(1)</script>"));
    EXPECT_FALSE(holds(html, "<script>alert"));
    EXPECT_TRUE(holds(html, "&lt;script&gt;alert"));
}

TEST(DrawnEvery, NeverDrawsMoreThanTheLimit) {
    EXPECT_EQ(drawn_every(100, 100), 1u);
    EXPECT_EQ(drawn_every(101, 100), 2u);
    for (std::size_t samples = 1; samples < 500; ++samples) {
        const std::size_t every = drawn_every(samples, 30);
        EXPECT_LE((samples + every - 1) / every, 30u) << samples;
    }
}

}  // namespace
}  // namespace capstan::reports
