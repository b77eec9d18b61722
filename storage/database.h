#pragma once
// An open results file: it exists, it is capstan's, and its schema is the one this program knows.
// One thread at a time: every thread that wants to read opens its own.

#include <sqlite3.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace capstan::storage {

// How a file stays consistent while it is written.
enum class Journal {
    write_ahead,  // readers never wait; only for programs on one machine
    rollback,  // for a shared disk, where programs on several machines may open the file, one after the other
};

// Whether a file is refused whose tables and views are not those that capstan makes: see schema_problems().
enum class SchemaCheck { compare, none };

class Database {
  public:
    // Every factory refuses a file that is not capstan's, or is of a newer schema, before SQLite touches it:
    // such a file keeps every byte. What a file's own schema says is never trusted.

    // For writing. A file that is missing, or empty because its creation was killed, gets the schema.
    static Database open_or_create(const std::filesystem::path& path, Journal journal = Journal::write_ahead);

    // For writing. An older schema is migrated.
    static Database open_existing(const std::filesystem::path& path);

    // For reading, also while another process writes, and also from a read-only disk.
    static Database open_read_only(const std::filesystem::path& path,
                                   SchemaCheck check = SchemaCheck::compare);

    // Without tables, and gone with the object.
    static Database in_memory();

    const std::filesystem::path& path() const { return path_; }
    bool is_read_only() const;
    sqlite3* connection() { return connection_.get(); }

    // An Error if the file was removed or renamed since it was opened: what is written then is lost.
    void require_in_place();

    // Runs statements that return nothing of interest. 'doing' completes "cannot ..." in an Error.
    void execute(const std::string& sql, const char* doing);

  private:
    struct Closer {
        void operator()(sqlite3* connection) const { sqlite3_close_v2(connection); }
    };

    Database(const std::filesystem::path& path, const std::string& name, int open_flags);
    static Database open_for_writing(const std::filesystem::path& path, int open_flags);

    std::filesystem::path path_;
    std::unique_ptr<sqlite3, Closer> connection_;
};

// Makes a new file that is written completely or not at all: under another name, until `write` has returned
// true. An Error if the file exists already.
void write_new_database(const std::filesystem::path& path, const std::function<bool(Database&)>& write);

}  // namespace capstan::storage
