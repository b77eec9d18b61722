#pragma once

#include <string>

#include "capstan/cli/command.h"

namespace capstan::cli {

/// Manual pages in roff (man macros), written from the table of commands: capstan(1), and one for each
/// command, capstan-study-run(1).
std::string program_man_page();
std::string man_page(const Command& command);
std::string man_page_name(const Command& command);  ///< 'capstan-study-run.1'

}  // namespace capstan::cli
