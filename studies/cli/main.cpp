#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>

#include "capstan/cli/command.h"
#include "capstan/cli/program.h"
#include "capstan/platform/ended_by_signal.h"
#include "capstan/platform/standard_streams.h"

namespace {

// Where memory ends in a place that no handler reaches, as between two threads, there is still something to
// say.
[[noreturn]] void end_in_words() {
    try {
        if (const std::exception_ptr problem = std::current_exception()) std::rethrow_exception(problem);
    } catch (const std::bad_alloc&) {
        capstan::say("capstan: out of memory");
        std::_Exit(static_cast<int>(capstan::cli::ExitCode::failure));
    } catch (...) {
        std::abort();
    }
    std::abort();
}

}  // namespace

int main(int argument_count, char** arguments) {
    capstan::reserve_standard_streams();
    std::signal(SIGXFSZ,
                SIG_IGN);  // a write beyond the limit on file sizes fails, and is reported, like any other
    capstan::say_what_ends_the_program();
    std::set_terminate(end_in_words);
    return static_cast<int>(capstan::cli::run_program({arguments + 1, arguments + argument_count}));
}
