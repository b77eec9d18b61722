#include "capstan/logs/message_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/logs/message_cursor.h"
#include "capstan/logs/text_lines.h"

namespace capstan::logs {

namespace {

constexpr std::size_t named_topics = 64;    // left out; more are counted
constexpr std::size_t longest_array = 256;  // a longer one is a picture or a cloud, not channels
constexpr std::size_t longest_names = 1u << 14;
constexpr std::size_t max_slots = 1u << 15;  // per topic
constexpr std::size_t padding_bytes = 8;     // that CDR may have behind a message

bool names_elements(const MessageField& field) {
    return field.kind == FieldKind::string && field.shape == FieldShape::sequence &&
           (field.name == "name" || field.name == "joint_names");
}

}  // namespace

double seconds_of(std::uint64_t nanoseconds) {
    constexpr std::uint64_t one_second = 1'000'000'000;
    const std::uint64_t seconds = nanoseconds / one_second, rest = nanoseconds % one_second;
    return static_cast<double>(seconds) + 1e-9 * static_cast<double>(rest);
}

MessageTable::MessageTable(TableWriter& writer, const std::string& topic, MessageDefinition definition,
                           MessageEncoding encoding)
    : writer_(writer),
      topic_(topic),
      definition_(std::move(definition)),
      encoding_(encoding),
      table_(writer.add_table(as_utf8(topic))) {
    time_column_ = column("log_time");
    for (const MessageType& type : definition_.types)
        for (const MessageField& field : type.fields)
            has_sequences_ = has_sequences_ || field.shape == FieldShape::sequence;
}

void MessageTable::take(std::uint64_t log_time_ns, std::string_view message) {
    ++messages_;
    const LogTable& table = writer_.log().tables[static_cast<std::size_t>(table_)];
    const bool is_unwanted = table.columns.empty() && table.rows > 0 && !has_sequences_;
    MessageCursor cursor(message, encoding_);
    names_.clear();
    names_key_.clear();
    if (!is_unwanted && ((encoding_ == MessageEncoding::cdr && !cursor.begin_cdr()) ||
                         !read_message(cursor, definition_.types.front(), "", root_) ||
                         cursor.left() > (encoding_ == MessageEncoding::cdr ? padding_bytes : 0))) {
        ++misfits_;
        std::vector<double>& row = writer_.row(table_);
        std::fill(row.begin(), row.end(), std::numeric_limits<double>::quiet_NaN());
        return;
    }
    if (time_column_ >= 0)
        writer_.row(table_)[static_cast<std::size_t>(time_column_)] = seconds_of(log_time_ns);
    writer_.finish_row(table_);
}

bool MessageTable::read_message(MessageCursor& cursor, const MessageType& type, const std::string& path,
                                Slot& slot) {
    if (slot.children.size() < type.fields.size()) {
        slot.children.resize(type.fields.size());
        slots_ += type.fields.size();
    }
    for (std::size_t field = 0; field < type.fields.size(); ++field)
        if (!read_field(cursor, type.fields[field], path, slot.children[field])) return false;
    return true;
}

bool MessageTable::read_field(MessageCursor& cursor, const MessageField& field, const std::string& parent,
                              Slot& slot) {
    std::uint32_t count = static_cast<std::uint32_t>(field.count);
    if (field.shape == FieldShape::sequence && !cursor.count(count)) return false;
    if (names_elements(field)) return read_names(cursor, count);
    if (field.kind == FieldKind::string) {
        for (std::string_view text; count > 0; --count)
            if (!cursor.string(text)) return false;
        return true;
    }
    if (field.kind != FieldKind::message && field.shape == FieldShape::one && slot.column != Slot::not_made) {
        const std::size_t size = size_of(field.kind);
        const char* piece = nullptr;
        if (!cursor.take(size, size > 4 && field.kind >= FieldKind::time ? 4 : size, piece)) return false;
        if (slot.column >= 0)
            writer_.row(table_)[static_cast<std::size_t>(slot.column)] = cursor.number(piece, field.kind);
        return true;
    }
    const std::string path = parent.empty() ? field.name : parent + "." + field.name;
    if (field.kind != FieldKind::message && field.shape == FieldShape::one) {
        slot.column = column(path);
        return read_field(cursor, field, parent, slot);
    }
    if (field.kind != FieldKind::message) return read_numbers(cursor, field, count, path, slot);
    const MessageType& type = definition_.types[static_cast<std::size_t>(field.message)];
    if (field.shape == FieldShape::one) return read_message(cursor, type, path, slot);
    if (count > 0 && count > cursor.left() / type.min_bytes) return false;
    return read_messages(cursor, type, count, path, slot);
}

bool MessageTable::read_messages(MessageCursor& cursor, const MessageType& type, std::size_t count,
                                 const std::string& path, Slot& slot) {
    const bool was_passing_over = is_passing_over_;
    bool is_read = true;
    Slot passed_over;
    if (count > longest_array || slots_ > max_slots) {
        leave_out(path, "too many elements");
        is_passing_over_ = true;
    } else if (!is_passing_over_ && slot.children.size() < count) {
        slot.children.resize(count);
    }
    for (std::size_t element = 0; is_read && element < count; ++element)
        is_read = is_passing_over_ ? read_message(cursor, type, path, passed_over)
                                   : read_message(cursor, type, path + "." + std::to_string(element),
                                                  slot.children[element]);
    is_passing_over_ = was_passing_over;
    return is_read;
}

bool MessageTable::read_numbers(MessageCursor& cursor, const MessageField& field, std::size_t count,
                                const std::string& path, Slot& slot) {
    const std::size_t size = size_of(field.kind);
    const char* piece = nullptr;
    if (count == 0) return true;
    if (count > LogLimits::message_bytes ||
        !cursor.take(count * size, field.kind >= FieldKind::time ? 4 : size, piece))
        return false;
    const bool is_bytes =
        size == 1 && field.shape == FieldShape::sequence && field.kind != FieldKind::boolean;
    if (is_bytes || count > longest_array) {
        leave_out(path, is_bytes ? "bytes" : "too many elements");
        return true;
    }
    const bool has_names = field.shape == FieldShape::sequence && names_.size() == count;
    const std::string_view key = has_names ? std::string_view(names_key_) : std::string_view();
    if (slot.names != key) {
        slot.columns.clear();
        slot.names = key;
    }
    if (slot.columns.size() < count) name_columns(path, count, slot);
    std::vector<double>& row = writer_.row(table_);
    for (std::size_t element = 0; element < count; ++element)
        if (slot.columns[element] >= 0)
            row[static_cast<std::size_t>(slot.columns[element])] =
                cursor.number(piece + element * size, field.kind);
    return true;
}

void MessageTable::name_columns(const std::string& path, std::size_t count, Slot& slot) {
    UniqueNames unique;
    const bool has_names = !slot.names.empty();
    for (std::size_t element = 0; element < count; ++element) {
        const std::string own = unique(has_names ? names_[element] : std::to_string(element));
        if (element < slot.columns.size()) continue;
        const auto [entry, is_new] = slot.named.try_emplace(own, Slot::not_made);
        if (is_new) entry->second = column(path + "." + own);
        slot.columns.push_back(entry->second);
    }
}

bool MessageTable::read_names(MessageCursor& cursor, std::size_t count) {
    names_.clear();
    names_key_.clear();
    bool is_usable = count <= longest_array;
    for (std::string_view text; count > 0; --count) {
        if (!cursor.string(text)) return false;
        is_usable =
            is_usable && text.size() <= LogLimits::name_bytes / 2 && names_key_.size() < longest_names;
        if (!is_usable) continue;
        names_.push_back(as_utf8(text));
        names_key_.append(text);
        names_key_ += '\0';
    }
    if (!is_usable) names_.clear(), names_key_.clear();
    return true;
}

int MessageTable::column(const std::string& name) {
    if (is_passing_over_ || name.size() > LogLimits::name_bytes) return -1;
    if (writer_.is_full()) {
        leave_out(name, "the file has too many columns");
        return -1;
    }
    return writer_.add_column(table_, name);
}

void MessageTable::leave_out(const std::string& path, const char* why) {
    if (!is_passing_over_ && left_out_.size() < 8) left_out_.try_emplace(path, why);
}

void MessageTable::end() {
    if (misfits_ > 0)
        writer_.remark(fmt::format("{}: {} of {} messages {} not as the type {} says and {} left out",
                                   as_utf8(topic_), misfits_, messages_, misfits_ == 1 ? "is" : "are",
                                   definition_.types.front().name, misfits_ == 1 ? "is" : "are"));
    for (const auto& [path, why] : left_out_)
        writer_.remark(fmt::format("{}: '{}' is left out: {}", as_utf8(topic_), path, why));
}

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
