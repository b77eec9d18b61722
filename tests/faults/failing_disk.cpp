#include "failing_disk.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <string>

namespace capstan::faults {

namespace {

namespace fs = std::filesystem;

Planned planned;
std::string root, durable;
std::atomic<long> count{0};
std::atomic<bool> is_armed{false};

std::string path_of(int file) {
    char path[PATH_MAX];
    const std::string link = "/proc/self/fd/" + std::to_string(file);
    const ssize_t length = ::readlink(link.c_str(), path, sizeof path);
    return length > 0 ? std::string(path, static_cast<std::size_t>(length)) : "";
}

// The copy of a file that lies below the root; empty for any other.
std::string copy_of(const std::string& path) {
    if (!is_armed || !path.starts_with(root + "/") || path.ends_with("-shm") || path.ends_with("(deleted)"))
        return "";
    std::string name = path.substr(root.size() + 1);
    for (char& letter : name) letter = letter == '/' ? '\\' : letter;
    return durable + "/" + name;
}

// Plain system calls: what the copy does is not counted.
void keep(const std::string& path) {
    const std::string copy = copy_of(path);
    if (copy.empty()) return;
    const int from = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const int to = ::open(copy.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    char bytes[65536];
    for (ssize_t size = 0; from >= 0 && to >= 0 && (size = ::read(from, bytes, sizeof bytes)) > 0;)
        if (::syscall(SYS_write, to, bytes, size) != size) ::_exit(1);
    ::close(from);
    ::close(to);
}

bool is_file_here(int file) {
    if (!is_armed) return false;
    const std::string path = path_of(file);
    return path.starts_with(root + "/") && !path.ends_with("-shm");
}

// Before an operation. 0: it goes on; -1: it fails; 1: half of it.
int meets_fault() {
    const long number = ++count;
    if (planned.fault == Fault::full && number >= planned.at) {
        errno = ENOSPC;
        return -1;
    }
    if (number != planned.at) return 0;
    switch (planned.fault) {
        case Fault::none:
        case Fault::full:
        case Fault::kill_after:
            return 0;
        case Fault::error:
            errno = EIO;
            return -1;
        case Fault::torn:
            return 1;
        case Fault::kill:
            ::_exit(killed_code);
        case Fault::stop:
            ::raise(SIGSTOP);
            return 0;
    }
    return 0;
}

void after() {
    if (planned.fault == Fault::kill_after && count == planned.at) ::_exit(killed_code);
}

}  // namespace

void arm(const Planned& wanted, const fs::path& of, const fs::path& copies) {
    planned = wanted;
    root = of.string();
    durable = copies.string();
    count = 0;
    is_armed = true;
}

long operations() {
    return count;
}

}  // namespace capstan::faults

// The C library's own names, by system calls.
using namespace capstan::faults;

extern "C" {

ssize_t write(int file, const void* bytes, size_t size) {
    if (!is_file_here(file)) return ::syscall(SYS_write, file, bytes, size);
    const int fault = meets_fault();
    if (fault < 0) return -1;
    const ssize_t done = ::syscall(SYS_write, file, bytes, fault == 1 ? size / 2 : size);
    if (fault == 1) ::_exit(killed_code);
    after();
    return done;
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t offset) {
    if (!is_file_here(file)) return ::syscall(SYS_pwrite64, file, bytes, size, offset);
    const int fault = meets_fault();
    if (fault < 0) return -1;
    const ssize_t done = ::syscall(SYS_pwrite64, file, bytes, fault == 1 ? size / 2 : size, offset);
    if (fault == 1) ::_exit(killed_code);
    after();
    return done;
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t offset) {
    return pwrite64(file, bytes, size, offset);
}

int fsync(int file) {
    if (is_file_here(file)) {
        if (meets_fault() != 0) return -1;
        keep(path_of(file));
        after();
    }
    return static_cast<int>(::syscall(SYS_fsync, file));
}
int fdatasync(int file) {
    return fsync(file);
}

int ftruncate64(int file, off64_t size) {
    if (is_file_here(file)) {
        if (meets_fault() != 0) return -1;
    }
    const int done = static_cast<int>(::syscall(SYS_ftruncate, file, size));
    if (is_file_here(file)) after();
    return done;
}
int ftruncate(int file, off_t size) {
    return ftruncate64(file, size);
}

// Names are durable at once, and what they name is what was synced.
int rename(const char* from, const char* to) noexcept {
    if (!copy_of(to).empty() && meets_fault() != 0) return -1;
    const int done = static_cast<int>(::syscall(SYS_rename, from, to));
    if (done == 0 && !copy_of(to).empty() &&
        ::syscall(SYS_rename, copy_of(from).c_str(), copy_of(to).c_str()) != 0)
        keep(to);
    if (!copy_of(to).empty()) after();
    return done;
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
    if (!copy_of(to).empty() && meets_fault() != 0) return -1;
    const int done = static_cast<int>(::syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
    if (done == 0) keep(to);  // its writer has synced it
    if (!copy_of(to).empty()) after();
    return done;
}
int link(const char* from, const char* to) noexcept {
    return linkat(AT_FDCWD, from, AT_FDCWD, to, 0);
}

int unlink(const char* path) noexcept {
    const std::string copy = copy_of(path);
    if (!copy.empty() && meets_fault() != 0) return -1;
    const int done = static_cast<int>(::syscall(SYS_unlink, path));
    if (!copy.empty()) {
        ::syscall(SYS_unlink, copy.c_str());
        after();
    }
    return done;
}

int remove(const char* path) noexcept {
    if (unlink(path) == 0) return 0;
    return errno == EISDIR ? static_cast<int>(::syscall(SYS_rmdir, path)) : -1;
}

// The thread of the work is the first one; the others keep watch, and would only make the simulation long.
int clock_nanosleep(clockid_t clock, int flags, const timespec* wanted, timespec* left) {
    if (!is_armed) return static_cast<int>(-::syscall(SYS_clock_nanosleep, clock, flags, wanted, left));
    if (::getpid() == ::gettid() && planned.stops_in_pauses) {
        ::raise(SIGSTOP);
        return 0;
    }
    const timespec shorter{0, 500'000};
    ::syscall(SYS_clock_nanosleep, CLOCK_MONOTONIC, 0, &shorter, nullptr);
    return 0;
}
int nanosleep(const timespec* wanted, timespec* left) {
    return clock_nanosleep(CLOCK_MONOTONIC, 0, wanted, left) == 0 ? 0 : -1;
}
int usleep(useconds_t microseconds) {
    const timespec wanted{microseconds / 1'000'000, static_cast<long>(microseconds % 1'000'000) * 1000};
    return nanosleep(&wanted, nullptr);
}

}  // extern "C"
