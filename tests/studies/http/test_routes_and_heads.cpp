// Which handler gets a request, and which heads no handler ever sees.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "capstan/http/head_rules.h"
#include "capstan/http/kept_text.h"
#include "capstan/http/route_table.h"

namespace capstan::http {
namespace {

using testing::ElementsAre;

TEST(RouteTable, FindsByMethodAndPath) {
    RouteTable routes;
    routes.add("GET", "/", {}, 1);
    routes.add("GET", "/api/jobs/{job}", {}, 2);
    routes.add("POST", "/api/jobs/{job}/stop", {}, 3);
    routes.add("GET", "/api/configs/{name}", {}, 4);
    EXPECT_EQ(routes.find("GET", "/").entry->lane, 1U);
    EXPECT_EQ(routes.find("HEAD", "/").entry->lane, 1U);
    const auto job = routes.find("GET", "/api/jobs/12");
    EXPECT_EQ(job.entry->lane, 2U);
    EXPECT_THAT(job.path_values, ElementsAre("12"));
    EXPECT_THAT(routes.find("GET", "/api/configs/a b.toml").path_values, ElementsAre("a b.toml"));
    for (const char* path : {"", "//", "/api/jobs", "/api/jobs/", "/api/jobs/x", "/api/jobs/-1",
                             "/api/jobs/1/", "/api/configs/", "/api/configs/../x", "/api/jobs/1/stop/2"})
        EXPECT_EQ(routes.find("GET", path).entry, nullptr) << path;
    EXPECT_TRUE(routes.find("GET", "/api/jobs/1/stop").other_method);
    EXPECT_FALSE(routes.find("GET", "/api/jobs/x/stop").other_method);
}

Request head_with(std::vector<std::pair<std::string, std::string>> headers) {
    Request head;
    head.headers = std::move(headers);
    return head;
}

int status(const Request& head) {
    const auto problem = problem_of(head, {});
    return problem ? problem->status : 200;
}

TEST(HeadRules, RejectWhatCouldBeReadInTwoWays) {
    EXPECT_EQ(status(head_with({{"host", "a"}, {"content-length", "1"}})), 200);
    for (const char* name :
         {"host", "content-length", "origin", "authorization", "content-encoding", "expect"})
        EXPECT_EQ(status(head_with({{name, "1"}, {name, "1"}})), 400) << name;
    EXPECT_EQ(status(head_with({{"transfer-encoding", "chunked"}})), 411);
    for (const char* encoding : {"br", "gzip", "GZIP", "identity, br", "unknown"})
        EXPECT_EQ(status(head_with({{"content-encoding", encoding}})), 415) << encoding;
    EXPECT_EQ(status(head_with({{"content-encoding", "Identity"}})), 200);
    EXPECT_EQ(status(head_with({{"expect", "100-Continue"}})), 200);
    EXPECT_EQ(status(head_with({{"expect", "a cake"}})), 417);
    EXPECT_EQ(status(head_with({100, {"x", ""}})), 200);
    EXPECT_EQ(status(head_with({101, {"x", ""}})), 431);
}

TEST(HeadRules, CompressForThoseWhoAcceptIt) {
    for (const char* accepted : {"gzip", "gzip, deflate, br", "br;q=1, GZIP;q=0.5", "*"})
        EXPECT_TRUE(accepts_gzip(head_with({{"accept-encoding", accepted}}))) << accepted;
    for (const char* refused : {"", "br", "identity", "gzip;q=0", "gzip; q=0.000, br", "xgzip"})
        EXPECT_FALSE(accepts_gzip(head_with({{"accept-encoding", refused}}))) << refused;
}

TEST(KeptText, IsCompressedWithoutLoss) {
    std::string text;
    for (int k = 0; k < 5000; ++k) text += std::to_string(k) + " N\n";
    const KeptText kept(text);
    const std::string packed(kept.gzip());
    ASSERT_LT(packed.size(), text.size() / 2);
    z_stream stream{};
    ASSERT_EQ(::inflateInit2(&stream, 15 + 16), Z_OK);
    std::string again(text.size() + 1, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(again.data());
    stream.avail_out = static_cast<uInt>(again.size());
    EXPECT_EQ(::inflate(&stream, Z_FINISH), Z_STREAM_END);
    again.resize(stream.total_out);
    ::inflateEnd(&stream);
    EXPECT_EQ(again, text);
    EXPECT_EQ(kept.gzip().data(), kept.gzip().data());
    EXPECT_EQ(KeptText("short").gzip(), "");
}

}  // namespace
}  // namespace capstan::http
