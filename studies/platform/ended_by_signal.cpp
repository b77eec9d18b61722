#include "capstan/platform/ended_by_signal.h"

#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX's own names are in no <csignal>
#include <unistd.h>

#include <cstring>
#include <utility>
#include <vector>

namespace capstan {

namespace {

const char* words_of(int number) {
    switch (number) {
        case SIGHUP:
            return "capstan: ended by SIGHUP, the terminal was closed; no answer was written\n";
        case SIGQUIT:
            return "capstan: ended by SIGQUIT; no answer was written\n";
        case SIGALRM:
            return "capstan: ended by SIGALRM, an alarm; no answer was written\n";
        case SIGTERM:
            return "capstan: ended by SIGTERM, a request to end; no answer was written\n";
        case SIGUSR1:
            return "capstan: ended by SIGUSR1; no answer was written\n";
        case SIGUSR2:
            return "capstan: ended by SIGUSR2; no answer was written\n";
        case SIGXCPU:
            return "capstan: ended by SIGXCPU, the limit on processor time (ulimit -t); no answer was written\n";
        case SIGPROF:
            return "capstan: ended by SIGPROF, a timer; no answer was written\n";
        case SIGVTALRM:
            return "capstan: ended by SIGVTALRM, a timer; no answer was written\n";
        default:
            return "capstan: ended by a signal; no answer was written\n";
    }
}

// Only what a signal handler may do. The handler is gone when it runs, so that the signal then ends the
// program.
void say_and_end(int number) {
    const char* const words = words_of(number);
    if (::write(STDERR_FILENO, words, std::strlen(words)) < 0) {
        // Nobody listens; the exit code tells it.
    }
    ::raise(number);
}

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // a signal handler may set it

void ask_to_stop(int) {
    stop_asked.store(true);
}

// What a signal did before; of those that end the program, and of these two.
std::vector<std::pair<int, struct sigaction>> handlers_before;

void take_over(int number) {
    struct sigaction before {};
    ::sigaction(number, nullptr, &before);
    if (before.sa_handler == SIG_IGN) return;  // as nohup has it
    struct sigaction action {};
    action.sa_handler = ask_to_stop;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    ::sigemptyset(&action.sa_mask);
    ::sigaction(number, &action, nullptr);
    handlers_before.emplace_back(number, before);
}

}  // namespace

void say_what_ends_the_program() {
    for (const int number : ending_signals) {
        struct sigaction before {};
        ::sigaction(number, nullptr, &before);
        if (before.sa_handler != SIG_DFL) continue;
        struct sigaction action {};
        action.sa_handler = say_and_end;
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        ::sigemptyset(&action.sa_mask);
        ::sigaction(number, &action, nullptr);
    }
}

StopRequest::StopRequest() {
    stop_asked.store(false);
    for (const int number : ending_signals) take_over(number);
    for (const int number : {SIGINT, SIGPIPE}) take_over(number);
}

StopRequest::~StopRequest() {
    for (const auto& [number, before] : handlers_before) ::sigaction(number, &before, nullptr);
    handlers_before.clear();
}

const std::atomic<bool>* StopRequest::flag() {
    return &stop_asked;
}

}  // namespace capstan
