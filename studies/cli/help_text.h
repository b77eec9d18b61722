#pragma once

#include <string>

#include "capstan/cli/command.h"

namespace capstan::cli {

std::string where_to_begin();              ///< `capstan` alone
std::string program_help();                ///< `capstan --help`
std::string command_help(const Command&);  ///< `capstan COMMAND --help`
/// The commands that begin with a word, as `study`; empty if there is none.
std::string group_help(std::string_view group);

/// Completion scripts for shells, written from the table of commands.
std::string bash_completion();
std::string zsh_completion();

/// Manual pages in roff (man macros), written from the table of commands: capstan(1), and one for each
/// command, capstan-study-run(1).
std::string program_man_page();
std::string man_page(const Command& command);
std::string man_page_name(const Command& command);  ///< 'capstan-study-run.1'

}  // namespace capstan::cli
