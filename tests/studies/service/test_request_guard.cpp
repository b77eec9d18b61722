// Who is let in. The table of hard cases; tests/commands/test_serve_strangers.py asks the same of a running
// service.
#include <gtest/gtest.h>

#include "capstan/service/request_guard.h"

namespace capstan::service {
namespace {

const Access here{"127.0.0.1", 8321, ""};
const Access anywhere{"0.0.0.0", 8321, "0123456789abcdef"};

RequestHead asked() {
    RequestHead head;
    head.method = "GET";
    head.path = "/api/studies";
    head.host = "127.0.0.1:8321";
    return head;
}

RequestHead told(std::size_t bytes) {
    RequestHead head = asked();
    head.method = "POST";
    head.path = "/api/query";
    head.content_type = "application/json";
    head.content_length = bytes;
    return head;
}

int status(const RequestHead& head, const Access& access = here) {
    const auto refusal = refuse(head, access);
    return refusal ? refusal->status : 200;
}

TEST(RequestGuard, LetsInWhatItsOwnPagesAndAShellSend) {
    EXPECT_EQ(status(asked()), 200);
    EXPECT_EQ(status(told(100)), 200);
    RequestHead page = told(100);
    page.host = "LocalHost:8321";
    page.origin = "http://localhost:8321";
    page.fetch_site = "same-origin";
    EXPECT_EQ(status(page), 200);
}

TEST(RequestGuard, RefusesNamesThatWereMadeToPointHere) {
    for (const char* host :
         {"", "evil.example:8321", "127.0.0.1", "127.0.0.1:8322", "127.0.0.1.evil.example:8321",
          "0.0.0.0:8321", "localhost", "user@127.0.0.1:8321"}) {
        RequestHead head = asked();
        head.host = host;
        EXPECT_EQ(status(head), 403) << host;
    }
}

TEST(RequestGuard, RefusesPagesOfOtherSites) {
    for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1:8321",
                               "http://127.0.0.1:8322", "http://127.0.0.1:8321.evil.example"}) {
        RequestHead head = asked();
        head.origin = origin;
        EXPECT_EQ(status(head), 403) << origin;
    }
    RequestHead head = asked();
    head.fetch_site = "cross-site";
    EXPECT_EQ(status(head), 403);
}

TEST(RequestGuard, WantsTheTokenFromEveryone) {
    RequestHead head = asked();
    EXPECT_EQ(status(head, anywhere), 401);
    head.authorization = "Bearer 0123456789abcdeF";
    EXPECT_EQ(status(head, anywhere), 401);
    head.authorization = "Bearer 0123456789abcdef";
    EXPECT_EQ(status(head, anywhere), 200);
    head.authorization.clear();
    head.cookie = "theme=dark; capstan_token=0123456789abcdef";
    EXPECT_EQ(status(head, anywhere), 200);
    head.cookie = "xcapstan_token=0123456789abcdef";
    EXPECT_EQ(status(head, anywhere), 401);
}

TEST(RequestGuard, LimitsBodies) {
    EXPECT_EQ(status(told(largest_text_bytes)), 200);
    EXPECT_EQ(status(told(largest_text_bytes + 1)), 413);
    RequestHead upload = told(largest_upload_bytes);
    upload.path = "/api/diagnoses";
    upload.content_type = "multipart/form-data; boundary=x";
    EXPECT_EQ(status(upload), 200);
    upload.content_length = largest_upload_bytes + 1;
    EXPECT_EQ(status(upload), 413);
    RequestHead endless = told(0);
    endless.content_length.reset();
    EXPECT_EQ(status(endless), 411);
    endless.transfer_encoding = "chunked";
    EXPECT_EQ(status(endless), 411);
}

TEST(RequestGuard, TakesNoFormOfAnotherPage) {
    for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data"}) {
        RequestHead head = told(10);
        head.content_type = type;
        EXPECT_EQ(status(head), 415) << type;
    }
}

TEST(RequestGuard, ComparesSecretsWhole) {
    EXPECT_TRUE(same_secret("abc", "abc"));
    for (const char* wrong : {"", "ab", "abcd", "abd", "ABC"})
        EXPECT_FALSE(same_secret(wrong, "abc")) << wrong;
}

}  // namespace
}  // namespace capstan::service
