// ROS 1 bags.
#include "log_trial.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    capstan::fuzz::try_log(data, size, "#ROSBAG V2.0\n");
    return 0;
}
