#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "capstan/config/config_problem.h"

namespace capstan::config {

/// The text as tables, lists and values. Throws toml::parse_error, which names `file`.
toml::table parsed(std::string_view toml, const std::string& file);

/// What a message says of a node: its line, from 1, and its type, "a list".
int line_of(const toml::node& node);
std::string_view type_words(const toml::node& node);

/// The keys of a section's table that the schema of that kind of plan does not know there, each with what it
/// was probably meant to be. `path` is the section's, with the number of its row: "regime[2]".
template <class Plan>
std::vector<ConfigProblem> unknown_keys(const toml::table& table, std::string_view section,
                                        const std::string& path);

}  // namespace capstan::config
