#pragma once
// For libraries that are loaded before the program (LD_PRELOAD): runs its main() again and again, each time
// in a process that is forked just before it. So a fault costs neither the start of a program nor the loading
// of its libraries, and still meets a program that has done nothing yet.
//   CAPSTAN_FAULT_SERVER  set: main() runs once for every line of standard input, which says what is to fail;
//                         standard output has a line for each, the status as wait() gives it. The program's
//                         own messages go to files in the current folder, `out` and `err`.
//   CAPSTAN_FAULT_AT      where that is not set: what is to fail in the one run
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace faults {

using Main = int(int, char**, char**);

// Of the library that includes this: told what is to fail, just before main(), and that main() has returned.
void begin(const char* line);
void end();

inline Main* real_main = nullptr;
constexpr unsigned longest_run_s = 300;

inline void redirect(const char* path, int to) {
    const int file = ::open(path, O_RDWR | O_CREAT | O_TRUNC, 0644);
    if (file < 0 || ::dup2(file, to) < 0) std::abort();
    ::close(file);
}

inline int one_main(int count, char** words, char** environment, const char* line) {
    begin(line);
    const int code = real_main(count, words, environment);
    end();
    return code;
}

// Does not use the C library's streams, because the forked process would inherit a partly read buffer.
// Returns false at the end of the input.
inline bool read_line(char* line, std::size_t size) {
    std::size_t length = 0;
    while (length + 1 < size && ::read(STDIN_FILENO, line + length, 1) == 1) {
        if (line[length] == '\n') {
            line[length] = '\0';
            return true;
        }
        ++length;
    }
    return false;
}

inline int many_mains(int count, char** words, char** environment) {
    if (std::getenv("CAPSTAN_FAULT_SERVER") == nullptr) {
        const char* at = std::getenv("CAPSTAN_FAULT_AT");
        return one_main(count, words, environment, at != nullptr ? at : "0");
    }
    char line[128];
    while (read_line(line, sizeof line)) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::alarm(longest_run_s);
            redirect("/dev/null", STDIN_FILENO);
            redirect("out", STDOUT_FILENO);
            redirect("err", STDERR_FILENO);
            return one_main(count, words, environment, line);
        }
        int status = -1;
        if (child < 0 || ::waitpid(child, &status, 0) < 0) ::_exit(1);
        char answer[32];
        const int length = std::snprintf(answer, sizeof answer, "%d\n", status);
        if (::write(STDOUT_FILENO, answer, static_cast<std::size_t>(length)) < 0) ::_exit(1);
    }
    ::_exit(0);
}

// A file that tells how many requests there were, of those that may fail.
inline void say_count(long requests) {
    const char* path = std::getenv("CAPSTAN_FAULT_COUNT");
    if (path == nullptr) return;
    char text[32];
    const int length = std::snprintf(text, sizeof text, "%ld\n", requests);
    const int file = ::open(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file < 0) return;
    if (::write(file, text, static_cast<std::size_t>(length)) < 0) std::perror(path);
    ::close(file);
}

}  // namespace faults

extern "C" int __libc_start_main(faults::Main* main, int count, char** words, void (*init)(), void (*fini)(),
                                 void (*rtld_fini)(), void* stack_end) {
    using Start = int(faults::Main*, int, char**, void (*)(), void (*)(), void (*)(), void*);
    auto* const start = reinterpret_cast<Start*>(dlsym(RTLD_NEXT, "__libc_start_main"));
    faults::real_main = main;
    return start(faults::many_mains, count, words, init, fini, rtld_fini, stack_end);
}
