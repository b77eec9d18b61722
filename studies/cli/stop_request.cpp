#include "capstan/cli/stop_request.h"

#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX's own names are in no <csignal>

namespace capstan::cli {

namespace {

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // a signal handler may set it

void ask_to_stop(int) {
    stop_asked.store(true);
}

void handle(void (*handler)(int), int flags) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = flags;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

StopRequest::StopRequest() {
    stop_asked.store(false);
    handle(ask_to_stop, static_cast<int>(SA_RESETHAND | SA_RESTART));
}

StopRequest::~StopRequest() {
    handle(SIG_DFL, 0);
}

const std::atomic<bool>* StopRequest::flag() {
    return &stop_asked;
}

}  // namespace capstan::cli
