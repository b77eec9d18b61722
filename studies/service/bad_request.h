#pragma once

#include <stdexcept>
#include <string>

namespace capstan::service {

/// A request that cannot be answered as asked; `status` is HTTP's.
class BadRequest : public std::runtime_error {
  public:
    explicit BadRequest(const std::string& message, int status = 400)
        : std::runtime_error(message), status_(status) {}
    int status() const { return status_; }

  private:
    int status_;
};

}  // namespace capstan::service
