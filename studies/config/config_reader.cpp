#include "capstan/config/config_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/config/config_file.h"
#include "capstan/config/config_key.h"
#include "capstan/config/config_problem.h"
#include "capstan/config/config_values.h"
#include "capstan/config/far_end_log.h"
#include "capstan/config/plan_checks.h"
#include "capstan/config/toml_nodes.h"

namespace capstan::config {

namespace {

// Reads the text section by section, in the order of the key table, and goes on after a problem.
template <class Plan>
class Reading {
  public:
    Reading(const toml::table& root, ReadPlan<Plan>& config,
            const std::optional<std::filesystem::path>& folder)
        : root_(root), config_(config), folder_(folder) {}

    std::vector<ConfigProblem> run() {
        note_problems(unknown_keys<Plan>(root_, "", ""));
        for (const Section& section : config_sections()) {
            section.is_repeated() ? read_repeated(section) : read_single(section);
        }
        if (const auto complete = config_schema<Plan>().complete) {
            for (const KeyProblem& each : complete(config_.plan, config_.lines, folder_))
                if (!is_broken(each.key.substr(0, each.key.find_first_of(".[")))) problem_at(each);
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
        if (section.note_present != nullptr) section.note_present(config_.plan);
        if (!section.path.empty())
            note_problems(unknown_keys<Plan>(*table, section.path, std::string(section.path)));
        read_keys(section, table, 0, std::string(section.path));
    }

    void read_repeated(const Section& section) {
        const toml::node* node = find(section.path);
        if (node == nullptr) {
            if (section.fill_default != nullptr) section.fill_default(config_.plan);
            return;
        }
        const toml::array* rows = node->as_array();
        if (rows == nullptr ||
            !std::all_of(rows->begin(), rows->end(), [](auto& row) { return row.is_table(); })) {
            problem(*node, section.path,
                    fmt::format("must be a list of tables; write [[{}]] with two brackets before each",
                                section.path));
            if (section.fill_default != nullptr) section.fill_default(config_.plan);
            return;
        }
        if (rows->empty()) {
            problem(*node, section.path, "is empty; give at least one, or leave it out for the default");
            if (section.fill_default != nullptr) section.fill_default(config_.plan);
            return;
        }
        note_line(section.path, *node);
        section.set_rows(config_.plan, static_cast<int>(rows->size()));
        for (std::size_t row = 0; row < rows->size(); ++row) {
            const std::string path = fmt::format("{}[{}]", section.path, row + 1);
            const toml::table& table = *(*rows)[row].as_table();
            note_line(path, table);
            note_problems(unknown_keys<Plan>(table, section.path, path));
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
        const ReadValue read = value_of(*node, key.allowed, path);
        note_problems(read.problems);
        if (read.value) {
            key.write(config_.plan, row, *read.value);
        } else if (!std::holds_alternative<std::monostate>(key.default_value)) {
            key.write(config_.plan, row, key.default_value);  // so that other keys can still be checked
        }
    }

    // ---- problems

    void note_line(std::string_view path, const toml::node& node) {
        config_.lines.emplace(std::string(path), line_of(node));
    }

    bool is_broken(const std::string& section) const {
        return std::any_of(problems_.begin(), problems_.end(),
                           [&](const ConfigProblem& known) { return known.key.starts_with(section); });
    }

    void problem_at(const KeyProblem& problem) {
        problems_.push_back({line_of_key(config_.lines, problem.key), 0, problem.key, problem.message});
    }

    void problem(const toml::node& node, std::string_view path, std::string message) {
        problems_.push_back({line_of(node), 0, std::string(path), std::move(message)});
    }

    void note_problems(const std::vector<ConfigProblem>& more) {
        problems_.insert(problems_.end(), more.begin(), more.end());
    }

    const toml::table& root_;
    ReadPlan<Plan>& config_;
    const std::optional<std::filesystem::path>& folder_;
    std::vector<ConfigProblem> problems_;
};

}  // namespace

template <class Plan>
ReadPlan<Plan> parse_plan(std::string_view toml, const std::string& file,
                          const std::optional<std::filesystem::path>& folder) {
    ReadPlan<Plan> config;  // not in braces: g++ 12 then cleans up what a failed member leaves unmade
    config.file = file;
    toml::table root;
    try {
        root = parsed(toml, file);
    } catch (const toml::parse_error& error) {
        const auto& at = error.source().begin;
        throw ConfigError(file, {{static_cast<int>(at.line), static_cast<int>(at.column), "",
                                  "not valid TOML: " + std::string(error.description())}});
    }
    std::vector<ConfigProblem> problems = Reading<Plan>(root, config, folder).run();
    if constexpr (std::is_same_v<Plan, StudyPlan>)
        if (problems.empty() && folder) take_named_far_end_log(config);
    std::vector<ConfigProblem> more = value_problems(config, problems);
    if constexpr (std::is_same_v<Plan, StudyPlan>)
        if (!problems.empty() && folder && !config.plan.uncertainty.far_end_log.empty())
            std::erase_if(more, [](const ConfigProblem& each) {  // the log has not been read yet
                return each.key == "uncertainty.far_end";
            });
    problems.insert(problems.end(), more.begin(), more.end());
    if (!problems.empty()) throw ConfigError(file, std::move(problems));
    return config;
}
template ReadPlan<StudyPlan> parse_plan(std::string_view, const std::string&,
                                        const std::optional<std::filesystem::path>&);
template ReadPlan<bench::BenchPlan> parse_plan(std::string_view, const std::string&,
                                               const std::optional<std::filesystem::path>&);

ReadConfig parse_config(std::string_view toml, const std::string& file) {
    return parse_plan<StudyPlan>(toml, file);
}

ReadConfig read_config(const std::filesystem::path& path) {
    const std::string toml = content_of(path);
    if (content_described_by(toml) == ConfigContent::bench) {
        throw ConfigError(path.string(), {{0, 0, "",
                                           "describes a bench, not a study; run it with `capstan simulate " +
                                               path.string() + "`"}});
    }
    return parse_plan<StudyPlan>(toml, path.string(), path.parent_path());
}

ReadBench read_bench(const std::filesystem::path& path) {
    return parse_plan<bench::BenchPlan>(content_of(path), path.string());
}

}  // namespace capstan::config
