#include "capstan/recording/json_object.h"

#include <fmt/format.h>

#include <cmath>

namespace capstan {

namespace {

const nlohmann::json empty_object = nlohmann::json::object();

}  // namespace

JsonObject::JsonObject(const nlohmann::json& json, std::string place, ProblemList& problems)
    : json_(&json), place_(std::move(place)), problems_(&problems) {
    if (json.is_object()) return;
    problems.add(place_, "should be an object { }");
    json_ = &empty_object;
}

std::string JsonObject::path_of(const std::string& key) const {
    return place_ + (place_.ends_with(": ") ? "" : ".") + key;
}

void JsonObject::add_problem(const std::string& key, const std::string& problem) const {
    problems_->add(path_of(key), problem);
}

const nlohmann::json* JsonObject::find(const char* key) const {
    const auto found = json_->find(key);
    return found == json_->end() || found->is_null() ? nullptr : &*found;
}

bool JsonObject::has(const char* key) const {
    return find(key) != nullptr;
}

bool JsonObject::is_number(const char* key) const {
    const nlohmann::json* value = find(key);
    return value != nullptr && value->is_number();
}

bool JsonObject::is_object(const char* key) const {
    const nlohmann::json* value = find(key);
    return value != nullptr && value->is_object();
}

double JsonObject::number(const char* key) const {
    const nlohmann::json* value = find(key);
    if (value != nullptr && value->is_number()) return value->get<double>();
    add_problem(key, value == nullptr ? "is missing; a number is needed" : "should be a number");
    return 0.0;
}

double JsonObject::positive(const char* key) const {
    const nlohmann::json* value = find(key);
    const double found = number(key);
    if (value != nullptr && value->is_number() && found <= 0.0)
        add_problem(key, fmt::format("is {}; it must be positive", found));
    return found;
}

std::optional<double> JsonObject::optional_number(const char* key) const {
    if (!has(key)) return std::nullopt;
    return number(key);
}

std::optional<std::pair<double, double>> JsonObject::optional_range(const char* key) const {
    const nlohmann::json* value = find(key);
    if (value == nullptr || !value->is_array()) return std::nullopt;
    const bool is_pair = value->size() == 2 && (*value)[0].is_number() && (*value)[1].is_number();
    const double low = is_pair ? (*value)[0].get<double>() : 0.0;
    const double high = is_pair ? (*value)[1].get<double>() : 0.0;
    if (low > 0.0 && high > low) return std::pair{low, high};
    add_problem(key, "should be a number, or a range of two: [low, high], both positive and low below high");
    return std::pair{1.0, 2.0};
}

int JsonObject::integer(const char* key) const {
    const double found = number(key);
    if (found == std::floor(found) && std::abs(found) < 1e9) return static_cast<int>(found);
    add_problem(key, "should be an integer");
    return 0;
}

std::string JsonObject::text(const char* key) const {
    const nlohmann::json* value = find(key);
    if (value != nullptr && value->is_string()) return value->get<std::string>();
    add_problem(key, value == nullptr ? "is missing; a string is needed" : "should be a string");
    return {};
}

std::vector<std::string> JsonObject::texts(const char* key) const {
    const nlohmann::json* value = find(key);
    std::vector<std::string> found;
    if (value == nullptr || !value->is_array()) {
        add_problem(key, value == nullptr ? "is missing; a list of strings is needed"
                                          : "should be a list of strings");
        return found;
    }
    for (const nlohmann::json& element : *value) {
        if (element.is_string()) {
            found.push_back(element.get<std::string>());
        } else {
            add_problem(key, "should contain strings only");
        }
    }
    return found;
}

JsonObject JsonObject::object(const char* key) const {
    const nlohmann::json* value = find(key);
    if (value != nullptr) return {*value, path_of(key), *problems_};
    add_problem(key, "is missing; an object { } is needed");
    return {empty_object, path_of(key), *problems_};
}

std::vector<JsonObject> JsonObject::objects(const char* key) const {
    const nlohmann::json* value = find(key);
    std::vector<JsonObject> found;
    if (value == nullptr || !value->is_array()) {
        add_problem(key, value == nullptr ? "is missing; a list [ ] is needed" : "should be a list [ ]");
        return found;
    }
    for (std::size_t index = 0; index < value->size(); ++index)
        found.emplace_back((*value)[index], fmt::format("{}[{}]", path_of(key), index), *problems_);
    return found;
}

std::vector<std::string> JsonObject::keys() const {
    std::vector<std::string> found;
    for (const auto& item : json_->items()) found.push_back(item.key());
    return found;
}

}  // namespace capstan
