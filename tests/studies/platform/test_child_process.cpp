#include <gtest/gtest.h>

#include <stdexcept>

#include "capstan/platform/child_process.h"

namespace capstan {
namespace {

TEST(ChildProcess, ReturnsTheExitCodeAndBothStreams) {
    const CommandOutput done = run_command({"sh", "-c", "echo answer; echo message >&2; exit 7"});
    EXPECT_EQ(done.exit_code, 7);
    EXPECT_EQ(done.output, "answer\n");
    EXPECT_EQ(done.messages, "message\n");
}

TEST(ChildProcess, ReadsLargeOutputOfBothStreams) {
    const CommandOutput done =
        run_command({"sh", "-c", "head -c 300000 /dev/zero; head -c 300000 /dev/zero >&2; echo end"});
    EXPECT_EQ(done.output.size(), 300'004u);
    EXPECT_EQ(done.messages.size(), 300'000u);
}

TEST(ChildProcess, HandsOverEachLineOfStandardError) {
    std::vector<std::string> lines;
    ChildProcess child({"sh", "-c", "printf 'one\\ntwo\\n\\nlast' >&2"});
    const CommandOutput done = child.wait([&](const std::string& line) { lines.push_back(line); });
    EXPECT_EQ(lines, (std::vector<std::string>{"one", "two", "", "last"}));
    EXPECT_EQ(done.messages, "");
}

TEST(ChildProcess, RefusesAProgramThatCannotBeStarted) {
    EXPECT_THROW(run_command({"/no/such/program"}), std::runtime_error);
    EXPECT_THROW(run_command({"capstan-no-such-program"}), std::runtime_error);
}

TEST(ChildProcess, StopsOnRequestAndWithItsOwner) {
    ChildProcess child({"sleep", "60"});
    child.ask_to_stop();
    EXPECT_EQ(child.wait().exit_code, 128 + 15);
    ChildProcess{{"sleep", "60"}};
}

TEST(ChildProcess, FindsProgramsOnThePath) {
    EXPECT_TRUE(is_on_path("sh"));
    EXPECT_FALSE(is_on_path("capstan-no-such-program"));
}

}  // namespace
}  // namespace capstan
