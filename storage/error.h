#pragma once
// The one exception of this room. Its message says what is wrong, where, and what to try.

#include <stdexcept>
#include <string_view>

struct sqlite3;

namespace capstan::storage {

class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Says in our words what SQLite just reported on this connection; 'doing' reads "write the results of unit
// 3".
[[noreturn]] void throw_sqlite_error(sqlite3* connection, std::string_view doing);

}  // namespace capstan::storage
