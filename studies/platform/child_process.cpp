#include "capstan/platform/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): <csignal> lacks the names of POSIX
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace capstan {

namespace {

struct Pipe {
    int read_end = -1;
    int write_end = -1;

    Pipe() {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0)
            throw std::runtime_error(std::string("cannot start another program: ") + std::strerror(errno));
        read_end = ends[0];
        write_end = ends[1];
    }
    ~Pipe() {
        if (read_end >= 0) ::close(read_end);
        if (write_end >= 0) ::close(write_end);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    void close_write_end() { ::close(std::exchange(write_end, -1)); }
};

void set_limits(const ChildLimits& limits) {
    if (limits.nice_increment != 0 && ::nice(limits.nice_increment) == -1) errno = 0;
    const rlimit memory{limits.memory_bytes, limits.memory_bytes};
    if (limits.memory_bytes != 0) ::setrlimit(RLIMIT_AS, &memory);
    // First the signal for too much processor time, a second later the end.
    const auto seconds = static_cast<rlim_t>(limits.processor_s);
    const rlimit processor{seconds, seconds + 1};
    if (seconds != 0) ::setrlimit(RLIMIT_CPU, &processor);
    if (limits.memory_bytes != 0 || seconds != 0) {
        const rlimit none{0, 0};
        ::setrlimit(RLIMIT_CORE, &none);
    }
}

// Between fork and exec only calls that are safe in a program of many threads. A failure goes through
// `failure`, which a successful exec closes.
[[noreturn]] void exec(char* const* words, int output, int messages, int failure, const ChildLimits& limits,
                       pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    ::dup2(::open("/dev/null", O_RDWR | O_CLOEXEC), STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(messages, STDERR_FILENO);
    set_limits(limits);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::execvp(words[0], words);
    const int error = errno;
    if (::write(failure, &error, sizeof error) < 0) ::_exit(126);
    ::_exit(127);
}

// Hands over the complete lines of `text` and keeps the rest.
void hand_over_lines(std::string& text, const std::function<void(const std::string&)>& on_line) {
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
        on_line(text.substr(begin, end - begin));
    text.erase(0, begin);
}

int exit_code_of(pid_t pid) {
    int status = 0;
    while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command_line, const ChildLimits& limits) {
    std::vector<char*> words;
    for (const std::string& word : command_line) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    Pipe output, messages, failure;
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ == 0)
        exec(words.data(), output.write_end, messages.write_end, failure.write_end, limits, parent);
    int error = pid_ < 0 ? errno : 0;
    if (pid_ > 0) {
        failure.close_write_end();
        while (::read(failure.read_end, &error, sizeof error) < 0 && errno == EINTR) {
        }
        if (error != 0) exit_code_of(pid_);
    }
    if (error != 0) throw std::runtime_error("cannot start " + command_line[0] + ": " + std::strerror(error));
    output_ = std::exchange(output.read_end, -1);
    messages_ = std::exchange(messages.read_end, -1);
}

ChildProcess::~ChildProcess() {
    if (!ended_) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    ::close(output_);
    ::close(messages_);
}

void ChildProcess::ask_to_stop() const {
    if (!ended_) ::kill(pid_, SIGTERM);
}

CommandOutput ChildProcess::wait(const std::function<void(const std::string& line)>& on_error_line,
                                 const Patience& patience) {
    CommandOutput result;
    const auto begun = std::chrono::steady_clock::now();
    const int pause_ms = patience.longest || patience.unwanted != nullptr ? 50 : -1;
    std::array<pollfd, 2> pipes{{{output_, POLLIN, 0}, {messages_, POLLIN, 0}}};
    const std::array<std::string*, 2> texts{&result.output, &result.messages};
    std::array<char, 65536> bytes;
    while (pipes[0].fd >= 0 || pipes[1].fd >= 0) {
        if (::poll(pipes.data(), pipes.size(), pause_ms) < 0 && errno != EINTR) break;
        result.is_late = (patience.longest && std::chrono::steady_clock::now() - begun > *patience.longest) ||
                         (patience.unwanted != nullptr && patience.unwanted->load());
        result.is_long = result.output.size() + result.messages.size() > patience.max_output_bytes;
        if (result.is_late || result.is_long) {
            ::kill(pid_, SIGKILL);
            break;
        }
        for (std::size_t k = 0; k < pipes.size(); ++k) {
            if (pipes[k].fd < 0 || pipes[k].revents == 0) continue;
            const ssize_t count = ::read(pipes[k].fd, bytes.data(), bytes.size());
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) {
                pipes[k].fd = -1;  // poll leaves it out
                continue;
            }
            texts[k]->append(bytes.data(), static_cast<std::size_t>(count));
            if (on_error_line) hand_over_lines(result.messages, on_error_line);
        }
    }
    if (on_error_line && !result.messages.empty()) on_error_line(std::exchange(result.messages, {}));
    result.exit_code = exit_code_of(pid_);
    ended_ = true;
    return result;
}

CommandOutput run_command(const std::vector<std::string>& command_line, const ChildLimits& limits,
                          const Patience& patience) {
    return ChildProcess(command_line, limits).wait({}, patience);
}

bool is_on_path(const std::string& program) {
    const char* const path = std::getenv("PATH");
    std::string rest = path == nullptr ? "" : path;
    while (!rest.empty()) {
        const std::string folder = rest.substr(0, rest.find(':'));
        rest.erase(0, folder.size() + 1);
        const auto file = std::filesystem::path(folder.empty() ? "." : folder) / program;
        if (::access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file)) return true;
    }
    return false;
}

}  // namespace capstan
