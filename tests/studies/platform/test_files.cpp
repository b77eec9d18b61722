#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "capstan/platform/files.h"

namespace capstan {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
  protected:
    Files() {
        std::string pattern = (fs::temp_directory_path() / "capstan-files-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~Files() override { fs::remove_all(folder_); }

    int count() const {
        int entries = 0;
        for ([[maybe_unused]] const auto& each : fs::directory_iterator(folder_)) ++entries;
        return entries;
    }

    fs::path folder_;
};

mode_t mode_of(const fs::path& path) {
    struct stat status = {};
    ::stat(path.c_str(), &status);
    return status.st_mode & 07777;
}

TEST_F(Files, ReadsBackEveryByteThatWasWritten) {
    const std::string text = std::string("a\0b\r\n", 5) + std::string(3 << 20, 'x');
    write_file(folder_ / "file", text);
    EXPECT_EQ(read_file(folder_ / "file"), text);
    EXPECT_EQ(count(), 1);
}

TEST_F(Files, ReplacesAFileAndKeepsItsMode) {
    write_file(folder_ / "file", "before");
    ::chmod((folder_ / "file").c_str(), 0640);
    write_file(folder_ / "file", "after");
    EXPECT_EQ(read_file(folder_ / "file"), "after");
    EXPECT_EQ(mode_of(folder_ / "file"), 0640u);
    EXPECT_EQ(count(), 1);
}

TEST_F(Files, KeepsWhatWasThereWithoutFinish) {
    write_file(folder_ / "file", "before");
    {
        AtomicFile file(folder_ / "file");
        file.append(std::string(2 << 20, 'x'));
    }
    EXPECT_EQ(read_file(folder_ / "file"), "before");
    EXPECT_EQ(count(), 1);
}

TEST_F(Files, WritesThroughASymbolicLink) {
    write_file(folder_ / "file", "before");
    fs::create_symlink("file", folder_ / "link");
    write_file(folder_ / "link", "after");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(read_file(folder_ / "file"), "after");
}

TEST_F(Files, AKilledWriterLeavesNothing) {
    write_file(folder_ / "file", "before");
    const pid_t writer = ::fork();
    if (writer == 0) {
        AtomicFile file(folder_ / "file");
        file.append(std::string(2 << 20, 'x'));
        ::raise(SIGKILL);
    }
    ::waitpid(writer, nullptr, 0);
    write_file(folder_ / "file", "after");  // removes what a file system without nameless files keeps
    EXPECT_EQ(read_file(folder_ / "file"), "after");
    EXPECT_EQ(count(), 1);
}

TEST_F(Files, AStaleTemporaryIsRemovedByTheNextReplacement) {
    write_file(folder_ / "file", "before");
    write_file(folder_ / ".capstan-unfinished-0123456789abcdef", "left by a killed writer");
    write_file(folder_ / "file", "after");
    EXPECT_EQ(count(), 1);
}

TEST_F(Files, ManyWritersOfOneFileLeaveOneCompleteText) {
    std::vector<std::thread> writers;
    for (const char letter : {'a', 'b', 'c', 'd'}) {
        writers.emplace_back([this, letter] {
            for (int k = 0; k < 50; ++k) write_file(folder_ / "file", std::string(100'000, letter));
        });
    }
    for (std::thread& writer : writers) writer.join();
    const std::string text = read_file(folder_ / "file");
    EXPECT_EQ(text, std::string(100'000, text.at(0)));
    EXPECT_EQ(count(), 1);
}

std::string refusal(const std::function<void()>& work) {
    try {
        work();
    } catch (const std::runtime_error& problem) {
        return problem.what();
    }
    return "";
}

std::string refusal(const fs::path& path) {
    return refusal([&] { write_file(path, "x"); });
}

TEST_F(Files, SaysWhyAFileCannotBeWrittenAndWhatToTry) {
    EXPECT_NE(refusal(folder_ / "none" / "file").find("its folder does not exist; make it"),
              std::string::npos);
    EXPECT_NE(refusal(folder_).find("it is a folder; name a file in it"), std::string::npos);
    EXPECT_NE(refusal("/dev/full").find("the disk is full; free some space"), std::string::npos);
    EXPECT_THROW(read_file(folder_ / "none"), std::runtime_error);
    EXPECT_THROW(read_file(folder_), std::runtime_error);
}

TEST_F(Files, TellsBeforehandWhetherAFileCanBeWritten) {
    const auto refusal_beforehand = [](const fs::path& path) {
        return refusal([&] { require_writable(path); });
    };
    write_file(folder_ / "file", "kept");
    fs::create_symlink(folder_ / "file", folder_ / "link");
    for (const fs::path& path : {folder_ / "file", folder_ / "link", folder_ / "new", fs::path("/dev/null")})
        EXPECT_EQ(refusal_beforehand(path), "") << path;
    for (const fs::path& path : {folder_ / "none" / "file", folder_ / "file" / "file", folder_})
        EXPECT_EQ(refusal_beforehand(path), refusal(path)) << path;
    EXPECT_EQ(read_file(folder_ / "file"), "kept");
    EXPECT_FALSE(fs::exists(folder_ / "new"));
}

TEST_F(Files, RenamesAFinishedFile) {
    write_file(folder_ / "unfinished", "text");
    rename_durably(folder_ / "unfinished", folder_ / "file");
    EXPECT_EQ(read_file(folder_ / "file"), "text");
    EXPECT_EQ(count(), 1);
}

}  // namespace
}  // namespace capstan
