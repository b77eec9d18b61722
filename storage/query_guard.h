#pragma once
// What a guest's statement may do while it is prepared and run: read, for a while.

#include <sqlite3.h>

#include <chrono>

namespace capstan::storage {

class QueryGuard {
  public:
    QueryGuard(sqlite3* connection, double time_limit_s);
    ~QueryGuard();
    QueryGuard(const QueryGuard&) = delete;
    QueryGuard& operator=(const QueryGuard&) = delete;

    bool time_is_up() const { return time_is_up_; }

  private:
    static int stop_when_late(void* guard);

    sqlite3* connection_;
    std::chrono::steady_clock::time_point deadline_;  // the only clock of this room; nothing of it is stored
    bool time_is_up_ = false;
};

}  // namespace capstan::storage
