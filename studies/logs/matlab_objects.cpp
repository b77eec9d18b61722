#include "capstan/logs/matlab_objects.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>

#include "capstan/logs/byte_cursor.h"
#include "capstan/logs/byte_source.h"
#include "capstan/logs/text_lines.h"

namespace capstan::logs {

namespace {

// Of the format, "MAT-File Level 5 File Format", tables 1-1 and 1-3; objects are class 17 without being in
// it.
constexpr std::uint32_t matrix_element = 14;
constexpr std::uint32_t packed_element = 15;
constexpr std::uint32_t object_class = 17;
constexpr std::size_t matlab5_head_bytes = 128;
constexpr std::size_t looked_at_bytes = 512;  // of a variable: its class and names stand first
constexpr std::size_t max_named = 20;

std::string beginning_unpacked(const std::string& packed) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) return {};
    std::string bytes(looked_at_bytes, '\0');
    std::string own = packed;
    stream.next_in = reinterpret_cast<Bytef*>(own.data());
    stream.avail_in = static_cast<uInt>(own.size());
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = static_cast<uInt>(bytes.size());
    inflate(&stream, Z_SYNC_FLUSH);
    bytes.resize(bytes.size() - stream.avail_out);
    inflateEnd(&stream);
    return bytes;
}

// The content of the next part of a matrix; up to four bytes may stand within its head.
std::string_view next_part(ByteCursor& cursor) {
    const auto type = cursor.number<std::uint32_t>();
    if (type >> 16 != 0) return cursor.take(4).substr(0, type >> 16);
    const auto size = cursor.number<std::uint32_t>();
    const std::string_view content = cursor.take(size);
    cursor.take(-size % 8);
    return content;
}

// Empty where the variable is not an object. `bytes`: behind the head of its matrix.
std::string object_in(std::string_view bytes) {
    ByteCursor cursor(bytes);
    ByteCursor flags(next_part(cursor));
    if ((flags.number<std::uint32_t>() & 0xff) != object_class) return "";
    const std::string name(next_part(cursor));
    next_part(cursor);  // "MCOS"
    const std::string its_class(next_part(cursor));
    if (!cursor.is_good() || name.empty() || its_class.empty()) return "";
    return fmt::format("{} (an object of the class {})", as_utf8(name), as_utf8(its_class));
}

}  // namespace

std::vector<std::string> matlab_objects(const std::filesystem::path& path) {
    std::vector<std::string> objects;
    FileSource file(path);
    std::string bytes(matlab5_head_bytes, '\0');
    if (file.read(bytes.data(), bytes.size()) < bytes.size() || !bytes.ends_with("IM")) return objects;
    while (objects.size() < max_named && file.position() < file.size_bytes()) {
        bytes.assign(looked_at_bytes, '\0');
        const std::uint64_t begin = file.position();
        bytes.resize(file.read(bytes.data(), bytes.size()));
        ByteCursor head(bytes);
        const auto type = head.number<std::uint32_t>();
        const auto size = head.number<std::uint32_t>();
        if (!head.is_good() || size > file.size_bytes() - begin) break;
        std::string content = bytes.substr(8, size);
        if (type == packed_element) {
            content = beginning_unpacked(content);
            content.erase(0, std::min<std::size_t>(8, content.size()));
        }
        if (type == matrix_element || type == packed_element) {
            std::string object = object_in(content);
            if (!object.empty()) objects.push_back(std::move(object));
        }
        file.seek(begin + 8 + size);
    }
    return objects;
}

}  // namespace capstan::logs
