// The SQLite files of rosbag2.
#include "log_trial.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    capstan::fuzz::try_log(data, size, {"SQLite format 3\0", 16});
    return 0;
}
