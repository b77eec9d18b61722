#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>

namespace capstan::logs {

/// Reads little-endian numbers and pieces from bytes that nobody has checked. Beyond the end it gives zeros
/// and is_good() is false from then on.
class ByteCursor {
  public:
    explicit ByteCursor(std::string_view bytes) : bytes_(bytes) {}

    bool is_good() const { return good_; }
    bool at_end() const { return !good_ || at_ == bytes_.size(); }
    std::size_t position() const { return at_; }
    std::size_t left() const { return bytes_.size() - at_; }

    /// Of a trivially copyable number.
    template <typename Number>
    Number number() {
        Number value{};
        const std::string_view piece = take(sizeof value);
        if (good_) std::memcpy(&value, piece.data(), sizeof value);
        return value;
    }
    std::string_view take(std::uint64_t count) {
        if (!good_ || count > left()) {
            good_ = false;
            return {};
        }
        const std::string_view piece = bytes_.substr(at_, static_cast<std::size_t>(count));
        at_ += static_cast<std::size_t>(count);
        return piece;
    }
    /// A piece behind its length, of 32 bits.
    std::string_view prefixed() { return take(number<std::uint32_t>()); }

  private:
    std::string_view bytes_;
    std::size_t at_ = 0;
    bool good_ = true;
};

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "logs are little-endian and copied as they are");

}  // namespace capstan::logs
