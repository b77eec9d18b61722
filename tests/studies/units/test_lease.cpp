#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <latch>
#include <thread>
#include <vector>

#include "capstan/units/lease.h"

namespace capstan::units {
namespace {

namespace fs = std::filesystem;

// An empty folder of each test, gone after it.
class Leases : public ::testing::Test {
  protected:
    static fs::path folder_of_test() {
        return fs::path(::testing::TempDir()) / ("capstan-lease-" + std::to_string(::getpid()));
    }
    Leases() : folder_(folder_of_test()) {
        fs::remove_all(folder_);
        fs::create_directory(folder_);
    }
    ~Leases() override { fs::remove_all(folder_); }

    DiskFolder leases{folder_of_test()};
    fs::path file() const { return folder_ / "3.lease"; }
    const fs::path& folder() const { return folder_; }

  private:
    fs::path folder_;
};

void write_stale_lease(const fs::path& file) {
    std::ofstream(file) << "node1-17 0\n";
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1));
}

TEST_F(Leases, AStaleOneIsGivenToOneOfManyWorkers) {
    for (int round = 0; round < 50; ++round) {
        write_stale_lease(file());
        constexpr int workers = 8;
        std::latch begin(workers);
        std::vector<std::optional<Lease>> claimed;
        claimed.reserve(workers);
        for (int k = 0; k < workers; ++k) claimed.emplace_back();
        std::vector<std::thread> threads;
        for (int k = 0; k < workers; ++k)
            threads.emplace_back([&, k] {
                begin.arrive_and_wait();
                if (auto lease = Lease::claim(leases, "3.lease"))
                    claimed[static_cast<std::size_t>(k)].emplace(std::move(*lease));
            });
        for (std::thread& thread : threads) thread.join();
        EXPECT_EQ(1, std::count_if(claimed.begin(), claimed.end(),
                                   [](const auto& each) { return each.has_value(); }));
    }
}

// A folder in which, after the first look at a file's time, another worker takes the lease over.
class Overtaken final : public SharedFolder {
  public:
    explicit Overtaken(SharedFolder& folder) : folder_(folder) {}
    std::string worker() const override { return "slow-1"; }
    double now_s() override { return folder_.now_s(); }
    void pause(double seconds) override { folder_.pause(seconds); }
    bool create(const std::string& name, const std::string& text) override {
        return folder_.create(name, text);
    }
    void replace(const std::string& name, const std::string& text) override { folder_.replace(name, text); }
    std::optional<std::string> read(const std::string& name) override { return folder_.read(name); }
    std::optional<double> modified_s(const std::string& name) override {
        const auto time_s = folder_.modified_s(name);
        if (!other_) other_.emplace(Lease::claim(folder_, name));
        return time_s;
    }
    std::vector<std::string> names() override { return folder_.names(); }
    bool rename(const std::string& from, const std::string& to) override {
        was_moved_ = true;
        return folder_.rename(from, to);
    }
    bool link(const std::string& from, const std::string& to) override { return folder_.link(from, to); }
    bool remove(const std::string& name) noexcept override { return folder_.remove(name); }
    std::unique_ptr<Heart> beat(const std::string& name) override { return folder_.beat(name); }

    bool other_has_it() const { return other_ && *other_; }
    bool was_moved() const { return was_moved_; }

  private:
    SharedFolder& folder_;
    std::optional<std::optional<Lease>> other_;
    bool was_moved_ = false;
};

TEST_F(Leases, AWorkerThatSawAStaleOneDoesNotTakeItFromTheOneThatTookItOver) {
    write_stale_lease(file());
    Overtaken overtaken(leases);
    EXPECT_FALSE(Lease::claim(overtaken, "3.lease"));
    EXPECT_TRUE(overtaken.other_has_it());
    EXPECT_FALSE(overtaken.was_moved());  // a third worker could claim it meanwhile
}

TEST_F(Leases, AWorkerThatDiedWhileTakingOverDoesNotKeepOthersFromIt) {
    write_stale_lease(file());
    write_stale_lease(folder() / "3.lease.takeover");
    EXPECT_TRUE(Lease::claim(leases, "3.lease"));
    EXPECT_TRUE(fs::is_empty(folder()));
}

TEST_F(Leases, OneOfALivingWorkerIsNotTaken) {
    const auto held = Lease::claim(leases, "3.lease");
    ASSERT_TRUE(held);
    EXPECT_FALSE(Lease::claim(leases, "3.lease"));
    EXPECT_TRUE(fs::exists(file()));
}

TEST_F(Leases, ThatEndLeaveNothingBehind) {
    write_stale_lease(file());
    { const auto lease = Lease::claim(leases, "3.lease"); }
    EXPECT_TRUE(fs::is_empty(folder()));
}

}  // namespace
}  // namespace capstan::units
