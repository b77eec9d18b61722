#pragma once
// In what two configurations differ.

#include <string>
#include <vector>

namespace capstan::reports {

struct SettingDifference {
    std::string key;  // 'transmission.segments', 'noise[2].label'
    std::string first;
    std::string second;  // '': not there
};

// Of two configurations with every key written out on a line of its own, as studies store them.
std::vector<SettingDifference> setting_differences(const std::string& first_toml,
                                                   const std::string& second_toml);

}  // namespace capstan::reports
