#include "capstan/platform/standard_streams.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): <csignal> lacks the names of POSIX
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <string>

namespace capstan {

namespace {

// Marks of Unicode after which a terminal shows letters from right to left: U+202A to U+202E, U+2066 to
// U+2069.
bool turns_the_line(std::string_view mark) {
    return (mark >= "\xe2\x80\xaa" && mark <= "\xe2\x80\xae") ||
           (mark >= "\xe2\x81\xa6" && mark <= "\xe2\x81\xa9");
}

}  // namespace

std::string printable(std::string_view text) {
    std::string shown;
    shown.reserve(text.size());
    const auto escape = [&shown](unsigned char byte) {
        constexpr char digits[] = "0123456789abcdef";
        shown += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
    };
    for (std::size_t k = 0; k < text.size(); ++k) {
        const auto byte = static_cast<unsigned char>(text[k]);
        const auto next = static_cast<unsigned char>(k + 1 < text.size() ? text[k + 1] : '\0');
        if ((byte < 32 && byte != '\n' && byte != '\t') || byte == 127) {
            escape(byte);
        } else if (byte == 0xc2 && next >= 0x80 && next < 0xa0) {  // U+0080 to U+009F in UTF-8
            escape(next);
            ++k;
        } else if (turns_the_line(text.substr(k, 3))) {
            for (const char each : text.substr(k, 3)) escape(static_cast<unsigned char>(each));
            k += 2;
        } else {
            shown += text[k];
        }
    }
    return shown;
}

bool write_all(int descriptor, std::string_view text) noexcept {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written == 0) errno = EIO;
        if (written <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

// A reader that has gone raises SIGPIPE, which would end the program: the signal is held back and taken away.
void write_standard_error(std::string_view text) noexcept {
    sigset_t pipe_signal, before, pending;
    ::sigemptyset(&pipe_signal);
    ::sigaddset(&pipe_signal, SIGPIPE);
    ::sigpending(&pending);
    const bool was_pending = ::sigismember(&pending, SIGPIPE) == 1;
    ::pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
    if (!write_all(STDERR_FILENO, text) && errno == EPIPE && !was_pending) {
        const timespec at_once = {};
        while (::sigtimedwait(&pipe_signal, nullptr, &at_once) < 0 && errno == EINTR) {
        }
    }
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void say(std::string_view message) noexcept {
    try {
        const std::string shown = printable(message);
        write_standard_error(
            message.ends_with('\n') ? shown : shown + '\n');  // one write: lines of two processes do not mix
    } catch (...) {
        write_standard_error(message);
        write_standard_error("\n");
    }
}

void write_standard_output(std::string_view text) {
    std::fflush(stdout);
    if (::isatty(STDOUT_FILENO) == 1 ? write_all(STDOUT_FILENO, printable(text))
                                     : write_all(STDOUT_FILENO, text))
        return;
    const std::string reason = errno == ENOSPC
                                   ? "the disk is full; free some space, or send the answer to another disk"
                                   : std::strerror(errno);
    throw std::runtime_error("cannot write to standard output: " + reason);
}

void reserve_standard_streams() noexcept {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
        // For reading only: what is written to a closed standard output must still be refused.
        if (::fcntl(stream, F_GETFD) == -1 && ::open("/dev/null", O_RDONLY) != stream) return;
    }
}

bool standard_error_is_terminal() noexcept {
    return ::isatty(STDERR_FILENO) == 1;
}

}  // namespace capstan
