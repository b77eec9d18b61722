#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "capstan/cli/command.h"
#include "capstan/platform/files.h"
#include "capstan/platform/standard_streams.h"

namespace capstan::cli {

/// Writes the answer where --output says.
void deliver(const Invocation& invocation, std::string_view text);

/// Writes the page where --html says, if it does, and says so on standard error. `page` makes its text.
void deliver_page(const Invocation& invocation, const std::function<std::string()>& page);

}  // namespace capstan::cli
