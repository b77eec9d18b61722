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

}  // namespace
}  // namespace capstan::service
