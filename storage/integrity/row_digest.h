#pragma once
// SHA-256 over rows of tables in a form that depends on nothing but what is stored: not on the file, the
// order of columns, or the machine.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/storage/statement.h"

struct evp_md_ctx_st;  // of libcrypto

namespace capstan::storage {

using Sha256 = std::array<unsigned char, 32>;

/// 64 hexadecimal digits.
std::string hexadecimal(const Sha256& digest);

/// The digest of rows, one after the other. A value goes in with the name of its column, its type and all its
/// bits; NULL does not go in, so that a column which a later version adds, and which is NULL in older rows,
/// keeps their digest.
class RowDigest {
  public:
    RowDigest();

    /// The statement's current row; `columns` are the names of what it selects.
    void add_row(const Statement& row, const std::vector<std::string>& columns);

    /// The same value by value, in the order of the columns' names, as SQLite would keep them.
    void add(std::string_view column, std::int64_t value);
    void add(std::string_view column, double value);
    void add(std::string_view column, std::string_view value);
    void end_row();

    bool has_rows() const { return has_rows_; }

    /// Of all rows since the last call.
    Sha256 finish();

  private:
    struct Closer {
        void operator()(evp_md_ctx_st* context) const;
    };
    void begin();
    void flush();
    /// A place in the buffer for so many bytes; the caller writes them all.
    char* room(std::size_t bytes);

    std::unique_ptr<evp_md_ctx_st, Closer> context_;
    std::vector<char> buffer_;
    std::size_t used_ = 0;
    bool has_rows_ = false;
};

}  // namespace capstan::storage
