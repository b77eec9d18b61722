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
