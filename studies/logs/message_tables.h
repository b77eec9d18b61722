#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "capstan/logs/message_table.h"

namespace capstan::logs {

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

}  // namespace capstan::logs
