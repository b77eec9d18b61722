#include "capstan/logs/json_table.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "capstan/logs/message_table.h"
#include "capstan/logs/text_lines.h"

namespace capstan::logs {

namespace {

constexpr std::size_t longest_json = 1u << 20;  // its tree takes many times as much
constexpr int deepest_json = 32;
constexpr std::size_t longest_json_array = 256;

}  // namespace

JsonTable::JsonTable(TableWriter& writer, const std::string& topic)
    : writer_(writer),
      topic_(topic),
      table_(writer.add_table(as_utf8(topic))),
      time_column_(writer.is_full() ? -1 : writer.add_column(table_, "log_time")) {}

void JsonTable::take(std::uint64_t log_time_ns, std::string_view message) {
    ++messages_;
    const nlohmann::json value = message.size() > longest_json
                                     ? nlohmann::json(nlohmann::json::value_t::discarded)
                                     : nlohmann::json::parse(message, nullptr, false);
    if (!value.is_object()) {
        ++misfits_;
        return;
    }
    read(value, "", 0);
    if (time_column_ >= 0)
        writer_.row(table_)[static_cast<std::size_t>(time_column_)] = seconds_of(log_time_ns);
    writer_.finish_row(table_);
}

void JsonTable::read(const nlohmann::json& value, const std::string& path, int depth) {
    const auto below = [&](const std::string& name) { return path.empty() ? name : path + "." + name; };
    if (value.is_boolean()) return write(path, value.get<bool>() ? 1.0 : 0.0);
    if (value.is_number()) return write(path, value.get<double>());
    if (depth == deepest_json || (value.is_array() && value.size() > longest_json_array)) {
        is_left_out_in_part_ = true;
        return;
    }
    if (value.is_array()) {
        for (std::size_t k = 0; k < value.size(); ++k) read(value[k], below(std::to_string(k)), depth + 1);
        return;
    }
    if (!value.is_object()) return;
    for (const char* nanoseconds : {"nsec", "nanosec", "nsecs"}) {
        const char* seconds = nanoseconds[4] == 's' ? "secs" : "sec";
        if (path.empty() || value.size() != 2 || !value.contains(seconds) || !value.contains(nanoseconds))
            continue;
        if (!value[seconds].is_number() || !value[nanoseconds].is_number()) continue;
        return write(path, value[seconds].get<double>() + 1e-9 * value[nanoseconds].get<double>());
    }
    for (const auto& [name, element] : value.items()) read(element, below(name), depth + 1);
}

void JsonTable::write(const std::string& path, double number) {
    auto found = columns_.find(path);
    if (found == columns_.end()) {
        if (writer_.is_full() || columns_.size() >= LogLimits::columns ||
            path.size() > LogLimits::name_bytes) {
            is_left_out_in_part_ = true;
            return;
        }
        found = columns_.emplace(path, writer_.add_column(table_, path)).first;
    }
    if (found->second >= 0) writer_.row(table_)[static_cast<std::size_t>(found->second)] = number;
}

void JsonTable::end() {
    if (misfits_ > 0)
        writer_.remark(fmt::format("{}: {} of {} messages {} no JSON object and {} left out", as_utf8(topic_),
                                   misfits_, messages_, misfits_ == 1 ? "is" : "are",
                                   misfits_ == 1 ? "is" : "are"));
    if (is_left_out_in_part_)
        writer_.remark(fmt::format(
            "{}: what is nested too deeply, long arrays and numbers beyond {} columns are left out",
            as_utf8(topic_), LogLimits::columns));
}

}  // namespace capstan::logs
