#include <gtest/gtest.h>

#include "capstan/reports/html_text.h"

namespace capstan::reports {
namespace {

TEST(HtmlText, EscapesEverythingThatHtmlGivesAMeaning) {
    EXPECT_EQ(escape_html("<b a=\"1\" c='2'>&amp;"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;amp;");
}

TEST(HtmlText, ShowsThreeSignificantDigits) {
    EXPECT_EQ(plain_number(0.12649), "0.126");
    EXPECT_EQ(plain_number(0.004), "0.00400");
    EXPECT_EQ(plain_number(12.34), "12.3");
    EXPECT_EQ(plain_number(1234.5), "1234");
    EXPECT_EQ(plain_number(-0.5), "-0.500");
    EXPECT_EQ(plain_number(0), "0");
    EXPECT_EQ(newtons_between(0.1, 0.2), "0.100 to 0.200 N");
}

}  // namespace
}  // namespace capstan::reports
