#include <gtest/gtest.h>

#include <cmath>

#include "capstan/reports/answer.h"
#include "sample_report.h"

namespace capstan::reports {
namespace {

using sample::holds;

// A page with one of the two figures' tables of the comparison of solvers.
Answer answer_titled(const std::string& title) {
    Answer page;
    page.id = "solver";
    page.kind = "Test";
    page.title = title;
    page.headline = "One sentence.";
    page.values["rates"].push_back({{"what", title}, {"count", 3}, {"interval", Data::list({0.25, 0.5})}});
    page.sections = {{"rates",
                      "Rates",
                      "Words.",
                      {{"numbers",
                        "Numbers",
                        {{"what", "What"}, {"count", "How many"}, {"interval", "Between", "N", ".2f"}},
                        *page.values.find("rates")}},
                      ""},
                     {"agreement", "Agreement", "Words.", {}, ""}};
    page.drawn = {
        {"solver_rate", "Rates", {"solver", "segments", "steps_per_s"}, {{title, std::int64_t{1}, 2.0}}},
        {"control_rate", "Paper", {"segments", "steps_per_s", "label"}, {{std::int64_t{40}, 1e3, "paper"}}},
        {"agreement", "Nothing", {"motion", "segments", "largest_difference_N"}, {}}};
    return page;
}

TEST(AnswerPage, ShowsNumbersBesideTheFiguresOfItsSection) {
    const std::string html = answer_html(answer_titled("Solvers"));
    EXPECT_LT(html.find("<table class=\"numbers\">"), html.find("<figure id=\"figure-rate\""));
    EXPECT_TRUE(holds(html, "default-src 'none'"));
    EXPECT_LT(html.size(), 3'000'000U);
}

TEST(AnswerPage, LeavesOutFiguresWithoutRowsAndSectionsWithoutFigures) {
    const std::string html = answer_html(answer_titled("Solvers"));
    EXPECT_FALSE(holds(html, "id=\"figure-agreement\""));
    EXPECT_FALSE(holds(html, "<section id=\"agreement\""));
    EXPECT_FALSE(holds(html, "href=\"#agreement\""));
}

TEST(AnswerPage, ShowsWordsThatHaveNeitherHeadingNorTable) {
    Answer answer = answer_titled("Solvers");
    answer.sections.push_back({.id = "words", .prose = "Use <two> sensors."});
    EXPECT_TRUE(holds(answer_html(answer), "<p>Use &lt;two&gt; sensors.</p>"));
}

TEST(AnswerPage, AlignsColumnsOfWordsOtherwiseThanNumbers) {
    Answer answer = answer_titled("Solvers");
    AnswerTable& table = answer.sections[0].tables[0];
    std::swap(table.columns[0], table.columns[1]);  // the first column names the rows
    const std::string html = answer_html(answer);
    EXPECT_TRUE(holds(html, "<td class=\"words\">Solvers</td>"));
    EXPECT_TRUE(holds(html, "<td class=\"number\">0.25 to 0.50</td>"));
}

TEST(AnswerPage, CarriesNoFigureOfAnotherPage) {
    EXPECT_FALSE(holds(answer_html(answer_titled("Solvers")), "\"error_by_count\""));
}

TEST(AnswerPage, EscapesHostileTexts) {
    const std::string html = answer_html(answer_titled("</script><script>alert(1)</script>"));
    EXPECT_FALSE(holds(html, "<script>alert"));
    EXPECT_TRUE(holds(html, "&lt;script&gt;alert"));
}

TEST(Answer, TextShowsUnitsIntervalsAndTheHeadlineFirst) {
    const std::string text = answer_text(answer_titled("Solvers"));
    EXPECT_TRUE(text.starts_with("Solvers: One sentence.\n"));
    EXPECT_TRUE(holds(text, "Between [N]"));
    EXPECT_TRUE(holds(text, "0.25 to 0.50"));
}

TEST(Answer, TextBreaksLongTextsToFitATerminalAndLosesNoWord) {
    Answer answer;
    answer.title = "Keys";
    answer.headline = "One sentence.";
    std::string words;
    for (int k = 0; k < 60; ++k) words += " word" + std::to_string(k);
    Data rows = Data::list();
    rows.push_back({{"key", "a_key"}, {"meaning", words.substr(1)}, {"example", "12"}});
    rows.push_back({{"key", "another_key"}, {"meaning", "short"}, {"example", "a few words more"}});
    answer.sections = {
        {"keys",
         "Keys",
         "",
         {{"keys",
           "",
           {{"key", "key"}, {"meaning", "meaning", "", "wrap"}, {"example", "example", "", "wrap"}},
           rows}},
         ""}};
    const std::string text = answer_text(answer);
    for (std::size_t at = 0, end = 0; at < text.size(); at = end + 1) {
        end = text.find('\n', at);
        EXPECT_LE(end - at, 100U) << text.substr(at, end - at);
    }
    for (int k = 0; k < 60; ++k) EXPECT_TRUE(holds(text, "word" + std::to_string(k))) << k;
    EXPECT_TRUE(holds(text, "a few words more"));
}

TEST(Answer, CsvHasEveryValueOfEveryTableInFullPrecision) {
    const std::string csv = answer_csv(answer_titled("A, B"));
    EXPECT_TRUE(csv.starts_with("table,row,column,value,unit"));
    EXPECT_TRUE(holds(csv, "numbers,1,what,\"A, B\","));
    EXPECT_TRUE(holds(csv, "numbers,1,interval,\"[0.25,0.5]\",N"));
}

TEST(Answer, PeopleReadANameInWordsAndProgramsTheName) {
    Answer answer = answer_titled("load_torque");
    answer.sections[0].tables[0].columns[0].words = [](const std::string& name) {
        return "words of " + name;
    };
    EXPECT_TRUE(holds(answer_text(answer), "words of load_torque"));
    EXPECT_TRUE(holds(answer_html(answer), "words of load_torque"));
    EXPECT_TRUE(holds(answer_csv(answer), ",what,load_torque,"));
}

TEST(Answer, MarkdownEscapesWhatWouldEndATable) {
    EXPECT_TRUE(holds(answer_markdown(answer_titled("a|b")), "a\\|b"));
}

TEST(Answer, JsonIsTheTreeOfValuesAndANumberThatIsNotFiniteIsNull) {
    Answer answer = answer_titled("Solvers");
    answer.values["error_N"] = std::nan("");
    EXPECT_TRUE(holds(answer_json(answer), "\"error_N\": null"));
    EXPECT_TRUE(holds(answer_json(answer), "\"count\": 3"));
}

TEST(Data, FindsByPathAndKeepsTheOrderOfNames) {
    const Data data = {{"b", Data{{"x", 1.5}}}, {"a", true}};
    ASSERT_NE(data.find("b.x"), nullptr);
    EXPECT_EQ(*data.find("b.x")->number(), 1.5);
    EXPECT_EQ(data.find("b.y"), nullptr);
    EXPECT_EQ(json_line(data), R"({"b":{"x":1.5},"a":true})");
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
