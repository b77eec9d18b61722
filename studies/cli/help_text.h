#pragma once

#include <string>

#include "capstan/cli/command.h"

namespace capstan::cli {

std::string where_to_begin();              ///< `capstan` alone
std::string program_help();                ///< `capstan --help`
std::string command_help(const Command&);  ///< `capstan COMMAND --help`
/// The commands that begin with a word, as `study`; empty if there is none.
std::string group_help(std::string_view group);

}  // namespace capstan::cli
