#include <gtest/gtest.h>

#include "capstan/platform/progress.h"

namespace capstan {
namespace {

TEST(Progress, AnEventSurvivesItsJson) {
    ProgressEvent counted = counted_progress("study \"quick\"\n", 3, 4, "units");
    counted.seconds_left = 2.5;
    EXPECT_EQ(read_progress_json(progress_json(counted)), counted);
    ProgressEvent uncounted;
    uncounted.activity = "fitting viscous friction";
    uncounted.fraction = 0.25;
    EXPECT_EQ(read_progress_json(progress_json(uncounted)), uncounted);
}

TEST(Progress, EveryEventHasTheSameKeys) {
    EXPECT_EQ(progress_json(counted_progress("quick", 1, 4, "units")),
              R"({"event":"progress","activity":"quick","fraction":0.25,"done":1,"total":4,"items":"units",)"
              R"("seconds_left":null})");
}

TEST(Progress, OtherLinesAreNotEvents) {
    for (const char* line :
         {"", "words", "[1]", "{}", R"({"event":"complete"})", R"({"event":"progress"})",
          R"({"event":"progress","activity":1,"fraction":"x","items":null,"seconds_left":null})"})
        EXPECT_FALSE(read_progress_json(line)) << line;
}

TEST(Progress, SaysHowMuchIsDoneAndHowLongTheRestTakes) {
    ProgressEvent event = counted_progress("quick", 1, 4, "units");
    EXPECT_EQ(progress_words(event), "1 of 4 units");
    event.seconds_left = 200;
    EXPECT_EQ(progress_words(event), "1 of 4 units, about 3 min left");
    event.max_seconds_left = 400;
    EXPECT_EQ(progress_words(event), "1 of 4 units, about 3 min to 7 min left");
    EXPECT_EQ(read_progress_json(progress_json(event)), event);
    event.seconds_left = 0;
    EXPECT_EQ(progress_words(event), "1 of 4 units, at most 7 min left");
    event.max_seconds_left.reset();
    event.items.clear();
    event.seconds_left = 4000;
    EXPECT_EQ(progress_words(event), "25%, about 67 min left");
}

}  // namespace
}  // namespace capstan
