// MCAP files (mcap.dev/spec). Debian has no library that reads them.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <map>
#include <memory>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/byte_cursor.h"
#include "capstan/logs/byte_source.h"
#include "capstan/logs/json_table.h"
#include "capstan/logs/message_table.h"
#include "capstan/logs/text_lines.h"

namespace capstan::logs {

namespace {

constexpr std::string_view mcap_magic = "\x89MCAP0\r\n";
constexpr std::size_t longest_schema = 4u << 20;
constexpr std::size_t chunk_fields_bytes = 4096;  // of a chunk's record, before what is packed

enum McapOperation : unsigned char {
    mcap_schema = 3,
    mcap_channel = 4,
    mcap_message = 5,
    mcap_chunk = 6,
    mcap_data_end = 15
};

struct Schema {
    std::string name, encoding, text;
};

/// The messages of a channel go to one of the two, or nowhere.
struct Channel {
    MessageTable* message_table = nullptr;
    JsonTable* json_table = nullptr;
};

class McapReading {
  public:
    McapReading(const std::filesystem::path& path, const ReadOptions& options, Log& log)
        : file_(path, options.on_progress), writer_(log, options), tables_(writer_) {}

    void read() {
        file_.seek(mcap_magic.size());
        std::uint64_t begin = file_.position();
        while (!is_at_data_end_ && damage_.empty()) {
            begin = file_.position();
            read_record();
        }
        tables_.end();
        for (auto& [topic, table] : json_tables_) table.end();
        set_units();
        add_remarks(begin);
    }

  private:
    void add_remarks(std::uint64_t begin) {
        if (unknown_channels_ > 0)
            writer_.remark(
                fmt::format("{} messages are of channels that the file does not describe; they are left out",
                            unknown_channels_));
        if (bad_chunks_ > 0)
            writer_.remark(fmt::format("{} chunk{} left out, the first at byte {}: damaged, {}", bad_chunks_,
                                       bad_chunks_ == 1 ? " is" : "s are", first_bad_chunk_, chunk_damage_));
        if (!damage_.empty())
            writer_.remark(
                fmt::format("The file {} in the record that begins at byte {} of {}; the {} messages before "
                            "that are read",
                            damage_, begin, file_.size_bytes(), messages_));
        if (messages_ == 0 && (bad_chunks_ > 0 || !damage_.empty()))
            throw InvalidInput(
                {fmt::format("{}: no complete message was found; the file is cut or damaged at byte {}",
                             writer_.log().file.string(), bad_chunks_ > 0 ? first_bad_chunk_ : begin)});
    }

    void read_record() {
        const std::uint64_t begin = file_.position();
        if (!take(9)) return cut();
        ByteCursor cursor(data_);
        const auto operation = cursor.number<unsigned char>();
        const auto length = cursor.number<std::uint64_t>();
        is_at_data_end_ = operation == mcap_data_end;
        const bool is_known =
            operation == mcap_schema || operation == mcap_channel || operation == mcap_message;
        if (operation == mcap_chunk) return read_chunk(begin, length);
        if (!is_known) {
            if (length > file_.size_bytes() - file_.position()) return cut();
            return file_.seek(file_.position() + length);
        }
        if (length > LogLimits::message_bytes) return damaged();
        if (!take(length)) return cut();
        if (!read_content(operation, data_)) damaged();
    }

