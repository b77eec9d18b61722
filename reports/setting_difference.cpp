#include "capstan/reports/setting_difference.h"

#include <map>
#include <set>
#include <sstream>

namespace capstan::reports {
namespace {

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

std::map<std::string, std::string> settings_of(const std::string& toml) {
    std::map<std::string, std::string> settings;
    std::map<std::string, int> rows;
    std::istringstream lines(toml);
    std::string line, section;
    while (std::getline(lines, line)) {
        line = trimmed(line);
        if (line.empty() || line.front() == '#') continue;
        if (line.starts_with("[[")) {
            const std::string name = line.substr(2, line.find("]]") - 2);
            section = name + "[" + std::to_string(++rows[name]) + "].";
        } else if (line.front() == '[') {
            section = line.substr(1, line.find(']') - 1) + ".";
        } else if (const auto equals = line.find('='); equals != std::string::npos) {
            settings[section + trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
        }
    }
    return settings;
}

}  // namespace

std::vector<SettingDifference> setting_differences(const std::string& first_toml,
                                                   const std::string& second_toml) {
    auto first = settings_of(first_toml);
    auto second = settings_of(second_toml);
    std::set<std::string> keys;
    for (const auto& [key, value] : first) keys.insert(key);
    for (const auto& [key, value] : second) keys.insert(key);
    std::vector<SettingDifference> differences;
    for (const std::string& key : keys) {
        if (first[key] != second[key]) differences.push_back({key, first[key], second[key]});
    }
    return differences;
}

}  // namespace capstan::reports
