#include "capstan/import/mapping_edit.h"

#include <algorithm>
#include <sstream>

namespace capstan::imports {

namespace {

using Comments = std::vector<std::pair<std::string, std::string>>;  // about, text

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Where a comment begins in a line; npos: nowhere. A # between quotes is none.
std::size_t comment_start(const std::string& line) {
    char quote = 0;
    for (std::size_t k = 0; k < line.size(); ++k) {
        if (quote == '"' && line[k] == '\\')
            ++k;
        else if (quote != 0)
            quote = line[k] == quote ? '\0' : quote;
        else if (line[k] == '"' || line[k] == '\'')
            quote = line[k];
        else if (line[k] == '#')
            return k;
    }
    return std::string::npos;
}

/// Reads the comments of a mapping line by line, and whether any channel stands in it.
class CommentReader {
  public:
    explicit CommentReader(const std::string& toml) {
        std::istringstream lines(toml);
        for (std::string line; std::getline(lines, line);) read(line);
        give("channels");
    }

    Comments comments;
    bool has_section = false;  ///< [channels]
    bool has_channel = false;

  private:
    void read(const std::string& line) {
        const std::size_t start = comment_start(line);
        if (start != std::string::npos) {
            std::string words = line.substr(start + 1);
            if (words.starts_with(' ')) words.erase(0, 1);
            waiting_.push_back(words);
        }
        const std::string code = trimmed(line.substr(0, start));
        if (code.empty()) {
            if (start == std::string::npos && section_.empty()) give("file");
            return;
        }
        if (code.starts_with('[')) {
            const std::size_t first = code.find_first_not_of('[');
            section_ = trimmed(code.substr(first, code.find(']', first) - first));
            has_section = has_section || section_ == "channels";
            has_channel = has_channel || section_.starts_with("channels.");
            return give(section_ == "recording" || section_ == "time" ? section_ : "file");
        }
        std::string key = trimmed(code.substr(0, code.find('=')));
        std::erase_if(key, [](char c) { return c == '"' || c == '\''; });
        has_channel =
            has_channel || section_ == "channels" || (section_.empty() && key.starts_with("channels"));
        if (section_ == "channels" || (section_.empty() && key == "time")) return give(key);
        give(section_ == "recording" || section_ == "time" ? section_ : "file");
    }

    void give(const std::string& about) {
        for (std::string& words : waiting_) comments.emplace_back(about, std::move(words));
        waiting_.clear();
    }

    std::string section_;
    std::vector<std::string> waiting_;
};

// A mapping may have no channel yet; its reader would refuse it.
Mapping parsed(const std::string& toml, const std::string& file, const CommentReader& read) {
    if (read.has_channel) return parse_mapping(toml, file);
    const std::string placeholder = "placeholder = { column = \"1\", unit = \"N\" }\n";
    std::string text = toml;
    if (read.has_section) {
        const std::size_t line_end = text.find('\n', text.find("[channels]"));
        line_end == std::string::npos ? text += "\n" + placeholder : text.insert(line_end + 1, placeholder);
    } else {
        text += "\n[channels]\n" + placeholder;
    }
    Mapping mapping = parse_mapping(text, file);
    mapping.channels.clear();
    return mapping;
}

// Guesses are a suggestion's, not a person's words. An edit answers those about its channel; which columns were not
// used, and why a trial import failed, was said of the mapping before it.
bool is_answered(const std::pair<std::string, std::string>& comment, const std::string& channel) {
    const auto& [about, words] = comment;
    const bool is_guess =
        words.starts_with("DOUBTFUL: ") || words.starts_with("Likely: ") || words.starts_with("Note: ");
    const bool is_of_trial = about == "file" && words.starts_with("DOUBTFUL: a trial import fails");
    return (is_guess && (about == channel || about == "channels")) || is_of_trial;
}

void edit_channel(ChannelMapping& channel, const MappingEdit& edit) {
    if (edit.from) {
        const std::string unit = channel.unit;
        channel = {};
        channel.name = edit.channel;
        channel.from = *edit.from;
        channel.unit = unit;
    }
    if (edit.unit && *edit.unit != channel.unit) {
        channel.unit = *edit.unit;
        channel.scale.reset();
        channel.counts_per_turn.reset();
        channel.torque_constant.reset();
        channel.wraps_at.reset();
    }
    if (edit.sign) channel.sign = *edit.sign;
    if (edit.zero) channel.zero = *edit.zero;
    if (edit.scale) channel.scale = edit.scale;
    if (edit.counts_per_turn) channel.counts_per_turn = edit.counts_per_turn;
    if (edit.torque_constant) channel.torque_constant = edit.torque_constant;
}

}  // namespace

std::string edited_mapping(const std::string& toml, const std::string& file, const MappingEdit& edit) {
    CommentReader read(toml);
    Mapping mapping = parsed(toml, file, read);
    if (edit.remove || edit.from)
        std::erase_if(read.comments, [&](const auto& comment) { return comment.first == edit.channel; });
    std::erase_if(read.comments, [&](const auto& comment) { return is_answered(comment, edit.channel); });
    const auto channel = std::find_if(mapping.channels.begin(), mapping.channels.end(),
                                      [&](const auto& each) { return each.name == edit.channel; });
    if (edit.channel == "time") {
        if (edit.remove) mapping.time = {};
        if (edit.from) mapping.time = {edit.from->column, "", 0.0};
        if (edit.unit) mapping.time.unit = *edit.unit;
    } else if (edit.remove) {
        if (channel != mapping.channels.end()) mapping.channels.erase(channel);
    } else {
        if (channel == mapping.channels.end()) {
            mapping.channels.emplace_back().name = edit.channel;
            edit_channel(mapping.channels.back(), edit);
        } else {
            edit_channel(*channel, edit);
        }
    }
    return mapping_text(mapping, read.comments);
}

}  // namespace capstan::imports
