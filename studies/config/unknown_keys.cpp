#include <fmt/format.h>

#include <algorithm>

#include "capstan/config/config_key.h"
#include "capstan/config/toml_nodes.h"
#include "capstan/platform/nearest_name.h"

namespace capstan::config {

namespace {

// Keys of a section, and sections right below it.
template <class Plan>
std::vector<std::string> known_names(std::string_view section) {
    std::vector<std::string> names;
    for (const ConfigKey<Plan>& key : config_schema<Plan>().keys) {
        if (key.section == section) names.emplace_back(key.name);
    }
    for (const ConfigSection<Plan>& other : config_schema<Plan>().sections) {
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

template <class Plan>
std::string where_else(const std::string& name, std::string_view section,
                       const std::vector<std::string>& known) {
    for (const ConfigKey<Plan>& key : config_schema<Plan>().keys) {
        if (key.name != name || key.section == section) continue;
        return key.section.empty() ? "; it belongs to the top of the file, before the first section"
                                   : fmt::format("; it belongs to section [{}]", key.section);
    }
    return suggestion(name, known);
}

}  // namespace

template <class Plan>
std::vector<ConfigProblem> unknown_keys(const toml::table& table, std::string_view section,
                                        const std::string& path) {
    std::vector<ConfigProblem> problems;
    const std::vector<std::string> known = known_names<Plan>(section);
    for (const auto& [key, node] : table) {
        const std::string name(key.str());
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        const std::string full = path.empty() ? name : path + "." + name;
        problems.push_back({static_cast<int>(key.source().begin.line), 0, full,
                            "unknown key" + where_else<Plan>(name, section, known)});
    }
    return problems;
}
template std::vector<ConfigProblem> unknown_keys<StudyPlan>(const toml::table&, std::string_view,
                                                            const std::string&);
template std::vector<ConfigProblem> unknown_keys<bench::BenchPlan>(const toml::table&, std::string_view,
                                                                   const std::string&);

}  // namespace capstan::config