    void read_chunk(std::uint64_t begin, std::uint64_t length) {
        if (length > LogLimits::chunk_bytes + chunk_fields_bytes)
            throw InvalidInput(
                {fmt::format("{}: has a chunk of more than {} MB; write it with smaller ones, for "
                             "example with mcap compress --chunk-size",
                             writer_.log().file.string(), LogLimits::chunk_bytes >> 20)});
        const bool is_cut = !take(length);
        ByteCursor cursor(data_);
        cursor.take(16);  // the first and the last time
        const auto unpacked_bytes = cursor.number<std::uint64_t>();
        const auto checksum = cursor.number<std::uint32_t>();
        const std::string_view compression = cursor.prefixed();
        const auto packed_bytes = cursor.number<std::uint64_t>();
        if (!cursor.is_good()) return is_cut ? cut() : damaged();
        if (unpacked_bytes > LogLimits::chunk_bytes)
            return bad_chunk(begin, "more than the limit when unpacked");
        const std::string_view packed = cursor.take(std::min<std::uint64_t>(packed_bytes, cursor.left()));
        Unpacked unpacked;
        std::string_view content = packed;
        if (compression == "lz4") {
            content = (unpacked = unpack_lz4(packed, unpacked_bytes)).bytes;
        } else if (compression == "zstd") {
            content = (unpacked = unpack_zstd(packed, unpacked_bytes)).bytes;
        } else if (!compression.empty()) {
            return bad_chunk(begin, "or packed in an unknown way");
        }
        const bool is_whole = packed.size() == packed_bytes && content.size() == unpacked_bytes;
        // Of a chunk that is cut, what there is counts; of a complete one, what its checksum vouches for.
        if (is_whole && checksum != 0 &&
            crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())) !=
                checksum)
            return bad_chunk(begin, "as its checksum shows");
        const bool is_read = read_records(content);
        if (is_cut) return cut();
        if (!is_whole || !is_read) bad_chunk(begin, "only in part to be read");
    }

    bool read_records(std::string_view content) {
        ByteCursor cursor(content);
        while (!cursor.at_end()) {
            const auto operation = cursor.number<unsigned char>();
            const auto length = cursor.number<std::uint64_t>();
            const std::string_view data = cursor.take(length);
            if (!cursor.is_good() || !read_content(operation, data)) return false;
        }
        return cursor.is_good();
    }

    bool read_content(unsigned char operation, std::string_view data) {
        ByteCursor cursor(data);
        if (operation == mcap_schema) return read_schema(cursor);
        if (operation == mcap_channel) return read_channel(cursor);
        if (operation != mcap_message) return true;
        const auto number = cursor.number<std::uint16_t>();
        cursor.number<std::uint32_t>();  // the sequence
        const auto log_time_ns = cursor.number<std::uint64_t>();
        cursor.number<std::uint64_t>();  // when it was published
        if (!cursor.is_good()) return false;
        const std::string_view message = cursor.take(cursor.left());
        if (message.size() > LogLimits::message_bytes) return false;
        ++messages_;
        const auto found = channels_.find(number);
        if (found == channels_.end())
            ++unknown_channels_;
        else if (found->second.message_table)
            found->second.message_table->take(log_time_ns, message);
        else if (found->second.json_table)
            found->second.json_table->take(log_time_ns, message);
        return true;
    }

    bool read_schema(ByteCursor& cursor) {
        const auto number = cursor.number<std::uint16_t>();
        Schema schema;
        schema.name = cursor.prefixed();
        schema.encoding = cursor.prefixed();
        const std::string_view text = cursor.prefixed();
        if (!cursor.is_good() || number == 0) return false;
        schema_bytes_ += text.size();
        if (schema.name.size() > LogLimits::name_bytes || schema_bytes_ > longest_schema) return false;
        schema.text = text;
        if (!schemas_.try_emplace(number, std::move(schema)).second) schema_bytes_ -= text.size();
        return true;
    }

