#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "capstan/logs/message_definition.h"
#include "capstan/logs/table_writer.h"

namespace capstan::logs {

class MessageCursor;

/// The messages of one topic as a table: log_time, then every number of the message by its path
/// ("wrench.force.x", "data.0"). Arrays of a message that has names for their elements (JointState) are
/// called by them: "position.knee". Times are seconds. Text and bytes are left out.
class MessageTable {
  public:
    MessageTable(TableWriter& writer, const std::string& topic, MessageDefinition definition,
                 MessageEncoding encoding);

    /// One row; a message that is not as its type says is counted and left out.
    void take(std::uint64_t log_time_ns, std::string_view message);
    /// Remarks on what was left out.
    void end();

  private:
    /// Where the numbers of a field go; made when they are first met.
    struct Slot {
        static constexpr int not_made = -2;
        int column = not_made;
        std::vector<Slot> children;        ///< fields of a message, elements of an array of messages
        std::vector<int> columns;          ///< elements of an array of numbers
        std::string names;                 ///< those for which `columns` stands
        std::map<std::string, int> named;  ///< columns
    };

    bool read_message(MessageCursor& cursor, const MessageType& type, const std::string& path, Slot& slot);
    bool read_field(MessageCursor& cursor, const MessageField& field, const std::string& path, Slot& slot);
    bool read_messages(MessageCursor& cursor, const MessageType& type, std::size_t count,
                       const std::string& path, Slot& slot);
    bool read_numbers(MessageCursor& cursor, const MessageField& field, std::size_t count,
                      const std::string& path, Slot& slot);
    bool read_names(MessageCursor& cursor, std::size_t count);
    void name_columns(const std::string& path, std::size_t count, Slot& slot);
    int column(const std::string& name);
    void leave_out(const std::string& path, const char* why);

    TableWriter& writer_;
    std::string topic_;
    MessageDefinition definition_;
    MessageEncoding encoding_;
    int table_;
    int time_column_ = -1;
    Slot root_;
    bool has_sequences_ = false;
    std::vector<std::string> names_;  ///< of the elements of the arrays in this message
    std::string names_key_;
    std::size_t slots_ = 0;
    bool is_passing_over_ = false;  ///< elements of an array that is too long
    std::size_t misfits_ = 0;
    std::size_t messages_ = 0;
    std::map<std::string, std::string> left_out_;  ///< path: why
};

/// The tables of all topics of a file.
class MessageTables {
  public:
    explicit MessageTables(TableWriter& writer) : writer_(writer) {}

    /// The table of a topic's messages of a type; the same for the same three, as several may write to a
    /// topic. Null where the type cannot be read; a remark then says why, once.
    MessageTable* table(const std::string& topic, const std::string& type, const std::string& definition,
                        MessageDialect dialect, MessageEncoding encoding);
    /// A topic that is left out: a remark, once.
    void leave_out(const std::string& topic, const std::string& why);
    void end();

  private:
    TableWriter& writer_;
    std::map<std::tuple<std::string, std::string, std::string>, std::unique_ptr<MessageTable>> tables_;
    std::map<std::string, std::string> left_out_;
    std::size_t more_left_out_ = 0;
};

/// Nanoseconds as seconds: a double holds today's time to 0.2 microseconds.
double seconds_of(std::uint64_t nanoseconds);

}  // namespace capstan::logs
