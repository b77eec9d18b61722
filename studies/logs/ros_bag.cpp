// ROS 1 bags, format 2.0 (wiki.ros.org/Bags/Format/2.0). librosbag-storage refuses a bag without an index,
// which is what a recording that was interrupted leaves, and believes the sizes it finds; hence this reader.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/byte_cursor.h"
#include "capstan/logs/byte_source.h"
#include "capstan/logs/message_table.h"

namespace capstan::logs {

namespace {

constexpr std::string_view bag_magic = "#ROSBAG V2.0\n";
constexpr std::size_t longest_bag_header = 1u << 16;
constexpr std::size_t longest_connection = 4u << 20;

enum BagOperation : unsigned char { message_data = 2, bag_header = 3, chunk = 5, connection = 7 };

/// "name=value" of a record's header; the last of a name counts.
class BagHeader {
  public:
    explicit BagHeader(std::string_view bytes) {
        for (ByteCursor cursor(bytes); !cursor.at_end();) {
            const std::string_view field = cursor.prefixed();
            const std::size_t equals = field.find('=');
            is_good_ = is_good_ && cursor.is_good() && equals != std::string_view::npos;
            if (!is_good_ || fields_.size() > 64) return;
            fields_[field.substr(0, equals)] = field.substr(equals + 1);
        }
    }

    bool is_good() const { return is_good_; }
    std::string_view text(std::string_view name) const {
        const auto found = fields_.find(name);
        return found == fields_.end() ? std::string_view() : found->second;
    }
    template <typename Number>
    std::optional<Number> number(std::string_view name) const {
        const std::string_view bytes = text(name);
        if (bytes.size() != sizeof(Number)) return std::nullopt;
        return ByteCursor(bytes).number<Number>();
    }

  private:
    std::map<std::string_view, std::string_view> fields_;
    bool is_good_ = true;
};

class BagReading {
  public:
    BagReading(const std::filesystem::path& path, const ReadOptions& options, Log& log)
        : file_(path, options.on_progress), writer_(log, options), tables_(writer_) {}

    void read() {
        file_.seek(bag_magic.size());
        std::uint64_t begin = file_.position();
        while (begin < file_.size_bytes() && read_record()) begin = file_.position();
        tables_.end();
        if (unknown_connections_ > 0)
            writer_.remark(fmt::format(
                "{} messages are of connections that the bag does not describe; they are left out",
                unknown_connections_));
        if (!damage_.empty())
            writer_.remark(fmt::format("The bag {} at byte {} of {}; the {} messages before that are read",
                                       damage_, begin, file_.size_bytes(), messages_));
        if (!damage_.empty() && messages_ == 0)
            throw InvalidInput({fmt::format("{}: the bag {} at byte {}, before its first complete message",
                                            writer_.log().file.string(), damage_, begin)});
    }

  private:
    // A record of the file: its header, and its data only where they matter.
    bool read_record() {
        if (!take(4, header_)) return cut();
        const auto header_bytes = ByteCursor(header_).number<std::uint32_t>();
        if (header_bytes > longest_bag_header) return damaged();
        std::string size;
        if (!take(header_bytes, header_) || !take(4, size)) return cut();
        const auto data_bytes = ByteCursor(size).number<std::uint32_t>();
        const BagHeader header(header_);
        const auto operation = header.number<unsigned char>("op");
        if (!header.is_good() || !operation) return damaged();
        if (*operation == chunk) return read_chunk(header, data_bytes);
        if (*operation == bag_header && !header.text("encryptor").empty())
            throw InvalidInput({fmt::format("{}: the bag is encrypted; decrypt it with rosbag decrypt",
                                            writer_.log().file.string())});
        if (*operation != connection && *operation != message_data) {
            if (data_bytes > file_.size_bytes() - file_.position()) return cut();
            file_.seek(file_.position() + data_bytes);
            return true;
        }
        if (data_bytes > LogLimits::message_bytes) return damaged();
        if (!take(data_bytes, data_)) return cut();
        return read_content(header, data_) || damaged();
    }

