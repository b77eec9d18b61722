// Tokens and sessions: who has shown the token gets in, who guesses waits.
#include <gtest/gtest.h>

#include "capstan/service/entrance.h"

namespace capstan::service {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::int64_t now_s = 1'800'000'000;

TEST(Sessions, AreValidUntilTheyEnd) {
    const Sessions sessions("0123456789abcdef", 8321);
    const std::string cookie = "theme=dark; " + sessions.cookie_name() + "=" + sessions.begin(now_s);
    EXPECT_TRUE(sessions.is_valid(cookie, now_s));
    EXPECT_TRUE(sessions.is_valid(cookie, now_s + session_s - 1));
    EXPECT_FALSE(sessions.is_valid(cookie, now_s + session_s));
    EXPECT_EQ(cookie.find("0123456789abcdef"), std::string::npos);
}

TEST(Sessions, OfAnotherPortOrTokenAreNotTaken) {
    const Sessions ours("0123456789abcdef", 8321);
    for (const Sessions& other : {Sessions("0123456789abcdef", 8322), Sessions("0123456789abcdeF", 8321)})
        EXPECT_FALSE(ours.is_valid(ours.cookie_name() + "=" + other.begin(now_s), now_s));
}

TEST(Sessions, ThatWereChangedAreNotTaken) {
    const Sessions sessions("0123456789abcdef", 8321);
    const std::string value = sessions.begin(now_s);
    const std::string name = sessions.cookie_name() + "=";
    for (std::size_t k = 0; k < value.size(); ++k) {
        std::string changed = value;
        changed[k] = changed[k] == '1' ? '2' : '1';
        EXPECT_FALSE(sessions.is_valid(name + changed, now_s)) << changed;
    }
    for (const std::string& cookie :
         std::vector<std::string>{"", name, name + ".", "x" + name + value,
                                  name + value.substr(0, value.size() - 1), "capstan_token=0123456789abcdef"})
        EXPECT_FALSE(sessions.is_valid(cookie, now_s)) << cookie;
}

TEST(Secret, IsComparedInEveryCharacter) {
    EXPECT_TRUE(same_secret("abc", "abc"));
    for (const char* wrong : {"", "ab", "abcd", "abd", "ABC"})
        EXPECT_FALSE(same_secret(wrong, "abc")) << wrong;
}

TEST(GuessLog, AnswersWrongTokensOneAfterTheOther) {
    GuessLog log;
    const auto now = GuessLog::Clock::now();
    EXPECT_EQ(log.wrong("10.0.0.1", now), milliseconds(500));
    EXPECT_EQ(log.wrong("10.0.0.1", now), milliseconds(1000));
    EXPECT_EQ(log.wrong("10.0.0.2", now), milliseconds(500));
    EXPECT_EQ(log.wrong("10.0.0.1", now + seconds(2)), milliseconds(500));
}

TEST(GuessLog, LooksAtNoTokensOfAnAddressThatGuessesAtOnce) {
    GuessLog log;
    const auto now = GuessLog::Clock::now();
    for (int k = 0; k < 10; ++k) {
        EXPECT_TRUE(log.may_guess("10.0.0.1", now));
        log.wrong("10.0.0.1", now);
    }
    EXPECT_FALSE(log.may_guess("10.0.0.1", now));
    EXPECT_TRUE(log.may_guess("10.0.0.2", now));
    EXPECT_TRUE(log.may_guess("10.0.0.1", now + seconds(1)));
}

http::Request request_of_a_stranger() {
    http::Request head;
    head.method = "GET";
    head.path = "/api/studies";
    head.client = "10.0.0.1";
    head.headers = {{"host", "bench:8321"}};
    return head;
}

TEST(Entrance, TakesTheTokenOnceAndThenItsSession) {
    const Access access{"0.0.0.0", 8321, "0123456789abcdef"};
    Entrance entrance(access);
    http::Request head = request_of_a_stranger();
    EXPECT_EQ(entrance.judge(head).refusal->status, 401);
    head.path = "/";
    head.parameters = {{"token", "0123456789abcdef"}};
    const auto entered = entrance.judge(head).refusal;
    ASSERT_EQ(entered->status, 303);
    ASSERT_EQ(entered->headers.at(1).first, "Set-Cookie");
    const std::string cookie = entered->headers.at(1).second;
    EXPECT_NE(cookie.find("HttpOnly; SameSite=Strict"), std::string::npos);
    head = request_of_a_stranger();
    head.headers.emplace_back("cookie", cookie.substr(0, cookie.find(';')));
    EXPECT_FALSE(entrance.judge(head).refusal);
}

TEST(Entrance, DelaysGuessesAndLetsSessionsPass) {
    const Access access{"0.0.0.0", 8321, "0123456789abcdef"};
    Entrance entrance(access);
    http::Request head = request_of_a_stranger();
    head.headers.emplace_back("authorization", "Bearer wrong");
    for (int k = 1; k < 10; ++k) {
        const http::Verdict verdict = entrance.judge(head);
        EXPECT_EQ(verdict.refusal->status, 401);
        EXPECT_GT(verdict.delay, milliseconds(500 * k - 500));
    }
    for (int k = 0; k < 2; ++k) entrance.judge(head);
    head.headers.back().second = "Bearer 0123456789abcdef";
    EXPECT_EQ(entrance.judge(head).refusal->status, 429);
    head.client = "10.0.0.2";
    EXPECT_FALSE(entrance.judge(head).refusal);
}

}  // namespace
}  // namespace capstan::service
