// What is kept of a job, and how a child's end is told.
#include <gtest/gtest.h>

#include "capstan/service/child_process.h"
#include "capstan/service/job.h"
#include "capstan/service/report_shelf.h"

namespace capstan::service {
namespace {

TEST(Jobs, ComeBackFromTheirText) {
    Job study;
    study.number = 3;
    study.title = "it's \"quoted\" – and more";
    study.file = "3/study.toml";
    study.state = JobState::running;
    study.last_before = 7;
    Job diagnosis = study;
    diagnosis.number = 4;
    diagnosis.kind = JobKind::diagnosis;
    diagnosis.state = JobState::failed;
    diagnosis.result_id = 12;
    diagnosis.message = "line 1\nline 2";
    EXPECT_EQ(read_jobs(jobs_text({study, diagnosis})), (std::vector{study, diagnosis}));
    EXPECT_TRUE(read_jobs(jobs_text({})).empty());
    for (const char* wrong : {"", "{", "[1]", R"([{"job": 1}])"})
        EXPECT_THROW(read_jobs(wrong), std::runtime_error);
}

TEST(AChildProcess, TellsItsWordsAndItsEnd) {
    std::vector<std::string> lines;
    ChildProcess child({"/bin/sh", "-c", "echo one >&2; echo unheard; printf 'two\\nthree' >&2; exit 7"});
    EXPECT_EQ(child.wait([&](const std::string& line) { lines.push_back(line); }), 7);
    EXPECT_EQ(lines, (std::vector<std::string>{"one", "two", "three"}));
}

TEST(AChildProcess, EndsWhenAskedTo) {
    ChildProcess child({"/bin/sh", "-c", "echo ready >&2; exec sleep 1000"});
    EXPECT_EQ(child.wait([&](const std::string&) { child.ask_to_stop(); }), 128 + 15);
}

TEST(AChildProcess, ThatCannotBeStartedSaysSo) {
    ChildProcess child({"/no/such/program"});
    EXPECT_EQ(child.wait([](const std::string&) {}), 127);
}

TEST(AReportShelf, KeepsATextAsLongAsItsStateIsTheSame) {
    using enum ReportShelf::Freshness;
    ReportShelf shelf;
    int made = 0;
    const auto make = [&] { return std::to_string(++made); };
    EXPECT_EQ(*shelf.get("a", "1 of 2", exact, make), "1");
    EXPECT_EQ(*shelf.get("a", "1 of 2", exact, make), "1");
    EXPECT_EQ(*shelf.get("b", "1 of 2", exact, make), "2");
    EXPECT_EQ(*shelf.get("a", "2 of 2", exact, make), "3");
}

TEST(AReportShelf, HasRoomForSoMuchAndDropsWhatNobodyHasAskedForTheLongest) {
    using enum ReportShelf::Freshness;
    ReportShelf shelf;
    int made = 0;
    const auto times_made = [&](const std::string& name, std::size_t bytes) {
        const int before = made;
        shelf.get(name, "complete", exact, [&] { return ++made, std::string(bytes, 'x'); });
        return made - before;
    };
    for (const char* name : {"a", "b", "c", "d"}) EXPECT_EQ(times_made(name, 4'000'000), 1);
    EXPECT_EQ(times_made("a", 4'000'000), 0);
    EXPECT_EQ(times_made("e", 4'000'000), 1);  // in the place of "b"
    EXPECT_EQ(times_made("a", 4'000'000), 0);
    EXPECT_EQ(times_made("b", 4'000'000), 1);
    EXPECT_EQ(times_made("too long", 4'000'001), 1);
    EXPECT_EQ(times_made("too long", 4'000'001), 1);
    for (int k = 0; k < 100; ++k) times_made(std::to_string(k), 1);  // many short ones
    EXPECT_EQ(times_made("99", 1), 0);
    EXPECT_EQ(times_made("0", 1), 1);
    // What cannot be made is not kept, however many ask for it.
    for (int k = 0; k < 100; ++k) {
        EXPECT_THROW(shelf.get("wrong " + std::to_string(k), "complete", exact,
                               []() -> std::string { throw std::runtime_error("no such table"); }),
                     std::runtime_error);
    }
}

}  // namespace
}  // namespace capstan::service
