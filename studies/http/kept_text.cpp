#include "capstan/http/kept_text.h"

#include <zlib.h>

#include <stdexcept>

namespace capstan::http {

namespace {

constexpr std::size_t shortest = 1000;  // below, a client gains nothing
constexpr int gzip_window = 15 + 16;    // zlib: the largest window, and the head of gzip
constexpr int gzip_memory = 8;          // zlib's default

}  // namespace

std::string gzip_of(std::string_view text) {
    z_stream stream{};
    if (::deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_window, gzip_memory,
                       Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("out of memory while a text is compressed");
    std::string packed(::deflateBound(&stream, text.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    const int code = ::deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    ::deflateEnd(&stream);
    if (code != Z_STREAM_END) throw std::runtime_error("a text cannot be compressed");
    return packed;
}

std::shared_ptr<const KeptText> KeptText::of_program(std::string_view text) {
    const std::shared_ptr<KeptText> kept(new KeptText);
    kept->plain_ = text;
    return kept;
}

std::string_view KeptText::gzip() const {
    std::call_once(once_, [this] {
        if (plain_.size() < shortest) return;
        std::string packed = gzip_of(plain_);
        if (packed.size() >= plain_.size()) return;
        packed.shrink_to_fit();
        gzip_ = std::move(packed);
    });
    return gzip_;
}

}  // namespace capstan::http
