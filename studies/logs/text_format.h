#pragma once

#include <optional>
#include <string>

namespace capstan::logs {

/// How numbers are laid out in a text file.
struct TextFormat {
    std::optional<char> delimiter;        ///< ' ': any number of blanks or tabs
    std::optional<bool> decimal_comma;    ///< 3,14
    std::optional<int> head_line;         ///< with the columns' names, from 1; 0: there is none
    std::optional<std::string> comments;  ///< what a line to be left out begins with: "#", "%"
};

}  // namespace capstan::logs
