#include "capstan/bench_model/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/bench_model/model_keys.h"
#include "capstan/config/toml_nodes.h"
#include "capstan/platform/nearest_name.h"

namespace capstan::bench_model {

namespace {

using Range = TableReader::Range;

const toml::table no_table;

const char* words_of(Range range) {
    switch (range) {
        case Range::positive:
            return "a number above 0";
        case Range::zero_or_more:
            return "a finite number of 0 or more";
        case Range::finite:
            return "a finite number";
    }
    return "";
}

// A bend radius may be infinite.
bool is_within(Range range, double value) {
    switch (range) {
        case Range::positive:
            return value > 0.0;
        case Range::zero_or_more:
            return std::isfinite(value) && value >= 0.0;
        case Range::finite:
            return std::isfinite(value);
    }
    return false;
}

}  // namespace

TableReader::TableReader(const toml::table& table, std::string path,
                         std::vector<config::ConfigProblem>& problems)
    : table_(table), path_(std::move(path)), problems_(problems) {}

std::string TableReader::full_name(const std::string& key) const {
    return path_.empty() ? key : path_ + "." + key;
}

void TableReader::add_problem(const std::string& key, const std::string& message) {
    const toml::node* node = table_.get(key);
    problems_.push_back({config::line_of(node != nullptr ? *node : table_), 0, full_name(key), message});
}

const toml::node* TableReader::required(const std::string& key, const std::string& what) {
    known_.insert(key);
    const toml::node* node = table_.get(key);
    if (node == nullptr) add_problem(key, fmt::format("is missing; write {}, or save the model again", what));
    return node;
}

template <class Value>
Value TableReader::value_of(const std::string& key, bool (toml::node::*is_type)() const,
                            const std::string& what) {
    const toml::node* node = required(key, what);
    if (node == nullptr) return {};
    if ((node->*is_type)()) return node->value<Value>().value_or(Value{});
    add_problem(key, fmt::format("is {}, but must be {}", config::type_words(*node), what));
    return {};
}

double TableReader::number(const std::string& key, Range range) {
    const std::size_t before = problems_.size();
    const auto value = value_of<double>(key, &toml::node::is_number, words_of(range));
    if (problems_.size() == before && !is_within(range, value))
        add_problem(key, fmt::format("is {}, but must be {}", value, words_of(range)));
    return value;
}

double TableReader::number_or(const std::string& key, Range range, double otherwise) {
    return has(key) ? number(key, range) : otherwise;
}

std::optional<FittedInterval> TableReader::interval(const std::string& key) {
    known_.insert(key);
    if (!has(key)) return {};
    const toml::array* ends = table_.get(key)->as_array();
    if (ends == nullptr || ends->size() != 2 || !ends->get(0)->is_number() || !ends->get(1)->is_number()) {
        add_problem(key, "must be a list of two numbers, [low, high]");
        return {};
    }
    const FittedInterval found{*ends->get(0)->value<double>(), *ends->get(1)->value<double>()};
    if (!(found.low <= found.high))
        add_problem(key, fmt::format("is from {} to {}; write the lower end first", found.low, found.high));
    return found;
}

FittedNumber TableReader::fitted(const std::string& name, const std::string& unit, Range range) {
    const std::string key = key_with_unit(name, unit);
    const double value = number(key, range);
    return {name, unit, value, interval(key + interval_ending)};
}

int TableReader::integer(const std::string& key, int low, int high) {
    const std::string what =
        low == high ? std::to_string(low) : fmt::format("an integer from {} to {}", low, high);
    const std::size_t before = problems_.size();
    const auto value = value_of<std::int64_t>(key, &toml::node::is_integer, what);
    if (problems_.size() == before && (value < low || value > high))
        add_problem(key, fmt::format("is {}, but must be {}", value, what));
    return static_cast<int>(std::clamp<std::int64_t>(value, low, high));
}

bool TableReader::boolean(const std::string& key) {
    return value_of<bool>(key, &toml::node::is_boolean, "true or false");
}

std::string TableReader::text(const std::string& key) {
    return value_of<std::string>(key, &toml::node::is_string, "a text in quotes");
}

std::string TableReader::text_or(const std::string& key, const std::string& otherwise) {
    return has(key) ? text(key) : otherwise;
}

std::vector<int> TableReader::integers(const std::string& key) {
    const toml::node* node = required(key, "a list of integers");
    if (node == nullptr) return {};
    const toml::array* list = node->as_array();
    std::vector<int> values;
    for (std::size_t k = 0; list != nullptr && k < list->size(); ++k)
        if (const auto value = list->get(k)->value<int>()) values.push_back(*value);
    if (list == nullptr || values.size() != list->size()) add_problem(key, "must be a list of integers");
    return values;
}

std::vector<TableReader> TableReader::rows(const std::string& key) {
    known_.insert(key);
    std::vector<TableReader> found;
    if (!has(key)) return found;
    const toml::array* list = table_.get(key)->as_array();
    for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
        if (const toml::table* row = list->get(k)->as_table())
            found.emplace_back(*row, fmt::format("{}[{}]", full_name(key), k + 1), problems_);
    }
    if (list == nullptr || found.size() != list->size()) add_problem(key, "must be a list of tables");
    return found;
}

TableReader TableReader::table(const std::string& key) {
    known_.insert(key);
    const toml::node* node = table_.get(key);
    if (node != nullptr && !node->is_table())
        add_problem(key, fmt::format("is {}, but must be a table", config::type_words(*node)));
    const toml::table* found = node != nullptr ? node->as_table() : nullptr;
    return {found != nullptr ? *found : no_table, full_name(key), problems_};
}

std::vector<std::string> TableReader::keys() const {
    std::vector<std::pair<int, std::string>> found;
    for (const auto& [key, node] : table_)
        found.emplace_back(static_cast<int>(key.source().begin.line), std::string(key.str()));
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& one, const auto& other) { return one.first < other.first; });
    std::vector<std::string> names;
    for (auto& [line, name] : found) names.push_back(std::move(name));
    return names;
}

void TableReader::reject_other_keys() {
    const std::vector<std::string> known(known_.begin(), known_.end());
    for (const std::string& key : keys())
        if (!known_.contains(key)) add_problem(key, "is not a key of a model" + suggestion(key, known));
}

}  // namespace capstan::bench_model