    bool read_channel(ByteCursor& cursor) {
        const auto number = cursor.number<std::uint16_t>();
        const auto schema_number = cursor.number<std::uint16_t>();
        const std::string topic(cursor.prefixed());
        const std::string encoding(cursor.prefixed());
        if (!cursor.is_good() || topic.size() > LogLimits::name_bytes) return false;
        read_unit(cursor, topic);
        const auto [entry, is_new] = channels_.try_emplace(number);
        if (!is_new) return true;
        const auto found = schemas_.find(schema_number);
        const Schema none;
        const Schema& schema = found == schemas_.end() ? none : found->second;
        if (encoding == "json") {
            entry->second.json_table = &json_tables_.try_emplace(topic, writer_, topic).first->second;
        } else if (encoding == "cdr" && schema.encoding == "ros2msg") {
            entry->second.message_table =
                tables_.table(topic, schema.name, schema.text, MessageDialect::ros2, MessageEncoding::cdr);
        } else if (encoding == "ros1" && schema.encoding == "ros1msg") {
            entry->second.message_table =
                tables_.table(topic, schema.name, schema.text, MessageDialect::ros1, MessageEncoding::ros1);
        } else if (encoding == "cdr" &&
                   !common_definition(short_type(schema.name), MessageDialect::ros2).empty()) {
            entry->second.message_table =
                tables_.table(topic, schema.name, "", MessageDialect::ros2, MessageEncoding::cdr);
        } else {
            tables_.leave_out(
                topic, fmt::format("its encoding is '{}' with the schema '{}' in '{}'; cdr with ros2msg, "
                                   "ros1 with ros1msg, and json can be read",
                                   as_utf8(encoding.substr(0, 40)), as_utf8(schema.name.substr(0, 80)),
                                   as_utf8(schema.encoding.substr(0, 40))));
        }
        return true;
    }

    // Some writers state a unit in the metadata of a topic.
    void read_unit(ByteCursor& cursor, const std::string& topic) {
        ByteCursor metadata(cursor.prefixed());
        while (metadata.is_good()) {
            const std::string_view key = metadata.prefixed();
            const std::string_view value = metadata.prefixed();
            if (!metadata.is_good()) return;
            if (key == "unit" && value.size() <= LogLimits::name_bytes && units_.size() < LogLimits::columns)
                units_.try_emplace(as_utf8(topic), as_utf8(value));
        }
    }

    void set_units() {
        for (LogTable& table : writer_.log().tables) {
            const auto unit = units_.find(table.name);
            if (unit == units_.end()) continue;
            for (LogColumn& column : table.columns) {
                if (column.name != "log_time" && column.name != "header.stamp" && column.unit.empty())
                    column.unit = unit->second;
            }
        }
    }

    bool take(std::uint64_t count) {
        data_.resize(std::min(count, file_.size_bytes() - std::min(file_.position(), file_.size_bytes())));
        data_.resize(file_.read(data_.data(), data_.size()));
        return data_.size() == count;
    }

    void cut() { damage_ = "is cut"; }
    void damaged() { damage_ = "is damaged"; }
    void bad_chunk(std::uint64_t begin, const char* how) {
        if (bad_chunks_++ > 0) return;
        first_bad_chunk_ = begin;
        chunk_damage_ = how;
    }

    FileSource file_;
    TableWriter writer_;
    MessageTables tables_;
    std::map<std::string, JsonTable> json_tables_;
    std::map<std::uint16_t, Schema> schemas_;
    std::map<std::string, std::string> units_;  // by topic
    std::size_t schema_bytes_ = 0;
    std::map<std::uint16_t, Channel> channels_;
    std::string data_;
    std::string damage_;
    bool is_at_data_end_ = false;
    std::size_t messages_ = 0;
    std::size_t unknown_channels_ = 0;
    std::size_t bad_chunks_ = 0;
    std::uint64_t first_bad_chunk_ = 0;
    const char* chunk_damage_ = "";
};

bool is_mcap(std::string_view head, const std::filesystem::path&) {
    return head.starts_with(mcap_magic);
}

void read_mcap(const std::filesystem::path& path, const ReadOptions& options, Log& log) {
    McapReading(path, options, log).read();
}

}  // namespace

const LogFormat mcap_format{"MCAP", ".mcap", is_mcap, read_mcap};

}  // namespace capstan::logs
