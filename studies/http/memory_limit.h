#pragma once

#include <atomic>
#include <cstddef>

namespace capstan::http {

/// Bytes that all connections together may hold.
class MemoryLimit {
  public:
    explicit MemoryLimit(std::size_t bytes) : most_(bytes) {}

    /// False if that would be too much; then nothing is taken.
    bool take(std::size_t bytes) {
        const std::size_t before = held_.fetch_add(bytes);
        if (before + bytes <= most_) return true;
        held_.fetch_sub(bytes);
        return false;
    }
    void give_back(std::size_t bytes) { held_.fetch_sub(bytes); }

  private:
    std::size_t most_;
    std::atomic<std::size_t> held_{0};
};

}  // namespace capstan::http
