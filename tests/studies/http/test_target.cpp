// What a request line asks for.
#include <gtest/gtest.h>

#include "capstan/http/target.h"

namespace capstan::http {
namespace {

TEST(Target, DecodesThePathAndTheQuery) {
    const auto target = parse_target("/api/configs/one%20two.toml?token=a%2Bb+c&empty=&&x#part");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->path, "/api/configs/one two.toml");
    EXPECT_EQ(target->parameters,
              (std::map<std::string, std::string>{{"token", "a+b c"}, {"empty", ""}, {"x", ""}}));
    EXPECT_EQ(parse_target("/a+b")->path, "/a+b");
}

TEST(Target, TakesTheFirstOfTwoParametersOfAName) {
    EXPECT_EQ(parse_target("/?token=1&token=2")->parameters.at("token"), "1");
}

TEST(Target, RejectsDamagedEscapesZerosAndForeignForms) {
    for (const char* text : {"", "*", "http://other/", "/%", "/%2", "/%zz", "/%00", "/?a=%00", "/?%f"})
        EXPECT_FALSE(parse_target(text)) << text;
}

}  // namespace
}  // namespace capstan::http
