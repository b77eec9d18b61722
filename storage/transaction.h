#pragma once
// All or nothing: what is not committed is rolled back when the scope ends, by return or by exception.

#include "capstan/storage/database.h"

namespace capstan::storage {

class Transaction {
  public:
    // IMMEDIATE takes the write lock now: a second writer waits here, not in the middle of its rows.
    explicit Transaction(Database& database) : database_(database) {
        database_.execute("BEGIN IMMEDIATE", "begin to write");
    }

    // Some errors (a full disk) have rolled back already; then SQLite is back in autocommit.
    ~Transaction() {
        if (!committed_ && sqlite3_get_autocommit(database_.connection()) == 0) {
            sqlite3_exec(database_.connection(), "ROLLBACK", nullptr, nullptr, nullptr);
        }
    }

    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;

    void commit() {
        database_.execute("COMMIT", "finish writing");
        committed_ = true;
        database_.require_in_place();
    }

  private:
    Database& database_;
    bool committed_ = false;
};

}  // namespace capstan::storage
