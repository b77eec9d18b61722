#include "capstan/config/config_writer.h"

#include <fmt/format.h>

#include <cmath>

#include "capstan/config/config_key.h"
#include "capstan/config/config_reader.h"
#include "capstan/platform/wrapped_text.h"

namespace capstan::config {

std::string toml_string(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (byte < 0x20 || byte == 0x7f) {
            result += fmt::format("\\u{:04X}", byte);
        } else {
            result += c;
        }
    }
    return result + "\"";
}

namespace {

template <class Item, class Text>
std::string list_text(const std::vector<Item>& items, Text text) {
    std::string result = "[";
    for (std::size_t k = 0; k < items.size(); ++k) result += (k == 0 ? "" : ", ") + text(items[k]);
    return result + "]";
}

struct ToToml {
    std::string operator()(std::monostate) const { return {}; }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return toml_number(value); }
    std::string operator()(const std::string& value) const { return toml_string(value); }
    template <class Item>
    std::string operator()(const std::vector<Item>& value) const {
        return list_text(value, *this);
    }
};

std::string_view kind_words(ValueKind kind) {
    switch (kind) {
        case ValueKind::string:
            return "text";
        case ValueKind::integer:
            return "integer";
        case ValueKind::number:
            return "number";
        case ValueKind::boolean:
            return "true or false";
        case ValueKind::choice:
            return "";
        case ValueKind::integers:
            return "list of integers";
        case ValueKind::numbers:
            return "list of numbers";
        case ValueKind::names:
            return "list of names";
        case ValueKind::node_sets:
            return "list of lists of nodes";
    }
    return {};
}

// "number [N], above 0; default 2000.0"
template <class Plan>
std::string facts_of(const ConfigKey<Plan>& key) {
    std::string facts(kind_words(key.allowed.kind));
    if (key.allowed.kind == ValueKind::choice) {
        for (const auto& name : key.allowed.names) facts += (facts.empty() ? "" : " or ") + toml_string(name);
    }
    if (key.allowed.takes_all) facts += " or \"all\"";
    if (!key.allowed.unit.empty()) facts += fmt::format(" [{}]", key.allowed.unit);
    if (const std::string limits = key.allowed.limits.words(); !limits.empty()) facts += ", " + limits;
    const std::string default_text = std::visit(ToToml{}, key.default_value);
    if (key.presence == Presence::required) {
        facts += "; required";
    } else {
        facts += default_text.empty() ? "; default: left out" : "; default " + default_text;
    }
    if (!key.condition.words.empty()) facts += "; only with " + key.condition.words;
    return facts;
}

constexpr std::size_t comment_width = 110;

std::string comment(std::string_view text) {
    return wrapped(text, comment_width, "# ", "# ") + "\n";
}

template <class Plan>
std::string key_text(const ConfigKey<Plan>& key, const Plan& plan, int row, Comments comments) {
    const bool applies = !key.condition.holds || key.condition.holds(plan, row);
    const std::string value = applies ? std::visit(ToToml{}, key.read(plan, row)) : "";
    std::string text;
    if (comments == Comments::every_key && row == 0) {
        text += "\n" + comment(key.help) + comment(facts_of(key));
        if (value.empty()) text += fmt::format("# {} =\n", key.name);
    }
    if (!value.empty()) text += fmt::format("{} = {}\n", key.name, value);
    return text;
}

template <class Plan>
std::string section_text(const ConfigSection<Plan>& section, const Plan& plan, int row, Comments comments) {
    std::string text;
    if (!section.path.empty()) {
        text += "\n";
        if (comments == Comments::every_key && row == 0) text += comment(section.help);
        text += section.is_repeated() ? fmt::format("[[{}]]\n", section.path)
                                      : fmt::format("[{}]\n", section.path);
    }
    for (const ConfigKey<Plan>& key : config_schema<Plan>().keys) {
        if (key.section == section.path) text += key_text(key, plan, row, comments);
    }
    return text;
}

// A list of tables of which the plan has none, as comments to fill in.
template <class Plan>
std::string unused_section_text(const ConfigSection<Plan>& section) {
    std::string text = "\n" + comment(section.help) + fmt::format("# [[{}]]\n", section.path);
    for (const ConfigKey<Plan>& key : config_schema<Plan>().keys) {
        if (key.section != section.path) continue;
        text += "\n" + comment(key.help) + comment(facts_of(key)) + fmt::format("# {} =\n", key.name);
    }
    return text;
}

}  // namespace

template <class Plan>
std::string config_text(const Plan& plan, Comments comments) {
    std::string text;
    if (comments == Comments::every_key) text += comment(config_schema<Plan>().introduction);
    for (const ConfigSection<Plan>& section : config_schema<Plan>().sections) {
        const bool is_used = section.is_used == nullptr || section.is_used(plan);
        if (!is_used && comments == Comments::none) continue;
        const int rows = section.is_repeated() ? section.rows(plan) : 1;
        if (rows == 0 && comments == Comments::every_key) text += unused_section_text(section);
        for (int row = 0; row < rows; ++row) text += section_text(section, plan, row, comments);
    }
    return text;
}
template std::string config_text(const StudyPlan& plan, Comments comments);
template std::string config_text(const bench::BenchPlan& plan, Comments comments);

std::string toml_number(double value) {
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".en") == std::string::npos) text += ".0";
    return text;
}

StudyPlan default_plan() {
    return parse_config("", "defaults").plan;
}

bench::BenchPlan default_bench() {
    return parse_plan<bench::BenchPlan>("kind = \"bench\"", "defaults").plan;
}

std::string Limits::words() const {
    const auto number = [](double value) { return fmt::format("{}", value); };
    const bool open_above = std::isinf(high) || high >= 1e7;
    if (std::isinf(low)) return open_above ? "" : "at most " + number(high);
    if (open_above) return low_is_allowed ? number(low) + " or more" : "above " + number(low);
    return (low_is_allowed ? "" : "above ") + number(low) + " to " + number(high);
}

}  // namespace capstan::config
