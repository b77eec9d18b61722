#pragma once
// Sensor nodes as the database keeps them: '[1,6,11]', which SQLite's json_each can take apart in a query.

#include <string>
#include <string_view>
#include <vector>

namespace capstan::storage {

std::string node_list_text(const std::vector<int>& nodes);
std::vector<int> parse_node_list(std::string_view text);

}  // namespace capstan::storage
