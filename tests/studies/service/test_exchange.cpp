// What a request's body may hold.
#include <gtest/gtest.h>

#include "capstan/service/exchange.h"

namespace capstan::service {
namespace {

TEST(RequestBody, GivesIntegersExactly) {
    const auto body = nlohmann::json::parse(R"({"noise": 2, "nodes": [1, -3, 2147483647]})");
    EXPECT_EQ(member<int>(body, "noise"), 2);
    EXPECT_EQ(member<std::vector<int>>(body, "nodes"), (std::vector{1, -3, 2147483647}));
}

TEST(RequestBody, RejectsNumbersThatAreNotIntegersOf32Bits) {
    for (const char* number : {"1.5", "1e300", "4294967297", "-2147483649", "18446744073709551615", "true",
                               "\"1\"", "null", "[]"}) {
        const auto body =
            nlohmann::json::parse(std::string("{\"noise\": ") + number + ", \"nodes\": [1, " + number + "]}");
        EXPECT_THROW(member<int>(body, "noise"), BadRequest) << number;
        EXPECT_THROW(member<std::vector<int>>(body, "nodes"), BadRequest) << number;
    }
}

TEST(RequestBody, RejectsMissingMembers) {
    const auto body = nlohmann::json::object();
    EXPECT_THROW(member<int>(body, "noise"), BadRequest);
    EXPECT_THROW(member<std::vector<int>>(body, "nodes"), BadRequest);
    EXPECT_THROW(member<std::string>(body, "sql"), BadRequest);
}

}  // namespace
}  // namespace capstan::service
