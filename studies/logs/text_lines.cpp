#include "capstan/logs/text_lines.h"

#include <fmt/format.h>

#include <cstring>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/log.h"

namespace capstan::logs {

namespace {

constexpr std::size_t text_block_bytes = 1u << 20;

void append_utf8(std::string& text, std::uint32_t letter) {
    const auto tail = [&](int shift) { text += static_cast<char>(0x80 | ((letter >> shift) & 0x3f)); };
    if (letter < 0x80) {
        text += static_cast<char>(letter);
    } else if (letter < 0x800) {
        text += static_cast<char>(0xc0 | (letter >> 6));
        tail(0);
    } else if (letter < 0x10000) {
        text += static_cast<char>(0xe0 | (letter >> 12));
        tail(6), tail(0);
    } else {
        text += static_cast<char>(0xf0 | (letter >> 18));
        tail(12), tail(6), tail(0);
    }
}

bool is_utf8(std::string_view bytes) {
    for (std::size_t k = 0; k < bytes.size();) {
        const auto lead = static_cast<unsigned char>(bytes[k++]);
        int tails = lead < 0x80                   ? 0
                    : lead >= 0xf0 && lead < 0xf5 ? 3
                    : lead >= 0xe0                ? 2
                    : lead >= 0xc2                ? 1
                                                  : -1;
        if (tails < 0 || lead >= 0xf5) return false;
        for (; tails > 0; --tails, ++k)
            if (k == bytes.size() || (static_cast<unsigned char>(bytes[k]) & 0xc0) != 0x80) return false;
    }
    return true;
}

}  // namespace

TextLines::TextLines(std::unique_ptr<ByteSource> source, const std::filesystem::path& path)
    : source_(std::move(source)), path_(path), block_(text_block_bytes) {
    refill();
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
    // Old instruments end lines with a lone CR.
    if (text_.find('\n') == std::string::npos && text_.find('\r') != std::string::npos) line_end_ = '\r';
}

void TextLines::refill() {
    text_.erase(0, at_);
    at_ = 0;
    const std::size_t got = source_->read(block_.data(), block_.size());
    if (got < block_.size()) at_end_ = true;
    std::string_view bytes(block_.data(), got);
    if (number_ == 0 && text_.empty() && encoding_ == TextEncoding::bytes) {
        if (bytes.starts_with("\xff\xfe")) encoding_ = TextEncoding::utf16_little_endian;
        if (bytes.starts_with("\xfe\xff")) encoding_ = TextEncoding::utf16_big_endian;
        if (encoding_ != TextEncoding::bytes) bytes.remove_prefix(2);
    }
    if (encoding_ == TextEncoding::bytes)
        text_.append(bytes);
    else
        append_utf8_of_utf16(bytes);
}

void TextLines::append_utf8_of_utf16(std::string_view bytes) {
    odd_bytes_.append(bytes);
    const auto unit = [&](std::size_t k) {
        const auto first = static_cast<unsigned char>(odd_bytes_[k]);
        const auto second = static_cast<unsigned char>(odd_bytes_[k + 1]);
        return static_cast<std::uint32_t>(
            encoding_ == TextEncoding::utf16_little_endian ? first | second << 8 : first << 8 | second);
    };
    std::size_t k = 0;
    while (k + 2 <= odd_bytes_.size()) {
        std::uint32_t letter = unit(k);
        if (letter >= 0xd800 && letter < 0xdc00) {
            if (k + 4 > odd_bytes_.size() && !at_end_) break;
            const std::uint32_t second = k + 4 <= odd_bytes_.size() ? unit(k + 2) : 0;
            if (second >= 0xdc00 && second < 0xe000) {
                letter = 0x10000 + ((letter - 0xd800) << 10) + (second - 0xdc00);
                k += 2;
            } else {
                letter = 0xfffd;
            }
        } else if (letter >= 0xdc00 && letter < 0xe000) {
            letter = 0xfffd;
        }
        append_utf8(text_, letter);
        k += 2;
    }
    odd_bytes_.erase(0, k);
}

bool TextLines::next(std::string_view& line) {
    for (std::size_t searched = 0;;) {
        const char* begin = text_.data() + at_;
        const std::size_t left = text_.size() - at_;
        const char* end = static_cast<const char*>(std::memchr(begin + searched, line_end_, left - searched));
        std::size_t length = end ? static_cast<std::size_t>(end - begin) : left;
        if (!end && !at_end_) {
            if (left > LogLimits::line_bytes) break;
            searched = left;
            refill();
            continue;
        }
        if (!end && left == 0) return false;
        if (length > LogLimits::line_bytes) break;
        is_unfinished_ = end == nullptr;
        at_ += length + (end ? 1 : 0);
        if (length > 0 && begin[length - 1] == '\r') --length;
        line = {begin, length};
        ++number_;
        return true;
    }
    throw InvalidInput({fmt::format("{}: line {} has more than {} bytes; is it a text file with lines?",
                                    path_.string(), number_ + 1, LogLimits::line_bytes)});
}

std::string as_utf8(std::string_view bytes) {
    if (is_utf8(bytes)) return std::string(bytes);
    std::string text;
    for (const char byte : bytes) append_utf8(text, static_cast<unsigned char>(byte));
    return text;
}

}  // namespace capstan::logs
