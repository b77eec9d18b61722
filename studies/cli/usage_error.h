#pragma once

#include <stdexcept>

namespace capstan::cli {

/// A command line, a configuration or a query that cannot be followed; says what to try.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace capstan::cli