    bool read_chunk(const BagHeader& header, std::uint32_t data_bytes) {
        const auto unpacked_bytes = header.number<std::uint32_t>("size");
        const std::string compression(header.text("compression"));
        if (!unpacked_bytes || *unpacked_bytes > LogLimits::chunk_bytes ||
            data_bytes > LogLimits::chunk_bytes)
            throw InvalidInput(
                {fmt::format("{}: has a chunk of more than {} MB; copy the bag with rosbag compress or "
                             "rosbag filter, which write small ones",
                             writer_.log().file.string(), LogLimits::chunk_bytes >> 20)});
        const bool is_cut = !take(data_bytes, data_);
        Unpacked unpacked;
        std::string_view content = data_;
        if (compression != "none") {
            if (compression == "bz2")
                unpacked = unpack_bzip2(data_, *unpacked_bytes);
            else if (compression == "lz4")
                unpacked = unpack_lz4(data_, *unpacked_bytes);
            else
                return damaged();
            content = unpacked.bytes;
        }
        const bool is_whole = read_records(content);
        if (is_cut) return cut();
        if (!is_whole || content.size() != *unpacked_bytes) return damaged();
        return true;
    }

    // The records inside a chunk, as far as they are complete.
    bool read_records(std::string_view content) {
        ByteCursor cursor(content);
        while (!cursor.at_end()) {
            const std::string_view header_bytes = cursor.prefixed();
            const std::string_view data = cursor.prefixed();
            if (!cursor.is_good() || header_bytes.size() > longest_bag_header) return false;
            const BagHeader header(header_bytes);
            if (!header.is_good() || !read_content(header, data)) return false;
        }
        return cursor.is_good();
    }

    bool read_content(const BagHeader& header, std::string_view data) {
        const auto operation = header.number<unsigned char>("op");
        const auto number = header.number<std::uint32_t>("conn");
        if (!operation) return false;
        if (*operation == connection) return number && read_connection(*number, header, data);
        if (*operation != message_data) return true;
        const auto time = header.number<std::uint64_t>("time");
        if (!number || !time || data.size() > LogLimits::message_bytes) return false;
        ++messages_;
        const auto found = connections_.find(*number);
        if (found == connections_.end())
            ++unknown_connections_;
        else if (found->second)
            found->second->take((*time & 0xffffffffu) * 1'000'000'000u + (*time >> 32), data);
        return true;
    }

    bool read_connection(std::uint32_t number, const BagHeader& header, std::string_view data) {
        if (data.size() > longest_connection) return false;
        if (connections_.contains(number)) return true;
        const BagHeader description(data);
        const std::string topic(header.text("topic"));
        if (!description.is_good() || topic.empty() || topic.size() > LogLimits::name_bytes ||
            connections_.size() > max_connections)
            return false;
        connections_[number] = tables_.table(topic, std::string(description.text("type")),
                                             std::string(description.text("message_definition")),
                                             MessageDialect::ros1, MessageEncoding::ros1);
        return true;
    }

    // Up to `count` bytes; false where there are fewer.
    bool take(std::size_t count, std::string& to) {
        to.resize(std::min<std::uint64_t>(
            count, file_.size_bytes() - std::min(file_.position(), file_.size_bytes())));
        to.resize(file_.read(to.data(), to.size()));
        return to.size() == count;
    }

    bool cut() {
        damage_ = "is cut in the record that begins";
        return false;
    }
    bool damaged() {
        damage_ = "is damaged in the record that begins";
        return false;
    }

    static constexpr std::size_t max_connections = 4096;

    FileSource file_;
    TableWriter writer_;
    MessageTables tables_;
    std::map<std::uint32_t, MessageTable*> connections_;  ///< null: left out
    std::string header_, data_;
    std::string damage_;
    std::size_t messages_ = 0;
    std::size_t unknown_connections_ = 0;
};

bool is_bag(std::string_view head, const std::filesystem::path&) {
    return head.starts_with("#ROSBAG ");
}

void read_bag(const std::filesystem::path& path, const ReadOptions& options, Log& log) {
    FileSource file(path);
    std::string magic(bag_magic.size(), '\0');
    magic.resize(file.read(magic.data(), magic.size()));
    if (magic != bag_magic)
        throw InvalidInput(
            {fmt::format("{}: is a bag of another format than 2.0, or cut in its first line; convert it "
                         "with rosbag fix",
                         path.string())});
    BagReading(path, options, log).read();
}

}  // namespace

const LogFormat ros_bag_format{"ROS 1 bag", ".bag", is_bag, read_bag};

}  // namespace capstan::logs
