// Forms with files, as browsers send them and as nobody should.
#include <gtest/gtest.h>

#include "capstan/http/multipart.h"

namespace capstan::http {
namespace {

const std::string type = "multipart/form-data; boundary=\"line\"";

TEST(Form, HasItsPartsWithTheirBytes) {
    const std::string bytes("a\r\n--lin\r\n\0b", 12);
    const std::string body =
        "--line\r\nContent-Disposition: form-data; name=\"log\"; filename=\"a;b.csv\"\r\nContent-Type: "
        "text/csv\r\n\r\n" +
        bytes + "\r\n--line\r\ncontent-disposition: form-data; name=kind\r\n\r\n\r\n--line--\r\n";
    const auto parts = parse_form(type, body);
    ASSERT_TRUE(parts);
    ASSERT_EQ(parts->size(), 2U);
    EXPECT_EQ(parts->at(0).name, "log");
    EXPECT_EQ(parts->at(0).filename, "a;b.csv");
    EXPECT_EQ(parts->at(0).content, bytes);
    EXPECT_EQ(parts->at(1).name, "kind");
    EXPECT_EQ(parts->at(1).content, "");
}

TEST(Form, WithoutPartsIsEmpty) {
    EXPECT_TRUE(parse_form(type, "--line--\r\n")->empty());
}

TEST(Form, ThatIsDamagedIsRejected) {
    const std::string part = "--line\r\nContent-Disposition: form-data; name=\"a\"\r\n\r\n1";
    for (const std::string& body : std::vector<std::string>{
             "", "--line", "--line\r\n", "--line\r\n\r\n", "nothing", part, part + "\r\n--line",
             part + "\r\n--line\r\n", "--line\r\nContent-Disposition: form-data\r\n\r\n1\r\n--line--\r\n",
             "--line\r\n\r\n1\r\n--line--\r\n", part + "\r\n--linex", "--line\r\n" + std::string(5000, 'x')})
        EXPECT_FALSE(parse_form(type, body)) << body;
    EXPECT_FALSE(parse_form("multipart/form-data", part + "\r\n--line--\r\n"));
    EXPECT_FALSE(parse_form("multipart/form-data; boundary=" + std::string(71, 'x'), part));
}

TEST(Form, HasALimitedNumberOfParts) {
    const std::string part = "--line\r\nContent-Disposition: form-data; name=\"a\"\r\n\r\n1\r\n";
    std::string body;
    for (std::size_t k = 0; k < max_form_parts; ++k) body += part;
    EXPECT_TRUE(parse_form(type, body + "--line--\r\n"));
    EXPECT_FALSE(parse_form(type, body + part + "--line--\r\n"));
}

}  // namespace
}  // namespace capstan::http
