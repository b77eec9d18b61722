#include "capstan/storage/database.h"

#include "capstan/platform/files.h"
#include "capstan/storage/error.h"
#include "capstan/storage/file_identity.h"
#include "capstan/storage/health.h"
#include "capstan/storage/migration.h"
#include "capstan/storage/schema.h"
#include "capstan/storage/statement.h"
#include "capstan/storage/transaction.h"

namespace capstan::storage {
namespace {

constexpr int busy_timeout_ms =
    10'000;  // longer than any transaction of ours, shorter than a user's patience

int read_pragma(Database& database, const std::string& pragma) {
    Statement statement(database, "PRAGMA " + pragma);
    statement.step();
    return statement.get<int>(0);
}

bool has_no_tables(Database& database) {
    Statement statement(database, "SELECT 1 FROM sqlite_schema");
    return !statement.step();
}

// One transaction, so a killed creation leaves an empty file. The rollback journal is still in use here (not
// yet WAL), so that the marks of a finished creation are in the file's own header, where identify_file looks.
void create_schema_if_empty(Database& database) {
    if (read_pragma(database, "user_version") != 0) return;
    Transaction transaction(database);
    // Another process may have been faster: ours, or one that makes a database of its own.
    if (read_pragma(database, "user_version") != 0) return;
    if (!has_no_tables(database)) refuse_foreign(database.path(), {FileKind::foreign_database});
    database.execute(schema_text(), "create the tables");
    database.execute("PRAGMA application_id = " + std::to_string(application_id) +
                         "; PRAGMA user_version = " + std::to_string(schema_version),
                     "mark the new file");
    transaction.commit();
}

bool uses_write_ahead_log(Database& database) {
    Statement statement(database, "PRAGMA journal_mode");
    statement.step();
    return statement.get<std::string>(0) == "wal";
}

// Write-ahead log: readers and the writer do not wait for each other. NORMAL may lose the last commits in a
// power cut, never the file's consistency; a lost unit is a unit that resume computes again.
void use_write_ahead_log(Database& database) {
    // The switch needs the file for itself for a moment, and SQLite does not wait for that one by itself.
    constexpr int pause_ms = 10;
    for (int waited_ms = 0; !uses_write_ahead_log(database); waited_ms += pause_ms) {
        const int code =
            sqlite3_exec(database.connection(), "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr);
        if (code == SQLITE_OK)
            break;  // or the file system has no WAL: then the journal stays, which is as safe
        if ((code & 0xff) != SQLITE_BUSY || waited_ms >= busy_timeout_ms) {
            throw_sqlite_error(database.connection(), "switch to the write-ahead log");
        }
        sqlite3_sleep(pause_ms);
    }
    database.execute("PRAGMA synchronous = NORMAL", "set the write-ahead log");
}

void require_study_file(const std::filesystem::path& path, FileKind kind) {
    if (kind != FileKind::missing && kind != FileKind::empty) return;
    throw Error(path.string() + (kind == FileKind::missing ? " does not exist." : " holds no study yet.") +
                " `capstan study run` creates a results file.");
}

void require_our_schema(Database& database) {
    const std::vector<std::string> problems = schema_problems(database);
    if (problems.empty()) return;
    throw Error(database.path().string() + " is not as capstan makes it: " + problems.front() +
                (problems.size() > 1 ? ", and " + std::to_string(problems.size() - 1) + " more" : "") +
                ". `capstan doctor --db FILE` lists all; use a copy from before the change.");
}

// A URI, because only there SQLite can be told that nobody writes.
std::string immutable_uri(const std::filesystem::path& path) {
    std::string uri = "file:";
    for (const char c : path.string()) {
        if (c == '%')
            uri += "%25";
        else if (c == '?')
            uri += "%3f";
        else if (c == '#')
            uri += "%23";
        else
            uri += c;
    }
    return uri + "?immutable=1";
}

bool holds_bytes(const std::filesystem::path& path) {
    std::error_code none;
    const auto size = std::filesystem::file_size(path, none);
    return !none && size > 0;
}

bool can_be_read(Database& database) {
    return sqlite3_exec(database.connection(), "SELECT 1 FROM sqlite_schema", nullptr, nullptr, nullptr) ==
           SQLITE_OK;
}

// Takes everything into the file itself and empties its log. For a file that is about to get another name: a
// log stays under the old one, and what SQLite cannot write when a file is closed it keeps quiet about.
void fold_write_ahead_log(Database& database) {
    constexpr const char* doing = "take the log into the file";
    Statement statement(database, "PRAGMA wal_checkpoint(TRUNCATE)");
    statement.step(doing);
    if (statement.get<int>(0) != 0)
        throw Error(std::string("Cannot ") + doing + ": another program reads it.");
}

void remove_database(const std::filesystem::path& path) {
    for (const char* end : {"", "-wal", "-shm", "-journal"}) std::filesystem::remove(path.string() + end);
}

}  // namespace

Database::Database(const std::filesystem::path& path, const std::string& name, int open_flags) : path_(path) {
    sqlite3* connection = nullptr;
    const int code = sqlite3_open_v2(name.c_str(), &connection,
                                     open_flags | SQLITE_OPEN_EXRESCODE | SQLITE_OPEN_NOMUTEX, nullptr);
    connection_.reset(connection);
    if (!connection_) throw Error("Out of memory while opening " + path.string());
    if (code != SQLITE_OK) {
        throw Error("Cannot open " + path.string() +
                    ": check that its folder exists and that you may read and write there. (SQLite: " +
                    sqlite3_errmsg(connection) + ")");
    }
    sqlite3_busy_timeout(connection, busy_timeout_ms);
    // A damaged page is noticed before it is used.
    sqlite3_exec(connection, "PRAGMA cell_size_check = ON", nullptr, nullptr, nullptr);
}

Database Database::in_memory() {
    return {":memory:", ":memory:", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE};
}

Database Database::open_for_writing(const std::filesystem::path& path, int open_flags) {
    Database database(path, path.string(), SQLITE_OPEN_READWRITE | open_flags);
    if (database.is_read_only()) {
        throw Error(path.string() +
                    " may only be read. Change its permission, or use a copy in a folder of yours.");
    }
    database.execute("PRAGMA foreign_keys = ON", "open the file");
    return database;
}

Database Database::open_or_create(const std::filesystem::path& path, Journal journal) {
    refuse_foreign(path, identify_file(path));
    Database database = open_for_writing(path, SQLITE_OPEN_CREATE);
    create_schema_if_empty(database);
    migrate(database, migrations(), schema_version);
    require_our_schema(database);
    if (journal == Journal::write_ahead) use_write_ahead_log(database);
    return database;
}

Database Database::open_existing(const std::filesystem::path& path) {
    const FileIdentity identity = identify_file(path);
    refuse_foreign(path, identity);
    require_study_file(path, identity.kind);
    Database database = open_for_writing(path, 0);
    if (read_pragma(database, "user_version") == 0) require_study_file(path, FileKind::empty);
    migrate(database, migrations(), schema_version);
    require_our_schema(database);
    use_write_ahead_log(database);
    return database;
}

Database Database::open_read_only(const std::filesystem::path& path, SchemaCheck check) {
    const FileIdentity identity = identify_file(path);
    refuse_foreign(path, identity);
    require_study_file(path, identity.kind);
    Database database(path, path.string(), SQLITE_OPEN_READONLY);
    if (!can_be_read(database)) {
        // A log needs its -shm file beside the database, which a read-only disk does not let us make. Without
        // a log the database alone is complete: open it as immutable, that is, trust that nobody
        // starts to write while we read. A log that holds something is never passed over.
        if (sqlite3_errcode(database.connection()) == SQLITE_CORRUPT ||
            sqlite3_errcode(database.connection()) == SQLITE_BUSY || holds_bytes(path.string() + "-wal") ||
            holds_bytes(path.string() + "-journal")) {
            throw_sqlite_error(database.connection(), "read");
        }
        database = Database(path, immutable_uri(path), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
    }
    const int version = read_pragma(database, "user_version");
    if (version > schema_version) refuse_newer(path, version);
    if (version < schema_version) {
        throw Error(path.string() + " has the older schema version " + std::to_string(version) +
                    "; `capstan study resume` brings it to version " + std::to_string(schema_version) + ".");
    }
    if (check == SchemaCheck::compare) {
        require_our_schema(database);
        // A further view of the file may call no function that does more than compute. A writer needs
        // json_valid(), which SQLite does not count among those, for the checks of our tables.
        sqlite3_db_config(database.connection(), SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    }
    return database;
}

bool Database::is_read_only() const {
    return sqlite3_db_readonly(connection_.get(), "main") == 1;
}

void Database::require_in_place() {
    int has_moved = 0;
    sqlite3_file_control(connection(), "main", SQLITE_FCNTL_HAS_MOVED, &has_moved);
    if (has_moved != 0)
        throw Error(
            path_.string() +
            " was removed or renamed while it was written. Put it back under its name if you renamed it, "
            "and run the command again.");
}

void Database::execute(const std::string& sql, const char* doing) {
    if (sqlite3_exec(connection(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
        throw_sqlite_error(connection(), doing);
    }
}

void write_new_database(const std::filesystem::path& path, const std::function<bool(Database&)>& write) {
    if (std::filesystem::exists(path))
        throw Error(path.string() +
                    " exists already, and a merge makes a new file. Name another one, or remove it.");
    const std::filesystem::path unfinished = path.string() + ".unfinished";
    remove_database(unfinished);
    bool is_complete = false;
    try {
        Database database = Database::open_or_create(unfinished);
        is_complete = write(database);
        if (is_complete) fold_write_ahead_log(database);
    } catch (...) {
        remove_database(unfinished);
        throw;
    }
    if (is_complete)
        rename_durably(unfinished, path);
    else
        remove_database(unfinished);
}

}  // namespace capstan::storage
