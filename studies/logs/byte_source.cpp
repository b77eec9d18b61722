#include "capstan/logs/byte_source.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan::logs {

namespace {

constexpr std::uint64_t progress_step_bytes = 8u << 20;
constexpr std::size_t gzip_block_bytes = 256u << 10;
// gzip packs a log of text two to thirty times; a thousand times is what a bomb does.
constexpr std::uint64_t gzip_free_bytes = 64u << 20;
constexpr std::uint64_t gzip_ratio = 100;

class GzipSource final : public ByteSource {
  public:
    GzipSource(const std::filesystem::path& path, std::function<void(double)> on_progress)
        : path_(path), packed_(path, std::move(on_progress)), input_(gzip_block_bytes) {
        if (inflateInit2(&stream_, 16 + MAX_WBITS) != Z_OK) throw std::bad_alloc();
    }
    ~GzipSource() override { inflateEnd(&stream_); }
    GzipSource(const GzipSource&) = delete;
    GzipSource& operator=(const GzipSource&) = delete;

    std::size_t read(char* to, std::size_t count) override {
        std::size_t got = 0;
        while (got < count && !ended_) {
            if (stream_.avail_in == 0) refill();
            is_cut_ = stream_.avail_in == 0;
            if (is_cut_) break;
            stream_.next_out = reinterpret_cast<Bytef*>(to + got);
            stream_.avail_out = static_cast<uInt>(std::min<std::size_t>(count - got, 1u << 30));
            const uInt before = stream_.avail_out;
            const int result = inflate(&stream_, Z_NO_FLUSH);
            got += before - stream_.avail_out;
            if (result == Z_STREAM_END)
                next_member();
            else if (result != Z_OK && result != Z_BUF_ERROR)
                throw InvalidInput(
                    {fmt::format("{}: the gzip data are damaged after {} unpacked bytes; "
                                 "copy the file again",
                                 path_.string(), unpacked_ + got)});
        }
        unpacked_ += got;
        if (unpacked_ > gzip_free_bytes + gzip_ratio * packed_.size_bytes())
            throw InvalidInput(
                {fmt::format("{}: unpacks to more than {} times its size, as no log does; "
                             "unpack it with gunzip if it is one",
                             path_.string(), gzip_ratio)});
        return got;
    }

    bool is_cut() const override { return is_cut_; }

  private:
    void refill() {
        stream_.avail_in = static_cast<uInt>(packed_.read(input_.data(), input_.size()));
        stream_.next_in = reinterpret_cast<Bytef*>(input_.data());
    }

    // A gzip file may be several, one after the other; what follows the last is not read, as gunzip does.
    void next_member() {
        if (stream_.avail_in == 0) refill();
        if (stream_.avail_in == 0 || stream_.next_in[0] != 0x1f || inflateReset(&stream_) != Z_OK)
            ended_ = true;
    }

    std::filesystem::path path_;
    FileSource packed_;
    std::vector<char> input_;
    z_stream stream_{};
    bool ended_ = false;
    bool is_cut_ = false;
    std::uint64_t unpacked_ = 0;
};

}  // namespace

FileSource::FileSource(const std::filesystem::path& path, std::function<void(double)> on_progress)
    : path_(path), on_progress_(std::move(on_progress)), file_(path, std::ios::binary) {
    std::error_code error;
    if (file_) size_bytes_ = std::filesystem::file_size(path, error);
    if (!file_ || error)
        throw InvalidInput({fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))});
}

std::size_t FileSource::read(char* to, std::size_t count) {
    file_.read(to, static_cast<std::streamsize>(count));
    const auto got = static_cast<std::size_t>(file_.gcount());
    if (file_.bad()) throw InvalidInput({fmt::format("{}: cannot be read any further", path_.string())});
    position_ += got;
    if (on_progress_ && size_bytes_ > 0 && position_ >= told_ + progress_step_bytes) {
        told_ = position_;
        on_progress_(std::min(1.0, static_cast<double>(position_) / static_cast<double>(size_bytes_)));
    }
    return got;
}

void FileSource::seek(std::uint64_t position) {
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(position));
    position_ = position;
}

bool is_gzip(std::string_view head) {
    return head.starts_with("\x1f\x8b");
}

