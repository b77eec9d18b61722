#pragma once
// How rows of a key table are written: a maker for each kind of value, bound to a field of the plan.

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "capstan/config/config_key.h"

namespace capstan::config {

inline constexpr Limits above_zero{0.0, false};
inline constexpr Limits zero_or_more{0.0, true};

// A key that is a field of the plan; `field(plan, row)` refers to it.
template <class Stored, class Plan, class Field>
void bind_field(ConfigKey<Plan>& key, Field field) {
    key.read = [field](const Plan& plan, int row) -> ConfigValue {
        return static_cast<Stored>(field(plan, row));
    };
    key.write = [field](Plan& plan, int row, const ConfigValue& value) {
        auto& target = field(plan, row);
        target = static_cast<std::remove_reference_t<decltype(target)>>(std::get<Stored>(value));
    };
}

struct KeyText {
    std::string section;
    std::string name;
    std::string unit;
    std::string help;
};

// A key with everything but how it is read and written.
template <class Plan>
ConfigKey<Plan> unbound_key(KeyText about, ValueKind kind, Limits limits, ConfigValue default_value) {
    ConfigKey<Plan> key{about.section, about.name, {kind, about.unit, limits}};
    key.help = std::move(about.help);
    key.default_value = std::move(default_value);
    return key;
}

template <class Stored, class Plan, class Field>
ConfigKey<Plan> field_key(KeyText about, ValueKind kind, Limits limits, ConfigValue default_value,
                          Field field) {
    auto key = unbound_key<Plan>(std::move(about), kind, limits, std::move(default_value));
    bind_field<Stored>(key, field);
    return key;
}

template <class Plan = StudyPlan, class Field>
ConfigKey<Plan> string(KeyText about, ConfigValue default_value, Field field) {
    return field_key<std::string, Plan>(std::move(about), ValueKind::string, {}, std::move(default_value),
                                        field);
}

template <class Plan = StudyPlan, class Field>
ConfigKey<Plan> integer(KeyText about, Limits limits, ConfigValue default_value, Field field) {
    return field_key<std::int64_t, Plan>(std::move(about), ValueKind::integer, limits,
                                         std::move(default_value), field);
}

template <class Plan = StudyPlan, class Field>
ConfigKey<Plan> number(KeyText about, Limits limits, ConfigValue default_value, Field field) {
    return field_key<double, Plan>(std::move(about), ValueKind::number, limits, std::move(default_value),
                                   field);
}

template <class Plan = StudyPlan, class Field>
ConfigKey<Plan> boolean(KeyText about, bool default_value, Field field) {
    return field_key<bool, Plan>(std::move(about), ValueKind::boolean, {}, default_value, field);
}

template <class Plan, class Field>
ConfigKey<Plan> number_list(KeyText about, Limits limits, std::vector<double> default_value, Field field) {
    return field_key<std::vector<double>, Plan>(std::move(about), ValueKind::numbers, limits,
                                                std::move(default_value), field);
}

template <class Value>
struct Named {
    std::string name;
    Value value;
};

template <class Value, class Plan = StudyPlan, class Field, class Same = std::equal_to<>>
ConfigKey<Plan> choice(KeyText about, std::vector<Named<Value>> all, ConfigValue default_value, Field field,
                       Same same = {}) {
    auto key = unbound_key<Plan>(std::move(about), ValueKind::choice, {}, std::move(default_value));
    for (const auto& each : all) key.allowed.names.push_back(each.name);
    key.read = [all, field, same](const Plan& plan, int row) -> ConfigValue {
        const auto found = std::find_if(all.begin(), all.end(),
                                        [&](const auto& each) { return same(each.value, field(plan, row)); });
        assert(found != all.end());  // every value of the plan has a name
        return found->name;
    };
    key.write = [all, field](Plan& plan, int row, const ConfigValue& value) {
        const auto found = std::find_if(all.begin(), all.end(), [&](const auto& each) {
            return each.name == std::get<std::string>(value);
        });
        assert(found != all.end());  // the reader accepted the name
        field(plan, row) = found->value;
    };
    return key;
}

template <class Plan>
ConfigKey<Plan> required(ConfigKey<Plan> key) {
    key.presence = Presence::required;
    key.default_value = std::monostate{};
    return key;
}

}  // namespace capstan::config
