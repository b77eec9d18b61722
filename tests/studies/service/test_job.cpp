// What is stored of a job, and how long the text of a report is kept.
#include <gtest/gtest.h>

#include "capstan/service/job.h"
#include "capstan/service/report_shelf.h"

namespace capstan::service {
namespace {

TEST(Jobs, SurviveTheirJson) {
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

TEST(ReportShelf, KeepsATextUntilItsStateChanges) {
    using enum ReportShelf::Freshness;
    ReportShelf shelf;
    int made = 0;
    const auto make = [&] { return std::to_string(++made); };
    EXPECT_EQ(shelf.get("a", "1 of 2", exact, make)->plain(), "1");
    EXPECT_EQ(shelf.get("a", "1 of 2", exact, make)->plain(), "1");
    EXPECT_EQ(shelf.get("b", "1 of 2", exact, make)->plain(), "2");
    EXPECT_EQ(shelf.get("a", "2 of 2", exact, make)->plain(), "3");
}

TEST(ReportShelf, DropsTheLeastRecentlyUsedTexts) {
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
