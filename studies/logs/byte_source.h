#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace capstan::logs {

/// Bytes in order, from a file or out of a compressed one.
class ByteSource {
  public:
    virtual ~ByteSource() = default;
    /// Fills `to` with up to `count` bytes; fewer only at the end. Throws InvalidInput.
    virtual std::size_t read(char* to, std::size_t count) = 0;
    /// Whether it ended before its compressed data did.
    virtual bool is_cut() const { return false; }
};

/// A file, read from the beginning, with its progress told every few megabytes.
class FileSource final : public ByteSource {
  public:
    explicit FileSource(const std::filesystem::path& path,
                        std::function<void(double fraction)> on_progress = {});
    std::size_t read(char* to, std::size_t count) override;

    std::uint64_t size_bytes() const { return size_bytes_; }
    std::uint64_t position() const { return position_; }
    void seek(std::uint64_t position);

  private:
    std::filesystem::path path_;
    std::function<void(double)> on_progress_;
    std::ifstream file_;
    std::uint64_t size_bytes_ = 0;
    std::uint64_t position_ = 0;
    std::uint64_t told_ = 0;
};

/// A file as it is, or unpacked where it is compressed with gzip. A gzip file that unpacks to far more than
/// any log would is refused.
std::unique_ptr<ByteSource> open_source(const std::filesystem::path& path,
                                        std::function<void(double fraction)> on_progress);

/// Whether a file that begins so is compressed with gzip.
bool is_gzip(std::string_view head);

/// The first bytes of a source's content, unpacked; empty where it cannot be unpacked.
std::string unpacked_head(std::string_view packed_head);

/// A compressed chunk, unpacked as far as it goes.
struct Unpacked {
    std::string bytes;
    bool is_complete = false;  ///< false: damaged or cut, or more than the limit
};

/// At most `limit_bytes` are unpacked. LZ4 and zstd in their frame formats, as bags and MCAP files have them.
Unpacked unpack_bzip2(std::string_view packed, std::size_t limit_bytes);
Unpacked unpack_lz4(std::string_view packed, std::size_t limit_bytes);
Unpacked unpack_zstd(std::string_view packed, std::size_t limit_bytes);

}  // namespace capstan::logs
