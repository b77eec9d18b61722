#include "capstan/cli/config_reader.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

#include "capstan/cli/config_consistency.h"
#include "capstan/cli/config_key.h"
#include "capstan/cli/config_problem.h"
#include "capstan/cli/config_writer.h"
#include "capstan/cli/nearest_name.h"
#include "capstan/cli/second_reading.h"

namespace capstan::cli {

namespace {

std::string_view type_words(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::none:
            return "nothing";
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "a list";
        case toml::node_type::string:
            return "a text";
        case toml::node_type::integer:
            return "a whole number";
        case toml::node_type::floating_point:
            return "a number with a fraction";
        case toml::node_type::boolean:
            return "true or false";
        case toml::node_type::date:
            return "a date";
        case toml::node_type::time:
            return "a time";
        case toml::node_type::date_time:
            return "a date and time";
    }
    return "something else";
}

std::string number_text(double value) {
    return fmt::format("{}", value);
}

// Reads the text section by section, in the order of the key table, and goes on after a problem.
template <class Plan>
class Reading {
  public:
    Reading(const toml::table& root, ReadPlan<Plan>& config) : root_(root), config_(config) {}

    std::vector<ConfigProblem> run() {
        refuse_unknown_keys(root_, "", "");
        for (const Section& section : config_sections()) {
            section.is_repeated() ? read_repeated(section) : read_single(section);
        }
        return std::move(problems_);
    }

  private:
    using Key = ConfigKey<Plan>;
    using Section = ConfigSection<Plan>;

    static const std::vector<Key>& config_keys() { return config_schema<Plan>().keys; }
    static const std::vector<Section>& config_sections() { return config_schema<Plan>().sections; }

    // ---- sections

    void read_single(const Section& section) {
        const toml::node* node = find(section.path);
        if (node == nullptr) return read_keys(section, nullptr, 0, std::string(section.path));
        const toml::table* table = node->as_table();
        if (table == nullptr) {
            problem(
                *node, section.path,
                fmt::format("is {}, but must be a table; write [{}] on a line of its own and its keys below",
                            type_words(*node), section.path));
            return read_keys(section, nullptr, 0, std::string(section.path));
        }
        note_line(section.path, *node);
        if (!section.path.empty()) refuse_unknown_keys(*table, section.path, std::string(section.path));
        read_keys(section, table, 0, std::string(section.path));
    }

    void read_repeated(const Section& section) {
        const toml::node* node = find(section.path);
        if (node == nullptr) return section.fill_default(config_.plan);
        const toml::array* rows = node->as_array();
        if (rows == nullptr ||
            !std::all_of(rows->begin(), rows->end(), [](auto& row) { return row.is_table(); })) {
            problem(*node, section.path,
                    fmt::format("must be a list of tables; write [[{}]] with two brackets before each",
                                section.path));
            return section.fill_default(config_.plan);
        }
        if (rows->empty()) {
            problem(*node, section.path, "is empty; give at least one, or leave it out for the default");
            return section.fill_default(config_.plan);
        }
        note_line(section.path, *node);
        section.set_rows(config_.plan, static_cast<int>(rows->size()));
        for (std::size_t row = 0; row < rows->size(); ++row) {
            const std::string path = fmt::format("{}[{}]", section.path, row + 1);
            const toml::table& table = *(*rows)[row].as_table();
            note_line(path, table);
            refuse_unknown_keys(table, section.path, path);
            read_keys(section, &table, static_cast<int>(row), path);
        }
    }

    // The node at a path of plain names; nothing if any part of it is not there (a part of a wrong type is
    // reported where it is read).
    const toml::node* find(std::string_view path) const {
        const toml::node* node = &root_;
        while (!path.empty()) {
            const std::string_view name = path.substr(0, path.find('.'));
            path.remove_prefix(std::min(path.size(), name.size() + 1));
            const toml::table* table = node->as_table();
            node = table == nullptr ? nullptr : table->get(name);
            if (node == nullptr) return nullptr;
        }
        return node;
    }

    void refuse_unknown_keys(const toml::table& table, std::string_view section, const std::string& path) {
        const std::vector<std::string> known = known_names(section);
        for (const auto& [key, node] : table) {
            const std::string name(key.str());
            if (std::find(known.begin(), known.end(), name) != known.end()) continue;
            const std::string full = path.empty() ? name : path + "." + name;
            problems_.push_back({static_cast<int>(key.source().begin.line), 0, full,
                                 "unknown key" + where_else(name, section, known)});
        }
    }

