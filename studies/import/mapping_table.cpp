#include "capstan/import/mapping_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "capstan/platform/nearest_name.h"

namespace capstan::imports {

void MappingTable::knows(std::initializer_list<const char*> names) const {
    const std::vector<std::string> known(names.begin(), names.end());
    for (const auto& [key, node] : *table_) {
        if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
        problem(node, std::string(key.str()), "is not a key here" + suggestion(key.str(), known));
    }
}

std::optional<std::string> MappingTable::text(const char* key) const {
    const toml::node* node = table_->get(key);
    if (node == nullptr) return std::nullopt;
    if (const auto value = node->value<std::string>()) return *value;
    problem(*node, key, "should be a text in quotes");
    return std::nullopt;
}

std::optional<double> MappingTable::number(const char* key) const {
    const toml::node* node = table_->get(key);
    if (node == nullptr) return std::nullopt;
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    if (value && std::isfinite(*value)) return *value;
    problem(*node, key, "should be a number");
    return std::nullopt;
}

std::optional<double> MappingTable::positive(const char* key) const {
    const std::optional<double> value = number(key);
    if (value && *value <= 0.0) problem(*table_->get(key), key, "must be above 0");
    return value;
}

std::optional<bool> MappingTable::boolean(const char* key) const {
    const toml::node* node = table_->get(key);
    if (node == nullptr) return std::nullopt;
    if (const auto value = node->value<bool>(); value && node->is_boolean()) return *value;
    problem(*node, key, "should be true or false");
    return std::nullopt;
}

std::vector<std::string> MappingTable::texts(const char* key) const {
    const toml::node* node = table_->get(key);
    if (node == nullptr) return {};
    std::vector<std::string> values;
    if (const toml::array* list = node->as_array()) {
        for (const toml::node& element : *list) {
            const auto value = element.value<std::string>();
            if (!value) problem(element, key, "should hold texts in quotes");
            values.push_back(value.value_or(""));
        }
    } else {
        problem(*node, key, "should be a list of texts, [\"a.csv\", \"b.csv\"]");
    }
    return values;
}

void MappingTable::problem(const toml::node& node, const std::string& key, const std::string& what) const {
    problems_->add(fmt::format("{}:{}", *file_, node.source().begin.line), path_ + key + ": " + what);
}

std::vector<std::string> keys_in_order(const toml::table& table) {
    std::vector<std::pair<std::pair<unsigned, unsigned>, std::string>> order;
    for (const auto& [key, node] : table)
        order.push_back({{key.source().begin.line, key.source().begin.column}, std::string(key.str())});
    std::sort(order.begin(), order.end());
    std::vector<std::string> keys;
    for (auto& [at, key] : order) keys.push_back(std::move(key));
    return keys;
}

nlohmann::ordered_json json_of(const toml::node& node) {
    if (const toml::table* table = node.as_table()) {
        nlohmann::ordered_json object = nlohmann::ordered_json::object();
        for (const std::string& key : keys_in_order(*table)) object[key] = json_of(*table->get(key));
        return object;
    }
    if (const toml::array* list = node.as_array()) {
        nlohmann::ordered_json array = nlohmann::ordered_json::array();
        for (const toml::node& element : *list) array.push_back(json_of(element));
        return array;
    }
    if (node.is_boolean()) return *node.value<bool>();
    if (node.is_integer()) return *node.value<std::int64_t>();
    if (node.is_floating_point()) return *node.value<double>();
    if (node.is_string()) return *node.value<std::string>();
    std::ostringstream date;
    node.visit([&](const auto& value) {
        if constexpr (toml::is_date_time<decltype(value)> || toml::is_date<decltype(value)> ||
                      toml::is_time<decltype(value)>)
            date << value.get();
    });
    return date.str();
}

}  // namespace capstan::imports
