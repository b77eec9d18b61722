// MCAP files (mcap.dev/spec), for viewers. The records are put together in memory, chunk by chunk.
#include <zlib.h>

#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include "capstan/export/series.h"
#include "capstan/platform/files.h"

namespace capstan::exports {

namespace {

constexpr std::string_view mcap_magic_bytes = "\x89MCAP0\r\n";
constexpr std::size_t chunk_bytes = 256u << 10;
constexpr std::string_view float64_definition = "float64 data\n";

enum McapRecord : unsigned char {
    header_record = 1,
    footer_record = 2,
    schema_record = 3,
    channel_record = 4,
    message_record = 5,
    chunk_record = 6,
    message_index_record = 7,
    chunk_index_record = 8,
    statistics_record = 11,
    summary_offset_record = 14,
    data_end_record = 15,
};

/// Fields one after the other, little-endian as this machine.
class Fields {
  public:
    template <typename Number>
    Fields& number(Number value) {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        bytes_.append(bytes, sizeof value);
        return *this;
    }
    Fields& text(std::string_view text) {
        number(static_cast<std::uint32_t>(text.size()));
        bytes_ += text;
        return *this;
    }
    Fields& raw(std::string_view bytes) {
        bytes_ += bytes;
        return *this;
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

std::string record(McapRecord operation, const Fields& fields) {
    Fields framed;
    framed.number(static_cast<unsigned char>(operation))
        .number(static_cast<std::uint64_t>(fields.bytes().size()));
    return framed.raw(fields.bytes()).bytes();
}

std::uint32_t crc_of(std::string_view bytes) {
    return static_cast<std::uint32_t>(
        ::crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

struct Topic {
    std::string name, unit;
};

class McapWriting {
  public:
    explicit McapWriting(const std::filesystem::path& path) : file_(path) {
        append(mcap_magic_bytes);
        append(record(header_record, Fields().text("ros2").text("capstan")));
        schema_ = record(schema_record, Fields()
                                            .number(std::uint16_t{1})
                                            .text("std_msgs/msg/Float64")
                                            .text("ros2msg")
                                            .text(float64_definition));
    }

    /// The topic's number.
    std::uint16_t add_topic(const Topic& topic) {
        const auto number = static_cast<std::uint16_t>(topics_.size() + 1);
        topics_.push_back(record(channel_record, Fields()
                                                     .number(number)
                                                     .number(std::uint16_t{1})
                                                     .text(topic.name)
                                                     .text("cdr")
                                                     .text(Fields().text("unit").text(topic.unit).bytes())));
        counts_[number] = 0;
        return number;
    }

    void add_message(std::uint16_t topic, std::uint32_t sequence, std::uint64_t time_ns, double value) {
        if (chunk_.empty()) begin_chunk(time_ns);
        index_[topic].number(time_ns).number(static_cast<std::uint64_t>(chunk_.size()));
        Fields fields;
        fields.number(topic).number(sequence).number(time_ns).number(time_ns);
        chunk_ += record(message_record, fields.raw(std::string_view("\0\1\0\0", 4)).number(value));
        chunk_first_ns_ = std::min(chunk_first_ns_, time_ns);
        chunk_last_ns_ = std::max(chunk_last_ns_, time_ns);
        ++counts_[topic];
        if (chunk_.size() >= chunk_bytes) end_chunk();
    }

    void finish() {
        end_chunk();
        append(record(data_end_record, Fields().number(std::uint32_t{0})));
        write_summary();
        append(mcap_magic_bytes);
        file_.finish();
    }

  private:
    void append(std::string_view bytes) {
        file_.append(bytes);
        position_ += bytes.size();
    }

    // Every chunk can be read alone: the first message of it follows what describes its topics.
    void begin_chunk(std::uint64_t time_ns) {
        chunk_ = schema_;
        for (const std::string& topic : topics_) chunk_ += topic;
        chunk_first_ns_ = chunk_last_ns_ = time_ns;
    }

    void end_chunk() {
        if (chunk_.empty()) return;
        const auto size = static_cast<std::uint64_t>(chunk_.size());
        const std::string complete = record(chunk_record, Fields()
                                                              .number(chunk_first_ns_)
                                                              .number(chunk_last_ns_)
                                                              .number(size)
                                                              .number(crc_of(chunk_))
                                                              .text("")
                                                              .number(size)
                                                              .raw(chunk_));
        const std::uint64_t begin = position_;
        append(complete);
        const std::uint64_t indexes = position_;
        Fields offsets;
        for (const auto& [topic, entries] : index_) {
            offsets.number(topic).number(position_);
            append(record(message_index_record, Fields().number(topic).text(entries.bytes())));
        }
        chunk_indexes_ += record(chunk_index_record, Fields()
                                                         .number(chunk_first_ns_)
                                                         .number(chunk_last_ns_)
                                                         .number(begin)
                                                         .number(static_cast<std::uint64_t>(complete.size()))
                                                         .text(offsets.bytes())
                                                         .number(position_ - indexes)
                                                         .text("")
                                                         .number(size)
                                                         .number(size));
        first_ns_ = chunks_ == 0 ? chunk_first_ns_ : std::min(first_ns_, chunk_first_ns_);
        last_ns_ = std::max(last_ns_, chunk_last_ns_);
        ++chunks_;
        index_.clear();
        chunk_.clear();
    }

    std::string statistics() const {
        std::uint64_t messages = 0;
        Fields counts;
        for (const auto& [topic, count] : counts_) {
            counts.number(topic).number(count);
            messages += count;
        }
        return record(statistics_record, Fields()
                                             .number(messages)
                                             .number(std::uint16_t{1})
                                             .number(static_cast<std::uint32_t>(topics_.size()))
                                             .number(std::uint32_t{0})  // attachments
                                             .number(std::uint32_t{0})  // metadata
                                             .number(chunks_)
                                             .number(first_ns_)
                                             .number(last_ns_)
                                             .text(counts.bytes()));
    }

    void write_summary() {
        const std::uint64_t begin = position_;
        std::string topics;
        for (const std::string& topic : topics_) topics += topic;
        std::string summary;
        std::string offsets;
        const auto group = [&](McapRecord operation, const std::string& records) {
            if (records.empty()) return;
            offsets += record(summary_offset_record, Fields()
                                                         .number(static_cast<unsigned char>(operation))
                                                         .number(begin + summary.size())
                                                         .number(static_cast<std::uint64_t>(records.size())));
            summary += records;
        };
        group(schema_record, schema_);
        group(channel_record, topics);
        group(statistics_record, statistics());
        group(chunk_index_record, chunk_indexes_);
        const std::uint64_t offsets_begin = begin + summary.size();
        // The checksum covers the summary and the footer up to the checksum itself.
        Fields footer;
        footer.number(static_cast<unsigned char>(footer_record))
            .number(std::uint64_t{20})
            .number(begin)
            .number(offsets_begin);
        const std::string complete = summary + offsets + footer.bytes();
        append(complete);
        append(Fields().number(crc_of(complete)).bytes());
    }

    AtomicFile file_;
    std::uint64_t position_ = 0;
    std::string schema_;
    std::vector<std::string> topics_;
    std::map<std::uint16_t, std::uint64_t> counts_;  // messages of a topic
    std::map<std::uint16_t, Fields> index_;          // times and places in the chunk
    std::string chunk_;
    std::string chunk_indexes_;
    std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0, first_ns_ = 0, last_ns_ = 0;
    std::uint32_t chunks_ = 0;
};

// As ROS 2 has topics, and as viewers read them in "/topic.field": letters, digits and underscores.
std::string topic_name(const Series& series, const SeriesChannel& channel) {
    std::string name = "/" + series.name + "/" + channel.name;
    for (char& letter : name)
        if (!std::isalnum(static_cast<unsigned char>(letter)) && letter != '/') letter = '_';
    return name;
}

std::uint64_t nanoseconds(double time_s) {
    return static_cast<std::uint64_t>(std::llround(1e9 * time_s));
}

}  // namespace

void write_mcap_file(const std::filesystem::path& path, const std::vector<Series>& series) {
    McapWriting file(path);
    std::vector<std::vector<std::uint16_t>> topics;  // series x channels
    for (const Series& each : series) {
        topics.emplace_back();
        for (const SeriesChannel& channel : each.channels)
            topics.back().push_back(file.add_topic({topic_name(each, channel), channel.unit}));
    }
    for (std::size_t number = 0; number < series.size(); ++number) {
        const Series& each = series[number];
        const double start_s = each.time_s.empty() ? 0.0 : std::min(each.time_s.front(), 0.0);
        for (std::size_t k = 0; k < each.time_s.size(); ++k) {
            for (std::size_t channel = 0; channel < each.channels.size(); ++channel)
                file.add_message(topics[number][channel], static_cast<std::uint32_t>(k),
                                 nanoseconds(each.time_s[k] - start_s), each.channels[channel].values[k]);
        }
    }
    file.finish();
}

}  // namespace capstan::exports
