// Files that are not logs, or claim what they do not hold.
#include <gmock/gmock.h>

#include <csignal>

#include "capstan/logs/byte_source.h"
#include "capstan/logs/isolated.h"
#include "sample_log.h"

namespace capstan::logs {
namespace {

using testing::HasSubstr;

TEST(OtherFiles, AreRefusedWithWhatToDo) {
    EXPECT_THAT(refusal_of("\x28\xb5\x2f\xfd\x04 rest"), HasSubstr("unpack it with 'zstd -d'"));
    EXPECT_THAT(refusal_of(std::string("\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\0", 9)),
                HasSubstr("save the sheet as CSV"));
    EXPECT_THAT(refusal_of("#ROSBAG V1.2\n"), HasSubstr("rosbag fix"));
    EXPECT_THAT(refusal_of(std::string("\0\0\0garbage", 10)), HasSubstr("in none of the formats"));
    EXPECT_THROW(read_log(testing::TempDir()), InvalidInput);
    EXPECT_THROW(read_log("/there/is/no/such/file"), InvalidInput);
}

TEST(Isolated, HandsOverEveryNumberAndRemark) {
    Log log;
    log.file = "some.mat";
    ReadOptions options;
    std::vector<double> told;
    options.on_progress = [&](double fraction) { told.push_back(fraction); };
    read_isolated(log, options, [](const ReadOptions& own, Log& inner) {
        own.on_progress(0.5);
        inner.format = "of a test";
        LogTable& table = inner.tables.emplace_back();
        table.name = "run";
        table.add_column("x", "N", inner.store);
        table.add_column("y", "", inner.store);
        for (int row = 0; row < 10'000; ++row) {
            table.columns[0].values.append(row * 0.1);
            table.columns[1].values.append(-row);
        }
        table.rows = 10'000;
        inner.remarks.emplace_back("one thing");
    });
    EXPECT_EQ(log.format, "of a test");
    EXPECT_EQ(log.tables.at(0).rows, 10'000u);
    EXPECT_EQ(log.tables[0].columns[0].unit, "N");
    EXPECT_EQ(numbers_in(log.tables[0], "x").at(9'999), 9'999 * 0.1);
    EXPECT_EQ(numbers_in(log.tables[0], "y").at(9'999), -9'999.0);
    EXPECT_EQ(log.remarks, std::vector<std::string>{"one thing"});
    EXPECT_EQ(told, std::vector<double>{0.5});
}

TEST(Isolated, ACrashOfALibraryIsARefusal) {
    Log log;
    log.file = "some.mat";
    log.format = "MATLAB";
    const auto refusal = [&](const std::function<void()>& what) -> std::string {
        try {
            read_isolated(log, {}, [&](const ReadOptions&, Log&) { what(); });
        } catch (const InvalidInput& why) {
            return why.what();
        }
        return "";
    };
    EXPECT_THAT(refusal([] { std::abort(); }),
                HasSubstr("some.mat: the library that reads MATLAB files failed on it"));
    EXPECT_THAT(refusal([] { raise(SIGSEGV); }), HasSubstr("failed on it"));
    EXPECT_THAT(refusal([] { throw std::runtime_error("some.mat: is odd"); }), HasSubstr("is odd"));
}

TEST(Unpacking, StopsAtTheLimitAndAtDamage) {
    EXPECT_FALSE(unpack_zstd("no frame at all", 1000).is_complete);
    EXPECT_FALSE(unpack_lz4("no frame at all", 1000).is_complete);
    EXPECT_FALSE(unpack_bzip2("no stream at all", 1000).is_complete);
    EXPECT_EQ(unpack_bzip2("", 1000).bytes, "");
}

}  // namespace
}  // namespace capstan::logs
