#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace capstan::http {

/// A text that is sent many times. It is compressed once, when a client first accepts that. For any thread.
class KeptText {
  public:
    explicit KeptText(std::string text) : owned_(std::move(text)), plain_(owned_) {}
    /// A text that outlives everything, as a file in the program. It is not copied.
    static std::shared_ptr<const KeptText> of_program(std::string_view text);
    KeptText(const KeptText&) = delete;
    KeptText& operator=(const KeptText&) = delete;

    std::string_view plain() const { return plain_; }

    /// In the format of gzip; empty if that would be no shorter.
    std::string_view gzip() const;

  private:
    KeptText() = default;

    std::string owned_;
    std::string_view plain_;
    mutable std::once_flag once_;
    mutable std::string gzip_;
};

/// The text in the format of gzip (RFC 1952). Throws std::runtime_error if memory is short.
std::string gzip_of(std::string_view text);

}  // namespace capstan::http
