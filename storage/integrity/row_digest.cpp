#include "capstan/storage/integrity/row_digest.h"

#include <openssl/evp.h>

#include <bit>
#include <cstring>

#include "capstan/storage/error.h"

namespace capstan::storage {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the bytes of numbers are hashed as they are in memory");

template <class Number>
void append_bytes(std::string& text, Number number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    text.append(bytes, sizeof number);
}

void require_crypto(int is_done) {
    if (is_done != 1) throw Error("libcrypto does not provide SHA-256. Is it installed completely?");
}

void append_name(std::string& text, std::string_view column, int type) {
    append_bytes(text, static_cast<std::uint32_t>(column.size()));
    text += column;
    text += static_cast<char>(type);
}

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

RowDigest::RowDigest() : context_(EVP_MD_CTX_new()) {
    begin();
}

void RowDigest::begin() {
    require_crypto(context_ ? EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) : 0);
    has_rows_ = false;
}

void RowDigest::add(std::string_view column, std::int64_t value) {
    append_name(pending_, column, SQLITE_INTEGER);
    append_bytes(pending_, value);
}

void RowDigest::add(std::string_view column, double value) {
    append_name(pending_, column, SQLITE_FLOAT);
    append_bytes(pending_, value + 0.0);  // SQLite keeps no negative zero
}

void RowDigest::add(std::string_view column, std::string_view value) {
    append_name(pending_, column, SQLITE_TEXT);
    append_bytes(pending_, static_cast<std::int64_t>(value.size()));
    pending_ += value;
}

void RowDigest::end_row() {
    constexpr std::size_t enough = 16'384;     // [bytes] for one call of the library
    append_bytes(pending_, std::uint32_t{0});  // no name: the end of the row
    has_rows_ = true;
    if (pending_.size() >= enough) flush();
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

void RowDigest::flush() {
    require_crypto(EVP_DigestUpdate(context_.get(), pending_.data(), pending_.size()));
    pending_.clear();
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