    static std::string where_else(const std::string& name, std::string_view section,
                                  const std::vector<std::string>& known) {
        for (const Key& key : config_keys()) {
            if (key.name != name || key.section == section) continue;
            return key.section.empty() ? "; it belongs to the top of the file, before the first section"
                                       : fmt::format("; it belongs to section [{}]", key.section);
        }
        return suggestion(name, known);
    }

    // Keys of a section, and sections right below it.
    static std::vector<std::string> known_names(std::string_view section) {
        std::vector<std::string> names;
        for (const Key& key : config_keys()) {
            if (key.section == section) names.emplace_back(key.name);
        }
        for (const Section& other : config_sections()) {
            if (other.path.empty()) continue;
            const auto dot = other.path.rfind('.');
            const std::string_view parent =
                dot == std::string_view::npos ? "" : std::string_view(other.path).substr(0, dot);
            if (parent == section) {
                names.emplace_back(other.path.substr(dot == std::string_view::npos ? 0 : dot + 1));
            }
        }
        return names;
    }

    // ---- keys

    void read_keys(const Section& section, const toml::table* table, int row, const std::string& path) {
        for (const Key& key : config_keys()) {
            if (key.section != section.path) continue;
            const std::string full =
                path.empty() ? std::string(key.name) : path + "." + std::string(key.name);
            read_key(key, table, row, full);
        }
    }

    void read_key(const Key& key, const toml::table* table, int row, const std::string& path) {
        const toml::node* node = table == nullptr ? nullptr : table->get(key.name);
        const bool applies = !key.condition.holds || key.condition.holds(config_.plan, row);
        if (node == nullptr) {
            if (!applies) return;
            if (key.presence == Presence::required) {
                problems_.push_back(
                    {table == nullptr ? 0 : line_of(*table), 0, path,
                     fmt::format("is missing; it is required{}",
                                 key.condition.words.empty() ? "" : " with " + key.condition.words)});
            } else if (!std::holds_alternative<std::monostate>(key.default_value)) {
                key.write(config_.plan, row, key.default_value);
            }
            return;
        }
        note_line(path, *node);
        if (!applies) {
            return problem(*node, path,
                           fmt::format("has a meaning only with {}; remove it, or change what it depends on",
                                       key.condition.words));
        }
        if (const std::optional<ConfigValue> value = value_of(key, *node, path)) {
            key.write(config_.plan, row, *value);
        }
    }

    // The value of a node as its key wants it; nothing after a problem.
    std::optional<ConfigValue> value_of(const Key& key, const toml::node& node, const std::string& path) {
        if (key.takes_all && node.value_exact<std::string>() == "all") return ConfigValue{std::string("all")};
        switch (key.kind) {
            case ValueKind::text:
                return text_of(node, path);
            case ValueKind::choice:
                return name_of_list(key, node, path);
            case ValueKind::yes_or_no:
                return flag_of(node, path);
            case ValueKind::whole_number:
                return whole_of(key, node, path);
            case ValueKind::real_number:
                return real_of(key, node, path);
            case ValueKind::whole_numbers:
                return list_of<std::int64_t>(key, node, path, &Reading::whole_of);
            case ValueKind::real_numbers:
                return reals_of(key, node, path);
            case ValueKind::names:
                return list_of<std::string>(key, node, path, &Reading::name_of_list);
            case ValueKind::node_sets:
                return sets_of(key, node, path);
        }
        return std::nullopt;
    }

    std::optional<ConfigValue> text_of(const toml::node& node, const std::string& path) {
        const auto text = node.value_exact<std::string>();
        if (!text) return wrong_type(node, path, "a text in quotes");
        if (text->empty()) return refuse(node, path, "is empty; give it a text");
        return *text;
    }

    std::optional<ConfigValue> flag_of(const toml::node& node, const std::string& path) {
        const auto flag = node.value_exact<bool>();
        if (!flag) return wrong_type(node, path, "true or false, without quotes");
        return *flag;
    }

    std::optional<ConfigValue> name_of_list(const Key& key, const toml::node& node, const std::string& path) {
        const auto name = node.value_exact<std::string>();
        if (!name) return wrong_type(node, path, "a text in quotes");
        if (std::find(key.names.begin(), key.names.end(), *name) == key.names.end()) {
            return refuse(node, path,
                          fmt::format("\"{}\" is not known{}", *name, suggestion(*name, key.names)));
        }
        return *name;
    }

