#pragma once

#include <atomic>

namespace capstan::cli {

/// While it lives, the first Ctrl-C or request to terminate only sets a flag; a second one ends the program
/// at once, which loses no more than the unit under way.
class StopRequest {
  public:
    StopRequest();
    ~StopRequest();
    StopRequest(const StopRequest&) = delete;
    StopRequest& operator=(const StopRequest&) = delete;

    static const std::atomic<bool>* flag();
};

}  // namespace capstan::cli
