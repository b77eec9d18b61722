#include "capstan/reports/data.h"

#include <cassert>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace capstan::reports {
namespace {

using nlohmann::ordered_json;

ordered_json json_of(const Data& data) {
    if (const bool* value = data.boolean()) return *value;
    if (const std::int64_t* value = data.integer()) return *value;
    if (const double* value = data.number()) return *value;
    if (const std::string* value = data.text()) return *value;
    if (data.is_nothing()) return nullptr;
    if (data.is_list()) {
        ordered_json list = ordered_json::array();
        for (const Data& item : data.items()) list.push_back(json_of(item));
        return list;
    }
    ordered_json record = ordered_json::object();
    for (std::size_t k = 0; k < data.names().size(); ++k) record[data.names()[k]] = json_of(data.values()[k]);
    return record;
}

Data data_of(const ordered_json& json) {
    switch (json.type()) {
        case ordered_json::value_t::boolean:
            return json.get<bool>();
        case ordered_json::value_t::number_integer:
        case ordered_json::value_t::number_unsigned:
            return json.get<std::int64_t>();
        case ordered_json::value_t::number_float:
            return json.get<double>();
        case ordered_json::value_t::string:
            return json.get<std::string>();
        case ordered_json::value_t::array: {
            Data list = Data::list();
            for (const ordered_json& item : json) list.push_back(data_of(item));
            return list;
        }
        case ordered_json::value_t::object: {
            Data record = Data::record();
            for (const auto& [name, value] : json.items()) record[name] = data_of(value);
            return record;
        }
        case ordered_json::value_t::null:
        case ordered_json::value_t::binary:
        case ordered_json::value_t::discarded:
            return {};
    }
    return {};
}

}  // namespace

Data::Data(std::initializer_list<Member> members) : value_(Record{}) {
    for (const Member& member : members) (*this)[member.name] = member.value;
}

const std::vector<Data>& Data::items() const {
    static const std::vector<Data> none;
    const auto* list = std::get_if<std::vector<Data>>(&value_);
    return list == nullptr ? none : *list;
}

const std::vector<std::string>& Data::names() const {
    static const std::vector<std::string> none;
    const auto* record = std::get_if<Record>(&value_);
    return record == nullptr ? none : record->names;
}

const std::vector<Data>& Data::values() const {
    static const std::vector<Data> none;
    const auto* record = std::get_if<Record>(&value_);
    return record == nullptr ? none : record->values;
}

Data& Data::operator[](std::string_view name) {
    if (is_nothing()) value_ = Record{};
    assert(std::holds_alternative<Record>(value_));
    auto& record = std::get<Record>(value_);
    for (std::size_t k = 0; k < record.names.size(); ++k) {
        if (record.names[k] == name) return record.values[k];
    }
    record.names.emplace_back(name);
    return record.values.emplace_back();
}

const Data* Data::find(std::string_view path) const {
    const std::string_view name = path.substr(0, path.find('.'));
    for (std::size_t k = 0; k < names().size(); ++k) {
        if (names()[k] != name) continue;
        return name.size() == path.size() ? &values()[k] : values()[k].find(path.substr(name.size() + 1));
    }
    return nullptr;
}

void Data::push_back(Data item) {
    if (is_nothing()) value_ = std::vector<Data>{};
    assert(is_list());
    std::get<std::vector<Data>>(value_).push_back(std::move(item));
}

void Data::update(const Data& record) {
    for (std::size_t k = 0; k < record.names().size(); ++k) (*this)[record.names()[k]] = record.values()[k];
}

Data parse_json(std::string_view text) {
    try {
        return data_of(ordered_json::parse(text));
    } catch (const ordered_json::parse_error& error) {
        throw std::runtime_error(error.what());
    }
}

std::string json_text(const Data& data) {
    return json_of(data).dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string json_line(const Data& data) {
    return json_of(data).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace capstan::reports
