#include "capstan/storage/query_guard.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace capstan::storage {
namespace {

constexpr int steps_between_looks = 1000;  // of SQLite's machine: far below a millisecond

// They reach outside the database, or load code, in some builds of SQLite.
constexpr std::array<std::string_view, 6> refused_functions{"load_extension", "readfile", "writefile",
                                                            "edit",           "eval",     "fts3_tokenizer"};

// They describe the schema; all of them only read.
constexpr std::array<std::string_view, 8> allowed_pragmas{"table_info",       "table_xinfo",  "table_list",
                                                          "index_list",       "index_info",   "index_xinfo",
                                                          "foreign_key_list", "database_list"};

template <std::size_t Count>
bool contains(const std::array<std::string_view, Count>& names, const char* name) {
    if (name == nullptr) return false;
    return std::any_of(names.begin(), names.end(),
                       [name](std::string_view other) { return sqlite3_stricmp(other.data(), name) == 0; });
}

// SQLite asks about every single thing a statement wants to do. Writing, ATTACH and all else is denied by not
// being on the list.
int judge(void*, int action, const char* first, const char* second, const char*, const char*) {
    switch (action) {
        case SQLITE_SELECT:
        case SQLITE_READ:
        case SQLITE_RECURSIVE:
            return SQLITE_OK;
        case SQLITE_FUNCTION:
            return contains(refused_functions, second) ? SQLITE_DENY : SQLITE_OK;
        case SQLITE_PRAGMA:
            return contains(allowed_pragmas, first) ? SQLITE_OK : SQLITE_DENY;
        case SQLITE_UPDATE:
            // json_each and pragma_table_info ask this when they declare their columns, and do not do it. A
            // guest's own UPDATE of the schema is refused by SQLite itself (defensive, read-only).
            return std::string_view(first) == "sqlite_master" ? SQLITE_OK : SQLITE_DENY;
        default:
            return SQLITE_DENY;
    }
}

}  // namespace

QueryGuard::QueryGuard(sqlite3* connection, double time_limit_s)
    : connection_(connection),
      deadline_(std::chrono::steady_clock::now() +
                std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                    std::chrono::duration<double>(time_limit_s))) {
    sqlite3_db_config(connection_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_set_authorizer(connection_, judge, nullptr);
    sqlite3_progress_handler(connection_, steps_between_looks, stop_when_late, this);
}

QueryGuard::~QueryGuard() {
    sqlite3_progress_handler(connection_, 0, nullptr, nullptr);
    sqlite3_set_authorizer(connection_, nullptr, nullptr);
}

int QueryGuard::stop_when_late(void* guard) {
    auto* self = static_cast<QueryGuard*>(guard);
    self->time_is_up_ = std::chrono::steady_clock::now() > self->deadline_;
    return self->time_is_up_ ? 1 : 0;
}

}  // namespace capstan::storage
