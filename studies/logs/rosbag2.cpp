// The SQLite files of rosbag2: topics, and messages in CDR. The file is anybody's: what it defines is not
// run.
#include <fmt/format.h>
#include <sqlite3.h>

#include <map>
#include <memory>
#include <optional>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/byte_source.h"
#include "capstan/logs/message_table.h"
#include "capstan/logs/text_lines.h"

namespace capstan::logs {

namespace {

constexpr std::size_t max_topics = 4096;
constexpr std::size_t rows_between_progress = 4096;

struct CloseDatabase {
    void operator()(sqlite3* connection) const { sqlite3_close(connection); }
};
struct EndStatement {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, EndStatement>;

std::string bytes_in(sqlite3_stmt* statement, int column) {
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, column));
    const int count = sqlite3_column_bytes(statement, column);
    return bytes ? std::string(bytes, static_cast<std::size_t>(count)) : std::string();
}

class Rosbag2Reading {
  public:
    Rosbag2Reading(const std::filesystem::path& path, const ReadOptions& options, Log& log)
        : path_(path), options_(options), writer_(log, options), tables_(writer_) {
        open();
    }

    void read() {
        if (!is_table("topics") || !is_table("messages"))
            throw InvalidInput(
                {fmt::format("{}: is an SQLite file without the tables 'topics' and 'messages' of a "
                             "rosbag2; export what it holds as CSV",
                             path_.string())});
        read_definitions();
        read_topics();
        read_messages();
        tables_.end();
    }

  private:
    void open() {
        sqlite3* connection = nullptr;
        // Messages that still wait in a "-wal" file beside it count too.
        const int code = sqlite3_open_v2(path_.c_str(), &connection, SQLITE_OPEN_READONLY, nullptr);
        connection_.reset(connection);
        if (code != SQLITE_OK || !connection) refuse("cannot be opened");
        sqlite3_db_config(connection, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
        sqlite3_db_config(connection, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
        sqlite3_db_config(connection, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
        sqlite3_db_config(connection, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
        sqlite3_limit(connection, SQLITE_LIMIT_LENGTH, static_cast<int>(LogLimits::message_bytes));
        sqlite3_limit(connection, SQLITE_LIMIT_ATTACHED, 0);
        sqlite3_exec(connection, "PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0", nullptr, nullptr,
                     nullptr);
    }

    [[noreturn]] void refuse(const char* what) const {
        throw InvalidInput({fmt::format("{}: the rosbag2 {}: {}", path_.string(), what,
                                        connection_ ? sqlite3_errmsg(connection_.get()) : "out of memory")});
    }

    Statement prepared(const char* sql) const {
        sqlite3_stmt* statement = nullptr;
        if (sqlite3_prepare_v2(connection_.get(), sql, -1, &statement, nullptr) != SQLITE_OK)
            refuse("cannot be read");
        return Statement(statement);
    }

    // A table that SQLite stores: not a view, not a virtual table.
    bool is_table(const char* name) const {
        const Statement statement = prepared(
            "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = ?1 AND rootpage > 0");
        sqlite3_bind_text(statement.get(), 1, name, -1, SQLITE_STATIC);
        return sqlite3_step(statement.get()) == SQLITE_ROW && sqlite3_column_int(statement.get(), 0) == 1;
    }

    // Written since ROS 2 Iron.
    void read_definitions() {
        if (!is_table("message_definitions")) return;
        const Statement statement =
            prepared("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
        while (definitions_.size() < max_topics && sqlite3_step(statement.get()) == SQLITE_ROW)
            if (bytes_in(statement.get(), 1) == "ros2msg")
                definitions_[bytes_in(statement.get(), 0)] = bytes_in(statement.get(), 2);
    }

    void read_topics() {
        const Statement statement = prepared("SELECT id, name, type, serialization_format FROM topics");
        int code = SQLITE_OK;
        while ((code = sqlite3_step(statement.get())) == SQLITE_ROW) {
            const std::int64_t id = sqlite3_column_int64(statement.get(), 0);
            const std::string name = bytes_in(statement.get(), 1);
            const std::string type = bytes_in(statement.get(), 2);
            const std::string encoding = bytes_in(statement.get(), 3);
            if (topics_.size() >= max_topics || name.size() > LogLimits::name_bytes ||
                type.size() > LogLimits::name_bytes)
                throw InvalidInput(
                    {fmt::format("{}: has more than {} topics, or one with a name of more than {} bytes",
                                 path_.string(), max_topics, LogLimits::name_bytes)});
            MessageTable*& table = topics_[id];
            if (encoding != "cdr") {
                tables_.leave_out(name, fmt::format("its messages are written in '{}'; cdr can be read",
                                                    as_utf8(encoding.substr(0, 40))));
                continue;
            }
            const auto definition = definitions_.find(type);
            table = tables_.table(name, type, definition == definitions_.end() ? "" : definition->second,
                                  MessageDialect::ros2, MessageEncoding::cdr);
        }
        if (code != SQLITE_DONE) refuse("is damaged or cut in its list of topics");
    }

    void read_messages() {
        const std::int64_t last = last_message();
        const Statement statement =
            prepared("SELECT id, topic_id, timestamp, data FROM messages ORDER BY rowid");
        std::size_t messages = 0, unknown = 0;
        int code = SQLITE_OK;
        while ((code = sqlite3_step(statement.get())) == SQLITE_ROW) {
            if (++messages % rows_between_progress == 0 && options_.on_progress && last > 0)
                options_.on_progress(
                    std::min(1.0, static_cast<double>(messages) / static_cast<double>(last)));
            const auto found = topics_.find(sqlite3_column_int64(statement.get(), 1));
            unknown += found == topics_.end() ? 1 : 0;
            if (found == topics_.end() || !found->second) continue;
            const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement.get(), 3));
            const auto count = static_cast<std::size_t>(sqlite3_column_bytes(statement.get(), 3));
            found->second->take(static_cast<std::uint64_t>(sqlite3_column_int64(statement.get(), 2)),
                                bytes ? std::string_view(bytes, count) : std::string_view());
        }
        if (unknown > 0)
            writer_.remark(fmt::format(
                "{} messages are of topics that the file does not describe; they are left out", unknown));
        if (code == SQLITE_DONE) return;
        if (messages == 0) refuse("is damaged or cut before its first message");
        writer_.remark(fmt::format("The file is damaged or cut ({}); the {} messages before that are read",
                                   sqlite3_errmsg(connection_.get()), messages));
    }

    // To tell how far the reading is; 0 where the file does not say.
    std::int64_t last_message() const {
        const Statement statement = prepared("SELECT max(rowid) FROM messages");
        return sqlite3_step(statement.get()) == SQLITE_ROW ? sqlite3_column_int64(statement.get(), 0) : 0;
    }

    std::filesystem::path path_;
    const ReadOptions& options_;
    TableWriter writer_;
    MessageTables tables_;
    std::unique_ptr<sqlite3, CloseDatabase> connection_;
    std::map<std::string, std::string> definitions_;  ///< types
    std::map<std::int64_t, MessageTable*> topics_;    ///< null: left out
};

bool is_rosbag2(std::string_view head, const std::filesystem::path&) {
    return head.starts_with(std::string_view("SQLite format 3\0", 16));
}

void read_rosbag2(const std::filesystem::path& path, const ReadOptions& options, Log& log) {
    Rosbag2Reading(path, options, log).read();
}

}  // namespace

const LogFormat rosbag2_format{"rosbag2", ".db3", is_rosbag2, read_rosbag2};

}  // namespace capstan::logs
