#pragma once

#include "capstan/logs/log.h"

namespace capstan::logs {

// One row for each reader; log_formats() has them in order.
extern const LogFormat ros_bag_format;
extern const LogFormat mcap_format;
extern const LogFormat rosbag2_format;
extern const LogFormat text_format;

}  // namespace capstan::logs
