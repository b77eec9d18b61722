#pragma once

#include <array>
#include <atomic>
#include <csignal>

namespace capstan {

/// Signals that ask a program to end, or would end it: those that a person, a batch system or a limit sends.
/// SIGPIPE and SIGINT have their own customs outside of a study.
inline constexpr std::array ending_signals{SIGHUP,  SIGQUIT, SIGALRM, SIGTERM,  SIGUSR1,
                                           SIGUSR2, SIGXCPU, SIGPROF, SIGVTALRM};

/// From now on a signal of these ends the program as before, but not silently: it says which signal it was
/// and that no answer was written. What is ignored already (nohup) stays ignored.
void say_what_ends_the_program();

/// While it lives, the first Ctrl-C, request to terminate, limit on processor time or other signal that would
/// end the program only sets a flag; a second one ends the program at once, which loses no more than the unit
/// under way.
class StopRequest {
  public:
    StopRequest();
    ~StopRequest();
    StopRequest(const StopRequest&) = delete;
    StopRequest& operator=(const StopRequest&) = delete;

    static const std::atomic<bool>* flag();
};

}  // namespace capstan
