#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/logs/byte_source.h"

namespace capstan::logs {

enum class TextEncoding { bytes, utf16_little_endian, utf16_big_endian };

/// The lines of a text file, whatever ends them (LF, CRLF, CR); UTF-16 with a byte-order mark arrives as
/// UTF-8, a byte-order mark is left out.
class TextLines {
  public:
    explicit TextLines(std::unique_ptr<ByteSource> source, const std::filesystem::path& path);

    /// The next line without its end; valid until the next call. False after the last. Throws InvalidInput
    /// for a line beyond the limit.
    bool next(std::string_view& line);
    /// Of the line that next() gave, from 1.
    std::size_t number() const { return number_; }
    /// Whether the line that next() gave has no line end: the last one, perhaps cut.
    bool is_unfinished() const { return is_unfinished_; }
    /// Of a compressed file: whether it ends before its data do.
    bool is_cut() const { return source_->is_cut(); }

  private:
    void refill();
    void append_utf8_of_utf16(std::string_view bytes);

    std::unique_ptr<ByteSource> source_;
    std::filesystem::path path_;
    TextEncoding encoding_ = TextEncoding::bytes;
    std::vector<char> block_;
    std::string text_;  ///< read, and from `at_` not yet handed out
    std::size_t at_ = 0;
    std::string odd_bytes_;  ///< of UTF-16: half a character
    char line_end_ = '\n';
    std::size_t number_ = 0;
    bool at_end_ = false;
    bool is_unfinished_ = false;
};

/// Bytes as UTF-8: as they are if they are that, else as Latin-1.
std::string as_utf8(std::string_view bytes);

}  // namespace capstan::logs
