#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <vector>

#include "capstan/config/config_key.h"
#include "capstan/config/config_problem.h"

namespace capstan::config {

/// What a node says: a value, or else at least one problem.
struct ReadValue {
    std::optional<ConfigValue> value;
    std::vector<ConfigProblem> problems;
};

/// The node as a value of its key, which stands at `path` and allows those values.
ReadValue value_of(const toml::node& node, const AllowedValues& allowed, const std::string& path);

}  // namespace capstan::config
