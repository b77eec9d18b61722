#pragma once

#include "capstan/http/server.h"
#include "capstan/service/guess_log.h"
#include "capstan/service/request_guard.h"
#include "capstan/service/session.h"

namespace capstan::service {

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
