#include "capstan/storage/integrity/row_digest.h"

#include <openssl/evp.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "capstan/storage/error.h"

namespace capstan::storage {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the bytes of numbers are hashed as they are in memory");

// Both return the place behind what they wrote.
template <class Number>
char* write_bytes(char* to, Number number) {
    std::memcpy(to, &number, sizeof number);
    return to + sizeof number;
}

char* write_bytes(char* to, std::string_view text) {
    return std::copy(text.begin(), text.end(), to);
}

void require_crypto(int is_done) {
    if (is_done != 1) throw Error("libcrypto does not provide SHA-256. Is it installed completely?");
}

std::size_t bytes_of_name(std::string_view column) {
    return sizeof(std::uint32_t) + column.size() + 1;
}

char* write_name(char* to, std::string_view column, int type) {
    to = write_bytes(write_bytes(to, static_cast<std::uint32_t>(column.size())), column);
    *to = static_cast<char>(type);
    return to + 1;
}

constexpr std::size_t usual_buffer = 32'768;  // [bytes] for one call of the library

}  // namespace

std::string hexadecimal(const Sha256& digest) {
    constexpr const char* digits = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : digest) {
        text += digits[byte >> 4];
        text += digits[byte & 15];
    }
    return text;
}

void RowDigest::Closer::operator()(evp_md_ctx_st* context) const {
    EVP_MD_CTX_free(context);
}

RowDigest::RowDigest() : context_(EVP_MD_CTX_new()), buffer_(usual_buffer) {
    begin();
}

void RowDigest::begin() {
    require_crypto(context_ ? EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) : 0);
    has_rows_ = false;
}

void RowDigest::add(std::string_view column, std::int64_t value) {
    write_bytes(write_name(room(bytes_of_name(column) + sizeof value), column, SQLITE_INTEGER), value);
}

void RowDigest::add(std::string_view column, double value) {
    write_bytes(write_name(room(bytes_of_name(column) + sizeof value), column, SQLITE_FLOAT),
                value + 0.0);  // SQLite keeps no negative zero
}

void RowDigest::add(std::string_view column, std::string_view value) {
    const auto size = static_cast<std::int64_t>(value.size());
    char* const to =
        write_name(room(bytes_of_name(column) + sizeof size + value.size()), column, SQLITE_TEXT);
    write_bytes(write_bytes(to, size), value);
}

void RowDigest::end_row() {
    constexpr std::uint32_t no_name = 0;  // the end of the row
    write_bytes(room(sizeof no_name), no_name);
    has_rows_ = true;
}

void RowDigest::add_row(const Statement& row, const std::vector<std::string>& columns) {
    sqlite3_stmt* const values = row.handle();
    for (std::size_t k = 0; k < columns.size(); ++k) {
        const int column = static_cast<int>(k);
        const int type = sqlite3_column_type(values, column);
        if (type == SQLITE_INTEGER) {
            add(columns[k], static_cast<std::int64_t>(sqlite3_column_int64(values, column)));
        } else if (type == SQLITE_FLOAT) {
            add(columns[k], sqlite3_column_double(values, column));
        } else if (type != SQLITE_NULL) {
            const void* const bytes = sqlite3_column_blob(values, column);  // of a text: its bytes
            add(columns[k], {static_cast<const char*>(bytes),
                             static_cast<std::size_t>(sqlite3_column_bytes(values, column))});
        }
    }
    end_row();
}

char* RowDigest::room(std::size_t bytes) {
    if (used_ + bytes > buffer_.size()) {
        flush();
        if (bytes > buffer_.size()) buffer_.resize(bytes);
    }
    char* const at = buffer_.data() + used_;
    used_ += bytes;
    return at;
}

void RowDigest::flush() {
    require_crypto(EVP_DigestUpdate(context_.get(), buffer_.data(), used_));
    used_ = 0;
}

Sha256 RowDigest::finish() {
    flush();
    Sha256 digest{};
    unsigned int size = 0;
    require_crypto(EVP_DigestFinal_ex(context_.get(), digest.data(), &size));
    begin();
    return digest;
}

}  // namespace capstan::storage
