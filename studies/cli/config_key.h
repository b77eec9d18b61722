#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "capstan/placement/study_plan.h"

namespace capstan::cli {

/// What a key can hold; nothing where the key is left out.
using ConfigValue =
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::int64_t>,
                 std::vector<std::string>, std::vector<std::vector<std::int64_t>>>;

enum class ValueKind {
    text,
    whole_number,
    real_number,
    yes_or_no,
    choice,         ///< one of `names`
    whole_numbers,  ///< a list
    names,          ///< a list of some of `names`
    node_sets,      ///< a list of lists of nodes
};

/// Range of a number, or of every number in a list.
struct Limits {
    double low = -std::numeric_limits<double>::infinity();
    bool low_is_allowed = true;
    double high = std::numeric_limits<double>::infinity();

    bool admits(double value) const { return (low_is_allowed ? value >= low : value > low) && value <= high; }
    std::string words() const;  ///< "above 0", "1 to 200", empty without limits
};

/// When a key has a meaning, for keys that depend on another one.
struct KeyCondition {
    std::function<bool(const StudyPlan&, int row)> holds;  ///< empty: always
    std::string words;                                     ///< kind = "spring"
};

enum class Presence { optional, required };

/// One key of a study's configuration: all that reading, checking, writing and explaining it need.
struct ConfigKey {
    std::string_view section;  ///< "" at the top, else as in [section]
    std::string_view name;     ///< ends in its unit
    ValueKind kind = ValueKind::text;
    std::string_view unit;
    Limits limits{};
    std::vector<std::string> names{};
    bool takes_all = false;  ///< the text "all" stands for the whole list
    Presence presence = Presence::optional;
    ConfigValue default_value{};
    std::string help{};
    KeyCondition condition{};
    /// `row` counts the tables of a repeated section from 0, and is 0 elsewhere.
    std::function<ConfigValue(const StudyPlan&, int row)> read{};
    std::function<void(StudyPlan&, int row, const ConfigValue&)> write{};
};

/// One table of the configuration, or a list of tables.
struct ConfigSection {
    std::string_view path;
    std::string_view help;
    /// Repeated sections only: [[path]].
    int (*rows)(const StudyPlan&) = nullptr;
    void (*set_rows)(StudyPlan&, int count) = nullptr;
    void (*fill_default)(StudyPlan&) = nullptr;

    bool is_repeated() const { return rows != nullptr; }
};

/// The one list of sections, in the order of reading and writing.
const std::vector<ConfigSection>& config_sections();

/// The one list of keys. A key may rely on all keys before it.
const std::vector<ConfigKey>& config_keys();

}  // namespace capstan::cli