    std::optional<ConfigValue> whole_of(const Key& key, const toml::node& node, const std::string& path) {
        const auto value = node.value_exact<std::int64_t>();
        if (!value) return wrong_type(node, path, "a whole number");
        if (!key.limits.admits(static_cast<double>(*value)))
            return out_of_range(key, node, path, std::to_string(*value));
        return *value;
    }

    std::optional<ConfigValue> real_of(const Key& key, const toml::node& node, const std::string& path) {
        if (!node.is_number()) return wrong_type(node, path, "a number");
        const double value = *node.value<double>();
        if (!std::isfinite(value))
            return refuse(node, path, "is " + number_text(value) + "; it must be finite");
        if (!key.limits.admits(value)) return out_of_range(key, node, path, number_text(value));
        return value;
    }

    template <class Item>
    std::optional<ConfigValue> list_of(const Key& key, const toml::node& node, const std::string& path,
                                       std::optional<ConfigValue> (Reading::*item_of)(const Key&,
                                                                                      const toml::node&,
                                                                                      const std::string&)) {
        const toml::array* array = node.as_array();
        if (array == nullptr) {
            return wrong_type(node, path, key.takes_all ? "a list in [ ] or \"all\"" : "a list in [ ]");
        }
        std::vector<Item> items;
        bool good = true;
        for (const toml::node& element : *array) {
            const auto item = (this->*item_of)(key, element, path);
            good = good && item.has_value();
            if (!item) continue;
            const Item& value = std::get<Item>(*item);
            if (std::find(items.begin(), items.end(), value) != items.end()) {
                good = false;
                problem(element, path, fmt::format("{} is given twice; remove one", value));
            }
            items.push_back(value);
        }
        if (!good) return std::nullopt;
        return items;
    }

    std::optional<ConfigValue> reals_of(const Key& key, const toml::node& node, const std::string& path) {
        const toml::array* array = node.as_array();
        if (array == nullptr) return wrong_type(node, path, "a list in [ ]");
        if (array->empty() && !key.may_be_empty)
            return refuse(node, path, "is empty; give it at least one number");
        std::vector<double> values;
        bool good = true;
        for (const toml::node& element : *array) {
            const auto value = real_of(key, element, path);
            good = good && value.has_value();
            if (value) values.push_back(std::get<double>(*value));
        }
        if (!good) return std::nullopt;
        return values;
    }

    std::optional<ConfigValue> sets_of(const Key& key, const toml::node& node, const std::string& path) {
        const toml::array* array = node.as_array();
        if (array == nullptr) return wrong_type(node, path, "a list of lists, as [[1, 6, 11]]");
        std::vector<std::vector<std::int64_t>> sets;
        bool good = true;
        for (const toml::node& element : *array) {
            if (!element.is_array()) {
                problem(element, path,
                        "holds " + std::string(type_words(element)) +
                            ", but each layout is a list of its own, as [[1, 6, 11], [3, 9]]");
                good = false;
                continue;
            }
            if (element.as_array()->empty()) {
                problem(element, path, "holds a layout without a sensor; name its nodes or remove it");
                good = false;
                continue;
            }
            const auto nodes = list_of<std::int64_t>(key, element, path, &Reading::whole_of);
            good = good && nodes.has_value();
            if (nodes) sets.push_back(std::get<std::vector<std::int64_t>>(*nodes));
        }
        if (!good) return std::nullopt;
        return sets;
    }

    // ---- problems

    static int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

    void note_line(std::string_view path, const toml::node& node) {
        config_.lines.emplace(std::string(path), line_of(node));
    }

    void problem(const toml::node& node, std::string_view path, std::string message) {
        problems_.push_back({line_of(node), 0, std::string(path), std::move(message)});
    }

    std::optional<ConfigValue> refuse(const toml::node& node, std::string_view path, std::string message) {
        problem(node, path, std::move(message));
        return std::nullopt;
    }

    std::optional<ConfigValue> wrong_type(const toml::node& node, std::string_view path,
                                          std::string_view wanted) {
        return refuse(node, path, fmt::format("is {}, but must be {}", type_words(node), wanted));
    }

    std::optional<ConfigValue> out_of_range(const Key& key, const toml::node& node, std::string_view path,
                                            const std::string& value) {
        const std::string unit = key.unit.empty() ? "" : " " + std::string(key.unit);
        return refuse(node, path, fmt::format("is {}{}, but must be {}", value, unit, key.limits.words()));
    }

