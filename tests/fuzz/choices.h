#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>

namespace capstan::fuzz {

/// A string of bytes read as decisions, so that a seeded driver and a coverage-guided fuzzer can both feed
/// the same bench. A string that has run out goes on with zeros.
class Choices {
  public:
    explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    bool used_up() const { return next_ >= bytes_.size(); }

    /// 0 to 1, 1 excluded.
    double unit() {
        std::uint32_t word = 0;
        const std::size_t left = used_up() ? 0 : bytes_.size() - next_;
        if (left > 0) std::memcpy(&word, bytes_.data() + next_, left < sizeof word ? left : sizeof word);
        next_ += sizeof word;
        return word * 0x1p-32;
    }
    double between(double low, double high) { return low + (high - low) * unit(); }
    /// Every decade as likely as every other.
    double over_decades(double low, double high) { return low * std::pow(high / low, unit()); }
    int below(int count) { return static_cast<int>(count * unit()); }
    bool one_in(int count) { return below(count) == count - 1; }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t next_ = 0;
};

}  // namespace capstan::fuzz
