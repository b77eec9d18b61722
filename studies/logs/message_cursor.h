#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "capstan/logs/message_definition.h"

namespace capstan::logs {

/// Through one message; false from any member: the bytes have run out.
class MessageCursor {
  public:
    MessageCursor(std::string_view bytes, MessageEncoding encoding)
        : bytes_(bytes), is_cdr_(encoding == MessageEncoding::cdr) {}

    // The four bytes in front of CDR: the order of bytes, and the alignment of eight-byte numbers.
    bool begin_cdr() {
        if (bytes_.size() < 4 || bytes_[0] != 0) return false;
        const auto kind = static_cast<unsigned char>(bytes_[1]);
        if (kind > 1 && kind != 6 && kind != 7) return false;
        is_swapped_ = (kind & 1) == 0;
        widest_ = kind >= 6 ? 4 : 8;
        bytes_.remove_prefix(4);
        return true;
    }

    bool take(std::size_t count, std::size_t alignment, const char*& piece) {
        const std::size_t step = std::min(alignment, widest_);
        if (is_cdr_ && count > 0) at_ = (at_ + step - 1) / step * step;
        if (at_ > bytes_.size() || count > bytes_.size() - at_) return false;
        piece = bytes_.data() + at_;
        at_ += count;
        return true;
    }

    template <typename Number>
    Number of(const char* piece) const {
        std::array<char, sizeof(Number)> bytes;
        std::memcpy(bytes.data(), piece, sizeof(Number));
        if (is_swapped_) std::reverse(bytes.begin(), bytes.end());
        return std::bit_cast<Number>(bytes);
    }

    bool count(std::uint32_t& number) {
        const char* piece = nullptr;
        if (!take(4, 4, piece)) return false;
        number = of<std::uint32_t>(piece);
        return true;
    }

    bool string(std::string_view& text) {
        std::uint32_t length = 0;
        const char* piece = nullptr;
        if (!count(length) || !take(length, 1, piece)) return false;
        text = {piece, length};
        if (is_cdr_ && text.ends_with('\0')) text.remove_suffix(1);
        return true;
    }

    std::size_t left() const { return bytes_.size() - at_; }

    double number(const char* piece, FieldKind kind) const {
        switch (kind) {
            case FieldKind::boolean:
                return *piece != 0 ? 1.0 : 0.0;
            case FieldKind::int8:
                return of<std::int8_t>(piece);
            case FieldKind::uint8:
                return of<std::uint8_t>(piece);
            case FieldKind::int16:
                return of<std::int16_t>(piece);
            case FieldKind::uint16:
                return of<std::uint16_t>(piece);
            case FieldKind::int32:
                return of<std::int32_t>(piece);
            case FieldKind::uint32:
                return of<std::uint32_t>(piece);
            case FieldKind::int64:
                return static_cast<double>(of<std::int64_t>(piece));
            case FieldKind::uint64:
                return static_cast<double>(of<std::uint64_t>(piece));
            case FieldKind::float32:
                return of<float>(piece);
            case FieldKind::float64:
                return of<double>(piece);
            case FieldKind::time:
                return of<std::uint32_t>(piece) + 1e-9 * of<std::uint32_t>(piece + 4);
            case FieldKind::duration:
                // ROS 2 has unsigned nanoseconds, ROS 1 signed ones; both are below 2^31.
                return of<std::int32_t>(piece) + 1e-9 * of<std::int32_t>(piece + 4);
            case FieldKind::string:
            case FieldKind::message:
                break;
        }
        return 0.0;
    }

  private:
    std::string_view bytes_;
    bool is_cdr_;
    bool is_swapped_ = false;
    std::size_t widest_ = 8;
    std::size_t at_ = 0;
};

}  // namespace capstan::logs
