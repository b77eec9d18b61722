#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "capstan/cli/usage_error.h"

namespace capstan::cli {

/// One thing wrong with a configuration.
struct ConfigProblem {
    int line = 0;         ///< from 1; 0: the file as a whole
    int column = 0;       ///< from 1; 0: the line as a whole
    std::string key;      ///< full path, "regime[2].samples"; empty: no key in particular
    std::string message;  ///< what is wrong; what to try
};

/// No problem is known of the key, or of any key of the section.
bool sound(const std::vector<ConfigProblem>& known, std::string_view path);

/// Every problem of a configuration, one a line: FILE:LINE: key: what is wrong; what to try.
class ConfigError : public UsageError {
  public:
    ConfigError(const std::string& file, std::vector<ConfigProblem> problems);

    const std::vector<ConfigProblem>& problems() const { return problems_; }

  private:
    std::vector<ConfigProblem> problems_;
};

}  // namespace capstan::cli
