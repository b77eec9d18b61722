#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan::config {

/// One thing wrong with a configuration.
struct ConfigProblem {
    int line = 0;         ///< from 1; 0: no line in particular
    int column = 0;       ///< from 1; 0: no column in particular
    std::string key;      ///< full path, "regime[2].samples"; empty: no key in particular
    std::string message;  ///< what is wrong; what to try
};

/// Where keys stand in the text: "regime[2].samples" -> line, both from 1. Sections are in it too.
using KeyLines = std::map<std::string, int, std::less<>>;

/// The line of a key, or of the closest section around it that stands in the file; 0: none does.
int line_of_key(const KeyLines& lines, std::string key);

/// Every problem of a configuration, one a line: FILE:LINE: key: what is wrong; what to try.
class ConfigError : public InvalidInput {
  public:
    ConfigError(const std::string& file, std::vector<ConfigProblem> problems);

    const std::vector<ConfigProblem>& at_lines() const { return problems_; }

  private:
    std::vector<ConfigProblem> problems_;
};

}  // namespace capstan::config
