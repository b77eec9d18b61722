#include "capstan/config/config_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/config/toml_nodes.h"
#include "capstan/platform/nearest_name.h"

namespace capstan::config {

namespace {

std::string number_text(double value) {
    return fmt::format("{}", value);
}

// Reads a node and those in it, and goes on after a problem.
class ValueReading {
  public:
    ValueReading(const AllowedValues& allowed, const std::string& path) : allowed_(allowed), path_(path) {}

    ReadValue run(const toml::node& node) {
        std::optional<ConfigValue> value = value_of(node);
        return {std::move(value), std::move(problems_)};
    }

  private:
    using Value = std::optional<ConfigValue>;  // nothing after a problem
    using ItemReader = Value (ValueReading::*)(const toml::node&);

    Value value_of(const toml::node& node) {
        if (allowed_.takes_all && node.value_exact<std::string>() == "all")
            return ConfigValue{std::string("all")};
        switch (allowed_.kind) {
            case ValueKind::string:
                return text_of(node);
            case ValueKind::choice:
                return name_of_list(node);
            case ValueKind::boolean:
                return flag_of(node);
            case ValueKind::integer:
                return integer_of(node);
            case ValueKind::number:
                return number_of(node);
            case ValueKind::integers:
                return list_of<std::int64_t>(node, &ValueReading::integer_of);
            case ValueKind::numbers:
                return numbers_of(node);
            case ValueKind::names:
                return list_of<std::string>(node, &ValueReading::name_of_list);
            case ValueKind::node_sets:
                return sets_of(node);
        }
        return std::nullopt;
    }

    // ---- single values

    Value text_of(const toml::node& node) {
        const auto text = node.value_exact<std::string>();
        if (!text) return wrong_type(node, "a string in quotes");
        if (text->empty()) return refuse(node, "is empty; give it a text");
        return *text;
    }

    Value flag_of(const toml::node& node) {
        const auto flag = node.value_exact<bool>();
        if (!flag) return wrong_type(node, "true or false, without quotes");
        return *flag;
    }

    Value name_of_list(const toml::node& node) {
        const auto name = node.value_exact<std::string>();
        if (!name) return wrong_type(node, "a string in quotes");
        const std::vector<std::string>& names = allowed_.names;
        if (std::find(names.begin(), names.end(), *name) == names.end())
            return refuse(node, fmt::format("\"{}\" is not known{}", *name, suggestion(*name, names)));
        return *name;
    }

    Value integer_of(const toml::node& node) {
        const auto value = node.value_exact<std::int64_t>();
        if (!value) return wrong_type(node, "an integer");
        if (!allowed_.limits.admits(static_cast<double>(*value)))
            return out_of_range(node, std::to_string(*value), static_cast<double>(*value));
        return *value;
    }

    Value number_of(const toml::node& node) {
        if (!node.is_number()) return wrong_type(node, "a number");
        const double value = *node.value<double>();
        if (!std::isfinite(value)) return refuse(node, "is " + number_text(value) + "; it must be finite");
        if (!allowed_.limits.admits(value)) return out_of_range(node, number_text(value), value);
        return value;
    }

    // ---- lists

    template <class Item>
    Value list_of(const toml::node& node, ItemReader item_of) {
        const toml::array* array = node.as_array();
        if (array == nullptr)
            return wrong_type(node, allowed_.takes_all ? "a list in [ ] or \"all\"" : "a list in [ ]");
        std::vector<Item> items;
        bool good = true;
        for (const toml::node& element : *array) {
            const Value item = (this->*item_of)(element);
            good = good && item.has_value();
            if (!item) continue;
            const Item& value = std::get<Item>(*item);
            if (std::find(items.begin(), items.end(), value) != items.end()) {
                good = false;
                problem(element, fmt::format("{} is given twice; remove one", value));
            }
            items.push_back(value);
        }
        if (!good) return std::nullopt;
        return items;
    }

    Value numbers_of(const toml::node& node) {
        const toml::array* array = node.as_array();
        if (array == nullptr) return wrong_type(node, "a list in [ ]");
        if (array->empty() && !allowed_.may_be_empty)
            return refuse(node, "is empty; give it at least one number");
        std::vector<double> values;
        bool good = true;
        for (const toml::node& element : *array) {
            const Value value = number_of(element);
            good = good && value.has_value();
            if (value) values.push_back(std::get<double>(*value));
        }
        if (!good) return std::nullopt;
        return values;
    }

    Value sets_of(const toml::node& node) {
        const toml::array* array = node.as_array();
        if (array == nullptr) return wrong_type(node, "a list of lists, as [[1, 6, 11]]");
        std::vector<std::vector<std::int64_t>> sets;
        bool good = true;
        for (const toml::node& element : *array) {
            if (!element.is_array()) {
                problem(element, "holds " + std::string(type_words(element)) +
                                     ", but each layout is a list of its own, as [[1, 6, 11], [3, 9]]");
                good = false;
                continue;
            }
            if (element.as_array()->empty()) {
                problem(element, "holds a layout without a sensor; name its nodes or remove it");
                good = false;
                continue;
            }
            const Value nodes = list_of<std::int64_t>(element, &ValueReading::integer_of);
            good = good && nodes.has_value();
            if (nodes) sets.push_back(std::get<std::vector<std::int64_t>>(*nodes));
        }
        if (!good) return std::nullopt;
        return sets;
    }

    // ---- problems

    void problem(const toml::node& node, std::string message) {
        problems_.push_back({line_of(node), 0, path_, std::move(message)});
    }

    Value refuse(const toml::node& node, std::string message) {
        problem(node, std::move(message));
        return std::nullopt;
    }

    Value wrong_type(const toml::node& node, std::string_view wanted) {
        return refuse(node, fmt::format("is {}, but must be {}", type_words(node), wanted));
    }

    Value out_of_range(const toml::node& node, const std::string& text, double value) {
        const std::string unit = allowed_.unit.empty() ? "" : " " + allowed_.unit;
        const Limits& limits = allowed_.limits;
        const std::string words =
            value > limits.high ? "at most " + number_text(limits.high) : limits.words();
        return refuse(node, fmt::format("is {}{}, but must be {}", text, unit, words));
    }

    const AllowedValues& allowed_;
    const std::string& path_;
    std::vector<ConfigProblem> problems_;
};

}  // namespace

ReadValue value_of(const toml::node& node, const AllowedValues& allowed, const std::string& path) {
    return ValueReading(allowed, path).run(node);
}

}  // namespace capstan::config
