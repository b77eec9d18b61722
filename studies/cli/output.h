#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "capstan/cli/command.h"

namespace capstan::cli {

/// Writes to standard output and makes sure that it arrived. Throws std::runtime_error if it did not.
void write_standard_output(std::string_view text);

/// Writes a file whole or not at all: to a temporary name beside it, then renamed. Whatever had the name
/// before stays until then. Throws std::runtime_error that says what to try.
void write_file(const std::filesystem::path& path, std::string_view text);

/// Writes the answer where --output says.
void deliver(const Invocation& invocation, std::string_view text);

/// Writes the page where --html says, if it does, and says so on standard error. `page` makes its text.
void deliver_page(const Invocation& invocation, const std::function<std::string()>& page);

}  // namespace capstan::cli
