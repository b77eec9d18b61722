#pragma once

#include <string>

#include "capstan/cli/command.h"

namespace capstan::cli {

std::string where_to_begin();              ///< `capstan` alone
std::string program_help();                ///< `capstan --help`
std::string command_help(const Command&);  ///< `capstan COMMAND --help`
/// The commands that begin with a word, as `study`; empty if there is none.
std::string group_help(std::string_view group);

/// What an option takes, such as N or csv|json; empty: a flag.
std::string value_of(const Option&);
/// Its meaning and its default.
std::string meaning_of(const Option&);
std::string meaning_of(const Argument&);

}  // namespace capstan::cli
