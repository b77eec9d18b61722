#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

namespace capstan::service {

/// Slows down who guesses tokens. The answers to wrong tokens of one address come half a second apart,
/// however many connections it has; when too many wait, its tokens are not looked at, be they right. Sessions
/// that have begun go on. For one thread.
class GuessLog {
  public:
    using Clock = std::chrono::steady_clock;

    /// Whether a token of this address may be looked at now.
    bool may_guess(const std::string& address, Clock::time_point now) const;

    /// After a wrong token: how long its answer is to wait.
    std::chrono::milliseconds wrong(const std::string& address, Clock::time_point now);

  private:
    std::map<std::string, Clock::time_point> next_;  // answer to a wrong token, by address
};

}  // namespace capstan::service
