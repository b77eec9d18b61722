// Progress of work that many threads do.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include "capstan/platform/parallel_for.h"
#include "capstan/platform/work_meter.h"

namespace capstan {
namespace {

const auto until_the_next_look = std::chrono::milliseconds(110);

TEST(WorkMeter, CountsTheWorkOfEveryThreadAndNeverFalls) {
    std::vector<double> shown;
    WorkMeter meter([&](double fraction) { shown.push_back(fraction); });
    const MeterScope scope(&meter);
    expect_work(8);
    parallel_for_each_index(4, 2, [](int) {
        std::this_thread::sleep_for(until_the_next_look);
        note_work();
    });
    expect_work(24);  // it shows that there is more to do
    std::this_thread::sleep_for(until_the_next_look);
    note_work();
    ASSERT_FALSE(shown.empty());
    EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end()));
    EXPECT_GT(shown.back(), 0.12);
    EXPECT_LE(shown.back(), 0.625);
}

TEST(WorkMeter, IsNotDoneBeforeTheCommandSaysSo) {
    double shown = 0.0;
    WorkMeter meter([&](double fraction) { shown = fraction; });
    meter.expect(1);
    meter.note(5);
    EXPECT_LT(shown, 1.0);
}

TEST(WorkMeter, IsReplannedByTheWork) {
    double shown = 0.0;
    WorkMeter meter([&](double fraction) { shown = fraction; });
    meter.expect(1000);
    meter.note(10);
    std::this_thread::sleep_for(until_the_next_look);
    meter.replan(0.25);
    EXPECT_DOUBLE_EQ(shown, 0.25);
}

TEST(WorkMeter, WithoutAScopeNothingIsCounted) {
    expect_work(1);
    note_work();
    int looks = 0;
    WorkMeter meter([&](double) { ++looks; });
    const MeterScope counted(&meter);
    {
        const MeterScope uncounted(nullptr);
        expect_work(1);
        note_work();
    }
    EXPECT_EQ(looks, 0);
    EXPECT_EQ(MeterScope::meter(), &meter);
}

}  // namespace
}  // namespace capstan
