#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "capstan/import/mapping.h"

namespace capstan::imports {

namespace {

std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// A key that TOML takes bare, else in quotes.
std::string key_text(const std::string& key) {
    const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
        return std::isalnum(c) || c == '_' || c == '-';
    });
    return bare ? key : quoted(key);
}

std::string value_text(const nlohmann::ordered_json& value) {
    if (value.is_object()) {
        std::string text;
        for (const auto& [key, inner] : value.items())
            text += fmt::format("{}{} = {}", text.empty() ? " " : ", ", key_text(key), value_text(inner));
        return "{" + text + " }";
    }
    if (value.is_array()) {
        std::string text;
        for (const auto& inner : value) text += (text.empty() ? "" : ", ") + value_text(inner);
        return "[" + text + "]";
    }
    return value.is_string() ? quoted(value.get<std::string>()) : value.dump();
}

std::string number_text(double number) {
    return nlohmann::json(number).dump();
}

class InlineTable {
  public:
    void add(const char* key, const std::string& value) {
        text_ += fmt::format("{}{} = {}", text_.empty() ? "" : ", ", key, value);
    }
    void add_text(const char* key, const std::string& value) {
        if (!value.empty()) add(key, quoted(value));
    }
    void add_number(const char* key, const std::optional<double>& value) {
        if (value) add(key, number_text(*value));
    }
    std::string text() const { return "{ " + text_ + " }"; }
    bool empty() const { return text_.empty(); }

  private:
    std::string text_;
};

std::string channel_text(const ChannelMapping& channel) {
    InlineTable table;
    table.add_text("file", channel.from.file);
    table.add_text("table", channel.from.table);
    table.add_text("column", channel.from.column);
    table.add_text("unit", channel.unit);
    table.add_number("scale", channel.scale);
    table.add_number("counts_per_turn", channel.counts_per_turn);
    table.add_number("torque_constant_Nm_per_A", channel.torque_constant);
    if (channel.sign != 1.0) table.add("sign", "-1");
    if (channel.zero != 0.0) table.add_number("zero", channel.zero);
    table.add_number("clock_offset_s", channel.clock_offset_s);
    table.add_number("wraps_at", channel.wraps_at);
    table.add_number("noise_std", channel.noise_std);
    table.add_number("step", channel.step);
    return fmt::format("{} = {}\n", key_text(channel.name), table.text());
}

std::string run_text(const RunMapping& run) {
    std::string text = "\n[[runs]]\n";
    if (run.files.size() == 1) text += "file = " + quoted(run.files[0]) + "\n";
    if (run.files.size() > 1) text += "files = " + value_text(run.files) + "\n";
    if (run.from_s) text += "from_s = " + number_text(*run.from_s) + "\n";
    if (run.to_s) text += "to_s = " + number_text(*run.to_s) + "\n";
    if (!run.zero.empty()) {
        nlohmann::ordered_json zeros;
        for (const auto& [channel, zero] : run.zero) zeros[channel] = zero;
        text += "zero = " + value_text(zeros) + "\n";
    }
    if (run.conditions.is_object()) {
        for (const auto& [key, value] : run.conditions.items())
            text += fmt::format("{} = {}\n", key_text(key), value_text(value));
    }
    return text;
}

}  // namespace

std::string mapping_text(const Mapping& mapping,
                         const std::vector<std::pair<std::string, std::string>>& reasons) {
    const auto comments = [&](const std::string& about) {
        std::string text;
        for (const auto& [key, reason] : reasons) {
            if (key == about) text += "# " + reason + "\n";
        }
        return text;
    };
    std::string text = comments("file");
    if (!text.empty()) text += "\n";  // they are not those of the key that follows
    if (mapping.sample_rate_Hz) text += "sample_rate_Hz = " + number_text(*mapping.sample_rate_Hz) + "\n";
    if (mapping.thinning == Thinning::mean) text += "thinning = \"mean\"\n";
    if (mapping.run_column) text += "run_column = " + quoted(*mapping.run_column) + "\n";
    InlineTable time;
    time.add_text("column", mapping.time.column);
    time.add_text("unit", mapping.time.unit);
    if (mapping.time.sample_rate_Hz > 0.0) time.add_number("sample_rate_Hz", mapping.time.sample_rate_Hz);
    if (!time.empty()) text += comments("time") + "time = " + time.text() + "\n";
    InlineTable layout;
    if (mapping.text.delimiter) layout.add_text("delimiter", std::string(1, *mapping.text.delimiter));
    if (mapping.text.decimal_comma)
        layout.add("decimal_comma", *mapping.text.decimal_comma ? "true" : "false");
    if (mapping.text.head_line) layout.add("head_line", std::to_string(*mapping.text.head_line));
    if (mapping.text.comments) layout.add_text("comments", *mapping.text.comments);
    if (!layout.empty()) text += "text = " + layout.text() + "\n";
    text += "\n[channels]\n";
    for (const ChannelMapping& channel : mapping.channels)
        text += comments(channel.name) + channel_text(channel);
    text += comments("channels");
    if (mapping.recording.is_object() && !mapping.recording.empty()) {
        text += "\n" + comments("recording") + "[recording]\n";
        for (const auto& [key, value] : mapping.recording.items())
            text += fmt::format("{} = {}\n", key_text(key), value_text(value));
    }
    for (const RunMapping& run : mapping.runs) text += run_text(run);
    return text;
}

}  // namespace capstan::imports