std::unique_ptr<ByteSource> open_source(const std::filesystem::path& path,
                                        std::function<void(double)> on_progress) {
    auto plain = std::make_unique<FileSource>(path, on_progress);
    char head[2] = {};
    const std::size_t got = plain->read(head, sizeof head);
    if (is_gzip({head, got})) return std::make_unique<GzipSource>(path, std::move(on_progress));
    plain->seek(0);
    return plain;
}

std::string unpacked_head(std::string_view packed_head) {
    z_stream stream{};
    if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) return {};
    std::string head(4096, '\0');
    std::string packed(packed_head);
    stream.next_in = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(head.data());
    stream.avail_out = static_cast<uInt>(head.size());
    inflate(&stream, Z_SYNC_FLUSH);
    head.resize(head.size() - stream.avail_out);
    inflateEnd(&stream);
    return head;
}

namespace {

constexpr std::size_t unpacking_step_bytes = 1u << 20;
constexpr int zstd_window_log = 27;  // 128 MiB, what every reader of zstd grants

// Makes room for the next piece and says how much; none beyond the limit.
std::size_t grow(std::string& bytes, std::size_t used, std::size_t limit_bytes) {
    const std::size_t step =
        std::min(std::max(unpacking_step_bytes, used), limit_bytes - std::min(used, limit_bytes));
    bytes.resize(used + step);
    return step;
}

}  // namespace

Unpacked unpack_bzip2(std::string_view packed, std::size_t limit_bytes) {
    Unpacked unpacked;
    bz_stream stream{};
    if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
    const std::unique_ptr<bz_stream, int (*)(bz_stream*)> end(&stream, BZ2_bzDecompressEnd);
    stream.next_in = const_cast<char*>(packed.data());
    stream.avail_in = static_cast<unsigned>(packed.size());
    std::size_t used = 0;
    for (int result = BZ_OK; result == BZ_OK;) {
        const std::size_t room = grow(unpacked.bytes, used, limit_bytes);
        stream.next_out = unpacked.bytes.data() + used;
        stream.avail_out = static_cast<unsigned>(room);
        result = BZ2_bzDecompress(&stream);
        used += room - stream.avail_out;
        unpacked.is_complete = result == BZ_STREAM_END;
        if (room == 0 || (result == BZ_OK && stream.avail_in == 0 && stream.avail_out > 0)) break;
    }
    unpacked.bytes.resize(used);
    return unpacked;
}

Unpacked unpack_lz4(std::string_view packed, std::size_t limit_bytes) {
    Unpacked unpacked;
    LZ4F_dctx* made = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION))) throw std::bad_alloc();
    const std::unique_ptr<LZ4F_dctx, std::size_t (*)(LZ4F_dctx*)> context(made,
                                                                          LZ4F_freeDecompressionContext);
    std::size_t used = 0;
    while (true) {
        std::size_t room = grow(unpacked.bytes, used, limit_bytes);
        const bool is_full = room == 0;
        std::size_t taken = packed.size();
        const std::size_t hint = LZ4F_decompress(context.get(), unpacked.bytes.data() + used, &room,
                                                 packed.data(), &taken, nullptr);
        if (LZ4F_isError(hint)) break;
        used += room;
        packed.remove_prefix(taken);
        unpacked.is_complete = hint == 0;
        if (unpacked.is_complete || is_full || (taken == 0 && room == 0)) break;
    }
    unpacked.bytes.resize(used);
    return unpacked;
}

Unpacked unpack_zstd(std::string_view packed, std::size_t limit_bytes) {
    Unpacked unpacked;
    const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                               ZSTD_freeDStream);
    if (!stream) throw std::bad_alloc();
    ZSTD_DCtx_setParameter(stream.get(), ZSTD_d_windowLogMax, zstd_window_log);
    ZSTD_inBuffer input{packed.data(), packed.size(), 0};
    std::size_t used = 0;
    while (true) {
        const std::size_t room = grow(unpacked.bytes, used, limit_bytes);
        ZSTD_outBuffer output{unpacked.bytes.data() + used, room, 0};
        const std::size_t taken_before = input.pos;
        const std::size_t hint = ZSTD_decompressStream(stream.get(), &output, &input);
        if (ZSTD_isError(hint)) break;
        used += output.pos;
        unpacked.is_complete = hint == 0 && input.pos == input.size;
        if (unpacked.is_complete || room == 0 || (output.pos == 0 && input.pos == taken_before)) break;
    }
    unpacked.bytes.resize(used);
    return unpacked;
}

}  // namespace capstan::logs
