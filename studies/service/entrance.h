#pragma once

#include <chrono>
#include <map>
#include <string>

#include "capstan/http/server.h"
#include "capstan/service/request_guard.h"
#include "capstan/service/session.h"

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

/// Judges the head of every request: where it comes from, the token or session that it shows, and the body
/// that it announces. The front page takes the token from its address, once, and begins a session.
class Entrance {
  public:
    explicit Entrance(const Access& access) : access_(access), sessions_(access.token, access.port) {}

    http::Verdict judge(const http::Request& head);

  private:
    http::Verdict judge_token(const http::Request& head);
    http::Verdict refuse_guess(const http::Request& head);

    const Access& access_;
    Sessions sessions_;
    GuessLog guesses_;
};

}  // namespace capstan::service
