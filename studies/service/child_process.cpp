#include "capstan/service/child_process.h"

#include <fcntl.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX's own names are in no <csignal>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace capstan::service {

namespace {

constexpr int kinder = 5;  // a request is answered before a study goes on

// Between fork and exec only calls that are safe in a program of many threads.
[[noreturn]] void become(char* const* words, int messages, pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, STDIN_FILENO);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(messages, STDERR_FILENO);
    if (::nice(kinder) == -1) errno = 0;
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::execv(words[0], words);
    ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& words) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error(std::strerror(errno));
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ == 0) become(arguments.data(), ends[1], parent);
    ::close(ends[1]);
    messages_ = ends[0];
    if (pid_ < 0) {
        ::close(messages_);
        throw std::runtime_error(std::string("cannot start ") + words[0] + ": " + std::strerror(errno));
    }
}

ChildProcess::~ChildProcess() {
    if (!ended_) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    ::close(messages_);
}

void ChildProcess::ask_to_stop() const {
    if (!ended_) ::kill(pid_, SIGTERM);
}

int ChildProcess::wait(const std::function<void(const std::string& line)>& on_message) {
    std::string line;
    char bytes[4096];
    for (;;) {
        const ssize_t count = ::read(messages_, bytes, sizeof bytes);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        for (ssize_t k = 0; k < count; ++k) {
            if (bytes[k] != '\n') {
                line += bytes[k];
                continue;
            }
            on_message(line);
            line.clear();
        }
    }
    if (!line.empty()) on_message(line);
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    ended_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace capstan::service
