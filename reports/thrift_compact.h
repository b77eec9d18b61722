#pragma once
// Thrift's compact protocol, as far as the headers of a Parquet file need it.

#include <cstdint>
#include <string>
#include <string_view>

namespace capstan::reports {

enum class ThriftType : std::uint8_t { i32 = 5, i64 = 6, binary = 8, list = 9, structure = 12 };

// Writes one structure's fields, in rising order of their ids; nested ones are written by hand in between.
class ThriftWriter {
  public:
    explicit ThriftWriter(std::string& bytes) : bytes_(bytes) {}

    void i32(int id, std::int32_t value) {
        field(id, ThriftType::i32);
        zigzag(value);
    }
    void i64(int id, std::int64_t value) {
        field(id, ThriftType::i64);
        zigzag(value);
    }
    void text(int id, std::string_view value) {
        field(id, ThriftType::binary);
        plain_text(value);
    }
    // Its elements follow: plain_i32, plain_text, or structures of their own.
    void list(int id, ThriftType elements, std::size_t size) {
        field(id, ThriftType::list);
        const auto type = static_cast<unsigned>(elements);
        if (size < 15) {
            bytes_ += static_cast<char>(size << 4 | type);
        } else {
            bytes_ += static_cast<char>(0xf0 | type);
            varint(size);
        }
    }
    // Its fields follow, by a writer of its own.
    void structure(int id) { field(id, ThriftType::structure); }
    void end() { bytes_ += '\0'; }

    void plain_i32(std::int32_t value) { zigzag(value); }
    void plain_text(std::string_view value) {
        varint(value.size());
        bytes_ += value;
    }

  private:
    void field(int id, ThriftType type) {
        bytes_ += static_cast<char>((id - last_id_) << 4 | static_cast<int>(type));
        last_id_ = id;
    }
    void zigzag(std::int64_t value) {
        varint(static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63));
    }
    void varint(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
        bytes_ += static_cast<char>(value);
    }

    std::string& bytes_;
    int last_id_ = 0;
};

}  // namespace capstan::reports
