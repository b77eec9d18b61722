#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace capstan::config {

/// The text as tables, lists and values. Throws toml::parse_error, which names `file`.
toml::table parsed(std::string_view toml, const std::string& file);

/// What a message says of a node: its line, from 1, and its type, "a list".
int line_of(const toml::node& node);
std::string_view type_words(const toml::node& node);

}  // namespace capstan::config