    const toml::table& root_;
    ReadPlan<Plan>& config_;
    std::vector<ConfigProblem> problems_;
};

std::string content_of(const std::filesystem::path& path) {
    const std::string file = path.string();
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        throw ConfigError(file,
                          {{0, 0, "", "no such file; `capstan config default -o " + file + "` makes one"}});
    }
    if (std::filesystem::is_directory(path, ignored)) {
        throw ConfigError(file, {{0, 0, "", "is a folder; name the configuration file in it"}});
    }
    return read_again_if_wrong<ConfigError>([&] {
        std::ifstream stream(path, std::ios::binary);
        std::string content{std::istreambuf_iterator<char>(stream), {}};
        if (!stream) throw ConfigError(file, {{0, 0, "", "cannot be read; check its permissions"}});
        return content;
    });
}

toml::table parsed(std::string_view toml, const std::string& file) {
    return read_again_if_wrong<toml::parse_error>([&] { return toml::table(toml::parse(toml, file)); });
}

// A bench without the key that says so has pulleys all the same.
bool describes_a_bench(std::string_view toml) {
    try {
        const toml::table root = parsed(toml, "");
        return root["kind"].value<std::string>() == "bench" || root.contains("pulleys");
    } catch (const toml::parse_error&) {
        return false;
    }
}

// A message of the study begins with the path of what it speaks of, "layouts.counts: ..." or "regime mass:
// ...". 0 where that does not stand in the file.
int line_spoken_of(const std::string& message, const ReadConfig& config) {
    const auto line_of = [&](const std::string& path) {
        const auto line = config.lines.find(path);
        return line == config.lines.end() ? 0 : line->second;
    };
    for (std::size_t k = 0; k < config.plan.regimes.size(); ++k) {
        const std::string subject = fmt::format("regime {}", name_of(config.plan.regimes[k].regime));
        const bool is_subject = message.starts_with(subject + ":") || message.starts_with(subject + " ");
        if (is_subject) return line_of(fmt::format("regime[{}].samples", k + 1));
    }
    const std::string subject = message.substr(0, message.find_first_of(": "));
    if (message.compare(subject.size(), 2, ": ") == 0) {  // perhaps "transmission: segments is 0"
        const std::string rest = message.substr(subject.size() + 2);
        const int line = line_of(subject + "." + rest.substr(0, rest.find_first_of(": ")));
        if (line != 0) return line;
    }
    return line_of(subject);
}

}  // namespace

template <class Plan>
ReadPlan<Plan> parse_plan(std::string_view toml, const std::string& file) {
    ReadPlan<Plan> config{file, {}, {}};
    toml::table root;
    try {
        root = parsed(toml, file);
    } catch (const toml::parse_error& error) {
        const auto& at = error.source().begin;
        throw ConfigError(file, {{static_cast<int>(at.line), static_cast<int>(at.column), "",
                                  "not valid TOML: " + std::string(error.description())}});
    }
    std::vector<ConfigProblem> problems = Reading<Plan>(root, config).run();
    const std::vector<ConfigProblem> more = inconsistencies_of(config, problems);
    problems.insert(problems.end(), more.begin(), more.end());
    if (!problems.empty()) throw ConfigError(file, std::move(problems));
    config.plan.config_toml = config_text(config.plan, Comments::none);
    return config;
}
template ReadPlan<StudyPlan> parse_plan(std::string_view toml, const std::string& file);
template ReadPlan<bench::BenchPlan> parse_plan(std::string_view toml, const std::string& file);

ReadConfig parse_config(std::string_view toml, const std::string& file) {
    return parse_plan<StudyPlan>(toml, file);
}

ConfigContent content_of_config(const std::filesystem::path& path) {
    return describes_a_bench(content_of(path)) ? ConfigContent::bench : ConfigContent::study;
}

ReadConfig read_config(const std::filesystem::path& path) {
    const std::string toml = content_of(path);
    if (describes_a_bench(toml)) {
        throw ConfigError(path.string(), {{0, 0, "",
                                           "describes a bench, not a study; run it with `capstan simulate " +
                                               path.string() + "`"}});
    }
    return parse_config(toml, path.string());
}

ReadBench read_bench(const std::filesystem::path& path) {
    return parse_plan<bench::BenchPlan>(content_of(path), path.string());
}

void require_runnable(const ReadConfig& config) {
    std::vector<ConfigProblem> problems;
    for (const std::string& message : problems_of(config.plan)) {
        problems.push_back({line_spoken_of(message, config), 0, "", message});
    }
    if (!problems.empty()) throw ConfigError(config.file, std::move(problems));
}

}  // namespace capstan::cli
