#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "capstan/bench/bench_plan.h"
#include "capstan/config/config_problem.h"
#include "capstan/plan/study_plan.h"

namespace capstan::config {

/// What a key can hold; nothing where the key is left out.
using ConfigValue =
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::int64_t>,
                 std::vector<double>, std::vector<std::string>, std::vector<std::vector<std::int64_t>>>;

enum class ValueKind {
    string,
    integer,
    number,
    boolean,
    choice,     ///< one of `names`
    integers,   ///< a list
    numbers,    ///< a list; the same number may come twice
    names,      ///< a list of some of `names`
    node_sets,  ///< a list of lists of nodes
};

/// Range of a number, or of every number in a list.
struct Limits {
    double low = -std::numeric_limits<double>::infinity();
    bool low_is_allowed = true;
    double high = std::numeric_limits<double>::infinity();

    bool admits(double value) const { return (low_is_allowed ? value >= low : value > low) && value <= high; }
    std::string words() const;  ///< "above 0", "1 to 200", empty without limits
};

/// The values that a key takes.
struct AllowedValues {
    ValueKind kind = ValueKind::string;
    std::string unit{};
    Limits limits{};
    std::vector<std::string> names{};
    bool takes_all = false;     ///< the text "all" stands for the complete list
    bool may_be_empty = false;  ///< of numbers; other lists may
};

/// When a key has a meaning, for keys that depend on another one.
template <class Plan>
struct KeyCondition {
    std::function<bool(const Plan&, int row)> holds;  ///< empty: always
    std::string words;                                ///< kind = "spring"
};

enum class Presence { optional, required };

/// One key of a configuration: all that reading, checking, writing and explaining it need.
template <class Plan>
struct ConfigKey {
    std::string section;  ///< "" at the top, else as in [section]
    std::string name;     ///< ends in its unit
    AllowedValues allowed{};
    Presence presence = Presence::optional;
    ConfigValue default_value{};
    std::string help{};
    KeyCondition<Plan> condition{};
    /// `row` counts the tables of a repeated section from 0, and is 0 elsewhere.
    std::function<ConfigValue(const Plan&, int row)> read{};
    std::function<void(Plan&, int row, const ConfigValue&)> write{};
};

/// One table of the configuration, or a list of tables.
template <class Plan>
struct ConfigSection {
    std::string path;
    std::string help;
    /// Repeated sections only: [[path]].
    int (*rows)(const Plan&) = nullptr;
    void (*set_rows)(Plan&, int count) = nullptr;
    void (*fill_default)(Plan&) = nullptr;
    /// Called where the section stands in the file.
    void (*note_present)(Plan&) = nullptr;
    /// False where the plan has no use for the section; it is then not written out. Empty: always.
    bool (*is_used)(const Plan&) = nullptr;

    bool is_repeated() const { return rows != nullptr; }
};

/// A kind of configuration.
template <class Plan>
struct ConfigSchema {
    std::string introduction;                   ///< the comment that a printed default begins with
    std::vector<ConfigSection<Plan>> sections;  ///< in the order of reading and writing
    std::vector<ConfigKey<Plan>> keys;          ///< a key may rely on all keys before it
    /// Called after the last key, for what follows from several sections: what is wrong with them. Files that
    /// keys name lie in `folder`; without one they may name none. Empty: nothing follows.
    std::vector<KeyProblem> (*complete)(Plan&, const KeyLines&,
                                        const std::optional<std::filesystem::path>& folder) = nullptr;
};

/// The one list of sections and keys of each kind of configuration.
template <class Plan>
const ConfigSchema<Plan>& config_schema();
template <>
const ConfigSchema<StudyPlan>& config_schema<StudyPlan>();
template <>
const ConfigSchema<bench::BenchPlan>& config_schema<bench::BenchPlan>();

}  // namespace capstan::config
