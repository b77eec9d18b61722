#pragma once

#include <string>
#include <vector>

namespace capstan::cluster {

/// A word for the shell that runs a script.
std::string quoted(const std::string& text);

/// sbatch parses its lines itself and replaces %a and similar patterns; %% stands for one %.
std::string quoted_for_sbatch(const std::string& text);

std::string without_line_end(std::string text);

/// A call as it can be typed: words with other characters than letters, digits and those of paths are quoted.
std::string as_typed(const std::vector<std::string>& words);

}  // namespace capstan::cluster
