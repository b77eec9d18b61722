#include "capstan/logs/message_tables.h"

#include <fmt/format.h>

#include "capstan/logs/text_lines.h"

namespace capstan::logs {

namespace {

constexpr std::size_t named_topics = 64;  // left out; more are counted

}  // namespace

MessageTable* MessageTables::table(const std::string& topic, const std::string& type,
                                   const std::string& definition, MessageDialect dialect,
                                   MessageEncoding encoding) {
    const auto [entry, is_new] = tables_.try_emplace({topic, type, definition});
    if (is_new) try {
            entry->second = std::make_unique<MessageTable>(
                writer_, topic, parse_definition(type, definition, dialect), encoding);
        } catch (const UnknownMessage& why) {
            leave_out(topic, fmt::format("messages of type {} cannot be read: {}",
                                         as_utf8(type.substr(0, 80)), why.what()));
        }
    return entry->second.get();
}

void MessageTables::leave_out(const std::string& topic, const std::string& why) {
    if (left_out_.size() < named_topics)
        left_out_.try_emplace(topic.substr(0, LogLimits::name_bytes), why);
    else
        ++more_left_out_;
}

void MessageTables::end() {
    for (const auto& [key, table] : tables_)
        if (table) table->end();
    for (const auto& [topic, why] : left_out_)
        writer_.remark(fmt::format("{} is left out: {}", as_utf8(topic), why));
    if (more_left_out_ > 0) writer_.remark(fmt::format("{} further topics are left out", more_left_out_));
}

}  // namespace capstan::logs
