// Which requests are accepted: a table of hard cases. tests/commands/test_serve_strangers.py sends them to a
// running service.
#include <gtest/gtest.h>

#include "capstan/service/request_guard.h"

namespace capstan::service {
namespace {

const Access here{"127.0.0.1", 8321, ""};

RequestHead get_request() {
    RequestHead head;
    head.method = "GET";
    head.path = "/api/studies";
    head.host = "127.0.0.1:8321";
    return head;
}

RequestHead post_request(std::size_t bytes) {
    RequestHead head = get_request();
    head.method = "POST";
    head.path = "/api/query";
    head.content_type = "application/json";
    head.content_length = bytes;
    return head;
}

int status(const RequestHead& head) {
    auto refusal = refuse_origin(head, here);
    if (!refusal) refusal = refuse_body(head);
    return refusal ? refusal->status : 200;
}

TEST(RequestGuard, AcceptsRequestsOfItsOwnPagesAndOfAShell) {
    EXPECT_EQ(status(get_request()), 200);
    EXPECT_EQ(status(post_request(100)), 200);
    RequestHead page = post_request(100);
    page.host = "LocalHost:8321";
    page.origin = "http://localhost:8321";
    page.fetch_site = "same-origin";
    EXPECT_EQ(status(page), 200);
}

TEST(RequestGuard, RejectsForeignHostNames) {
    for (const char* host :
         {"", "evil.example:8321", "127.0.0.1", "127.0.0.1:8322", "127.0.0.1.evil.example:8321",
          "0.0.0.0:8321", "localhost", "user@127.0.0.1:8321"}) {
        RequestHead head = get_request();
        head.host = host;
        EXPECT_EQ(status(head), 403) << host;
    }
}

TEST(RequestGuard, RejectsPagesOfOtherSites) {
    for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1:8321",
                               "http://127.0.0.1:8322", "http://127.0.0.1:8321.evil.example"}) {
        RequestHead head = get_request();
        head.origin = origin;
        EXPECT_EQ(status(head), 403) << origin;
    }
    RequestHead head = get_request();
    head.fetch_site = "cross-site";
    EXPECT_EQ(status(head), 403);
}

TEST(RequestGuard, LimitsTheLengthOfBodies) {
    EXPECT_EQ(status(post_request(largest_text_bytes)), 200);
    EXPECT_EQ(status(post_request(largest_text_bytes + 1)), 413);
    RequestHead upload = post_request(largest_upload_bytes);
    upload.path = "/api/diagnoses";
    upload.content_type = "multipart/form-data; boundary=x";
    EXPECT_EQ(status(upload), 200);
    upload.content_length = largest_upload_bytes + 1;
    EXPECT_EQ(status(upload), 413);
    RequestHead endless = post_request(0);
    endless.content_length.reset();
    EXPECT_EQ(status(endless), 411);
    endless.transfer_encoding = "chunked";
    EXPECT_EQ(status(endless), 411);
}

TEST(RequestGuard, RejectsCrossSiteForms) {
    for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data"}) {
        RequestHead head = post_request(10);
        head.content_type = type;
        EXPECT_EQ(status(head), 415) << type;
    }
}

TEST(RequestGuard, KnowsTheAddressesOfThisMachine) {
    for (const char* host : {"localhost", "127.0.0.1", "127.1.2.3", "::1"})
        EXPECT_TRUE(is_loopback(host)) << host;
    for (const char* host :
         {"", "0.0.0.0", "127.evil.example", "127.0.0.1.evil.example", "127.", "128.0.0.1", "::"})
        EXPECT_FALSE(is_loopback(host)) << host;
}

}  // namespace
}  // namespace capstan::service
