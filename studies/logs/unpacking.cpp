#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>

#include "capstan/logs/byte_source.h"

namespace capstan::logs {

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
